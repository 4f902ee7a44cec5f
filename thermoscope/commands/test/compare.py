"""thermoscope test compare CASE"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from shlex import quote
from typing import TYPE_CHECKING, Any

from measured.recordings.readings import UNSEEN
from thermoscope.commands.model.error_budget import budget, in_short, sampling
from thermoscope.commands.open_case import open_case
from thermoscope.console.answer import Answer, Grid
from thermoscope.console.terminal import Progress, give, notes, progress
from thermoscope.files import STOPPED
from validation.comparison.uncertainty import RULE

if TYPE_CHECKING:
    from thermoscope.case_folder.folder import Folder
    from validation.comparison.compare import Comparison

EVIDENT = 10.0  # nats
WHITE = 0.01  # probability below which a residual is no noise
DIFFERENCES = 12  # shown
TURNS = {True: "yes", False: "no", None: ""}


def compare(case: str, target: str | None, why: bool = False, sure: bool | None = None) -> int:
    """Exit code 1 when a sensor's error is beyond the uncertainty of reading, inputs and arithmetic."""
    from validation.comparison.compare import StoppedComparisonError

    with progress() as tell:
        folder = open_case(case, tell)
        try:
            result, document = compared(folder, tell, why, sure)
        except KeyboardInterrupt as stopped:
            so_far = stopped.so_far if isinstance(stopped, StoppedComparisonError) else vars(folder).get("compared")
            if so_far is None:
                raise
            return _stopped(folder, so_far, case)
    unseen = next((note for note in folder.notes if UNSEEN in note), "")
    give(document, target, lambda: answer(document, case, unseen))
    return 0 if result.agrees else 1


def _stopped(folder: Folder, so_far: Comparison, called: str) -> int:
    """What is known of a comparison that the user stopped; no document, which others would take for the whole."""
    from validation.comparison.error_budget import documents

    document = {**so_far.document(), "error_budget": documents(folder.budgets), **sampling(folder)}
    give(document, None, lambda: answer(document, called))
    notes(
        [
            f"stopped: {len(so_far.tests)} of {len(folder.case.tests)} tests were compared, and the table holds these; "
            "nothing was written"
        ]
    )
    return STOPPED


def compared(
    folder: Folder, tell: Progress, why: bool = False, sure: bool | None = None
) -> tuple[Comparison, dict[str, Any]]:
    """An open case's model against its tests, and the document of it."""
    from thermoscope.bands import of_tests, wanted
    from thermoscope.case_folder.stored_yardstick import yardstick_document
    from validation.comparison.error_budget import documents
    from validation.parameters.unknowns import strain_words

    tell(f"estimating the error of {'mesh and condensation' if folder.built else 'the time steps'}")
    budgets = folder.budgets
    tell("running the model")
    result = folder.compared
    tell("learning plain models")
    more = {**uncertainty(result), **_discrepancies(folder, tell)} if why else {}
    bands = {"bands": of_tests(folder, tell)} if wanted(folder.case.model.network, sure) else {}
    return result, {
        **result.document(),
        "strained": strain_words(folder.case),
        **more,
        "error_budget": documents(budgets),
        **sampling(folder),
        **bands,
        **yardstick_document(folder.yardstick, result, folder.case),
    }


def _discrepancies(folder: Folder, tell: Progress) -> dict[str, Any]:
    from validation.diagnosis.discrepancy import discrepancies

    return discrepancies(folder.case, tell).document()


def uncertainty(result: Comparison) -> dict[str, Any]:
    """What reading, inputs and arithmetic leave open at every sensor, for a document."""
    return {"uncertainty": [u.document() for test in result.tests for u in test.uncertainty]}


def answer(document: Mapping[str, Any], called: str, unseen: str = "") -> Answer:
    """How many sensors are over, which, and what the rest looks like.

    called : what the user calls the case;  unseen : what stands before all else of a machine without a warm sensor
    """
    from thermoscope.case_folder.stored_yardstick import lacking_words

    records = [{"test": t["name"], **c} for t in document["tests"] for c in t["channels"]]
    over = sorted((r for r in records if r["verdict"] == "over"), key=lambda r: -r["rmse_K"] / r["limit_K"])
    why = _why(document) if "patterns" in document else []
    plain = document.get("yardstick", {"warning": "", "sentence": ""})
    parts = [
        f"{plain['sentence']} {lacking_words(document)}".strip(),
        *why,
        records_of("Over: error is measured - model", over),
        tests(document["tests"]),
        in_short(document["error_budget"], document["sampling"]),
        roles_in_short(document["roles"]),
    ]
    rest = [
        *(
            records_of(f"{t['name']} ({t['role']})", [{"test": t["name"], **c} for c in t["channels"]])
            for t in document["tests"]
        ),
        roles(document["roles"]),
        *budget(document["error_budget"], document["sampling"]),
        bands_of(document.get("bands", ())),
    ]
    more = f"{RULE}; --why, --json FILE; thermoscope show report {quote(called)}"
    words = [f"{unseen}." * bool(unseen), plain["warning"], document.get("strained", ""), document["words"]]
    return Answer(" ".join(filter(None, words)), parts, more, rest)


def tests(records: Sequence[Mapping[str, Any]]) -> Grid:
    """A row per test, those with most sensors over first."""
    rows = [
        [
            t["name"],
            t["role"],
            len(t["channels"]),
            sum(c["verdict"] == "over" for c in t["channels"]),
            t["rmse_K"],
            t["fitted_rmse_K"],
        ]
        for t in records
    ]
    rows.sort(key=lambda row: -row[3])
    headers = ["test", "role", "sensors", "over", "rms (K)", "sensors as fitted (K)"]
    return Grid("", headers, rows, keep=["rms (K)", "sensors as fitted (K)", "over"])


def records_of(title: str, records: Sequence[Mapping[str, Any]]) -> Grid:
    """A row per sensor."""
    headers = [
        "sensor",
        "test",
        "place",
        "n",
        "rms (K)",
        "fitted (K)",
        "bias (K)",
        "largest (K)",
        "limit (K)",
        "1 sigma (K)",
        "% of rise",
        "verdict",
    ]
    keys = [
        "channel",
        "test",
        "place",
        "n",
        "rmse_K",
        "fitted_rmse_K",
        "bias_K",
        "max_abs_K",
        "limit_K",
        "sigma_K",
        "percent_of_rise",
        "verdict",
    ]
    keep = ["test", "rms (K)", "bias (K)", "limit (K)", "verdict"]
    return Grid(title, headers, [[r[k] for k in keys] for r in records], ["over"], keep)


def bands_of(rows: Sequence[Mapping[str, Any]]) -> Grid:
    """How sure each place is, least sure first; of all tests the one in which it is least sure."""
    worst: dict[str, Mapping[str, Any]] = {}
    for r in rows:
        if r["place"] not in worst or r["widest_ci95_K"] > worst[r["place"]]["widest_ci95_K"]:
            worst[r["place"]] = r
    widest = sorted(worst.values(), key=lambda r: -r["widest_ci95_K"])
    body = [[r["place"], r["widest_ci95_K"], r["test"], r.get("inside")] for r in widest]
    return Grid("95 % bands of the model", ["place", "widest (K)", "in", "readings inside"], body)


def roles_in_short(records: Sequence[Mapping[str, Any]]) -> str:
    """How many roles nobody declares; "" where all are."""
    guesses = [r["name"] for r in records if r["known"] == "guessed"]
    if not guesses:
        return ""
    unknown = sum(r["role"] is None for r in records if r["known"] == "guessed")
    how = 'say role = "..." in network.toml'
    return f"{len(guesses)} roles are guessed, {unknown} of them unknown; effects are placed by them: {how}."


def roles(records: Sequence[Mapping[str, Any]]) -> Grid:
    """What was guessed, with its evidence."""
    rows = [[r["name"], r["role"] or "?", TURNS[r["turns"]], r["evidence"]] for r in records if r["known"] == "guessed"]
    return Grid("Roles that nobody declares", ["name", "role", "turns", "evidence"], rows)


def _why(document: Mapping[str, Any]) -> list[Grid | str]:
    """The error against the uncertainty of readings, inputs and arithmetic; what it follows; where heat is missing."""
    headers = ["sensor", "test", "error (K)", "u reading", "u inputs", "u numeric", "explained", "white", "follows"]
    left = {(p["test"], p["channel"]): p for p in document["patterns"]}
    rows = []
    for u in sorted(document["uncertainty"], key=lambda u: bool(u["explained"])):
        numbers = [u[k] for k in ("error_K", "reading_K", "input_K", "numeric_K")]
        p = left.get((u["test"], u["channel"]))
        rows.append([u["channel"], u["test"], *numbers, "yes" if u["explained"] else "no", *_pattern(p)])
    title = "Against all uncertainties (ASME V&V 20, standard uncertainties in K)"
    keep = ["test", "error (K)", "explained", "follows"]
    differing = contradiction(document["contradiction"])
    return [*differing[:1], Grid(title, headers, rows, ["no"], keep), *differing[1:], *_missing(document["where"])]


def _missing(places: Sequence[Mapping[str, Any]]) -> list[str]:
    """Where heat is missing, and how much at most."""
    evident = [h for h in places if h["evidence_nats"] > EVIDENT]
    lines = [f"Heat missing at {h['place']} ({h['evidence_nats']:.0f} nats): {_pulses(h)}." for h in evident[:3]]
    return lines or ["No place where heat is clearly missing (beyond what calibration mends)."]


def contradiction(row: Mapping[str, Any] | None) -> list[Grid | str]:
    """What would have to differ between tests: in a sentence, then as a table."""
    if not row:
        return []
    rows = [
        [
            d["test"],
            d["parameter"],
            d["others"],
            d["here"],
            "" if d["unit"] == "1" else d["unit"],
            abs(d["sd"]),
            "yes" if d["possible"] else "no",
        ]
        for d in row["differences"][:DIFFERENCES]
    ]
    headers = ["test", "parameter", "other tests", "this test", "unit", "deviations", "can it differ?"]
    keep = ["parameter", "this test", "deviations", "can it differ?"]
    title = "What would have to differ between tests (by tangents)"
    return [row["words"], *([Grid(title, headers, rows, ["no"], keep)] if rows else [])]


def _pulses(h: Mapping[str, Any]) -> str:
    """Every pulse of a missing-heat curve; of one without any its largest value."""
    if h["pulses"]:
        pulses = [
            f"{p['heat_W']:+.3g} W from {p['begin_s']:.0f} to {p['end_s']:.0f} s of {p['test']}" for p in h["pulses"]
        ]
        return ", ".join(pulses)
    name, series = max(h["heat"].items(), key=lambda kv: max(map(abs, kv[1]["heat_W"])))
    k = max(range(len(series["heat_W"])), key=lambda i: abs(series["heat_W"][i]))
    return f"{series['heat_W'][k]:+.3g} W after {series['time_s'][k]:.0f} s of {name}"


def _pattern(p: Mapping[str, Any] | None) -> list[str]:
    if p is None:
        return ["", ""]
    by_ratio = sorted(p["follows"].items(), key=lambda kv: -kv[1])
    white = min(p["ljung_box_p"], p["periodogram_p"]) > WHITE
    return ["yes" if white else "no", ", ".join(name for name, ratio in by_ratio[:2] if ratio > 1.0)]
