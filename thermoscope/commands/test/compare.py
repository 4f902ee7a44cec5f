"""thermoscope test compare CASE"""

from collections.abc import Mapping, Sequence
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer

from geom.table import Table
from geom.text import counted
from measured.recordings.readings import UNSEEN
from thermoscope.commands.model.error_budget import budget, in_short, sampling
from thermoscope.commands.open_case import open_case
from thermoscope.console.options import Case, Json, Sure
from thermoscope.console.summary import Summary, sentences
from thermoscope.console.terminal import Progress, give, notes, progress
from thermoscope.files import STOPPED
from validation.comparison.uncertainty import RULE
from validation.effects.time_window import IN
from validation.parameters.unknowns import strain_words
from validation.tables import comparison_tables, contradiction_table, sensors_table

if TYPE_CHECKING:
    from measured.case import Case as MeasuredCase
    from thermoscope.case_folder.folder import Folder
    from validation.comparison.compare import Comparison

EVIDENT = 10.0  # nats
WHITE = 0.01  # probability below which a residual is not noise


def compare(
    case: Case,
    target: Json = None,
    why: Annotated[
        bool, typer.Option("--why", help="Uncertainty, whiteness, inputs it follows, missing heat.")
    ] = False,
    sure: Sure = None,
) -> int:
    """The model against every test: error per sensor against its uncertainty. Exit code 1 if it disagrees."""
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
    doubts = " ".join([*sentences([unseen] * bool(unseen)), folder.settings.guesses]).strip()
    give(document, target, lambda: comparison_summary(document, case, doubts))
    return 0 if result.agrees else 1


def _stopped(folder: "Folder", so_far: "Comparison", called: str) -> int:
    """What is known of a comparison that the user stopped; no document, which others would take for the whole."""
    from validation.comparison.error_budget import documents

    document = {**so_far.document(), "error_budget": documents(folder.budgets), **sampling(folder)}
    give(document, None, lambda: comparison_summary(document, called))
    share = f"{len(so_far.tests)} of {len(folder.case.tests)} tests"
    notes([f"stopped: {share} were compared, and the table holds these; nothing was written"])
    return STOPPED


def compared(
    folder: "Folder", tell: Progress, why: bool = False, sure: bool | None = None
) -> "tuple[Comparison, dict[str, Any]]":
    """An open case's model against its tests, and the document of it."""
    from thermoscope.bands import bands_requested, test_bands
    from thermoscope.case_folder.stored_comparison import yardstick_document
    from validation.comparison.error_budget import documents

    tell("checking mesh and condensation" if folder.built else "estimating the error of the time steps")
    budgets = folder.budgets
    tell("running the model")
    result = folder.compared
    tell("learning plain models")
    more: dict[str, Any] = {}
    if why:
        from validation.discrepancy import discrepancies

        uncertainties = [u.document() for test in result.tests for u in test.uncertainty]
        more = {"uncertainty": uncertainties, **discrepancies(folder.case, tell).document()}
    bands = {"bands": test_bands(folder, tell)} if bands_requested(folder.case.model.network, sure) else {}
    return result, {
        **yardstick_document(folder.yardstick, result, folder.case),  # first, as what is said of it
        **result.document(),
        "strained": strain_words(folder.case),
        "repeated_events": repeated(folder.case),
        **more,
        "error_budget": documents(budgets),
        **sampling(folder),
        **bands,
    }


def repeated(case: "MeasuredCase") -> list[dict[str, Any]]:
    """Events of the model that are found in held-out tests, too; a model without any is spared what looks for them."""
    if not any(IN in e.place for e in case.model.effects):
        return []
    from validation.revision.repeated_events import repeated_events

    return [x.document() for x in repeated_events(case)]


def comparison_summary(document: Mapping[str, Any], called: str, doubts: str = "") -> Summary:
    """How many sensors are over, which, and what the rest looks like.

    called : what the user calls the case;  doubts : of its recordings
    """
    from thermoscope.case_folder.stored_comparison import yardstick_words

    tests, budgets, steps = document["tests"], document["error_budget"], document["sampling"]
    first, *rest = comparison_tables(document)
    parts = [
        yardstick_words(document),
        *(f"Again: {x['words']}." for x in document.get("repeated_events", ())),
        *(_reasons(document) if "patterns" in document else []),
        sensors_table("Over: error is measured - model", tests, "over"),
        first,
        f"{RULE[0].upper()}{RULE[1:]}.",
        in_short(budgets, steps),
        roles_in_short(document["roles"]),
    ]
    more = f"--why, --json FILE; thermoscope show report {quote(called)}"
    worse = document.get("yardstick", {}).get("warning", "")
    before = " ".join(filter(None, (worse, document.get("strained", ""), doubts)))
    words = "\n".join(filter(None, (before, document["words"])))
    every = [*rest, *budget(budgets, steps), bands_table(document.get("bands", ()))]
    return Summary(words, parts, more, every)


def bands_table(rows: Sequence[Mapping[str, Any]]) -> Table:
    """How sure each place is, least sure first; of all tests the one in which it is least sure."""
    widest = sorted(rows, key=lambda r: -r["widest_ci95_K"])
    worst = {r["place"]: r for r in reversed(widest)}
    columns = "place | widest (K)=widest_ci95_K | in=test | readings inside=inside"
    return Table.of("95 % bands of the model", [r for r in widest if worst[r["place"]] is r], columns)


def roles_in_short(records: Sequence[Mapping[str, Any]]) -> str:
    """How many roles nobody declares; "" where all are."""
    guesses = [r for r in records if r["known"] == "guessed"]
    if not guesses:
        return ""
    unknown, how = sum(r["role"] is None for r in guesses), 'say role = "..." in network.toml'
    which = f"{counted(len(guesses), 'node')}{f', {unknown} of them unknown' * bool(unknown)}"
    return f"Roles are guessed by name of {which}; effects are placed by roles: {how}."


def _reasons(document: Mapping[str, Any]) -> list[Table | str]:
    """The error against the uncertainty of readings, inputs and arithmetic; what it follows; where heat is missing."""
    left = {(p["test"], p["channel"]): p for p in document["patterns"]}
    table = Table.of(
        "Against all uncertainties (ASME V&V 20, standard uncertainties in K)",
        sorted(document["uncertainty"], key=lambda u: bool(u["explained"])),
        "sensor=channel | *test | *error (K)=error_K | u reading=reading_K | u inputs=input_K | u numeric=numeric_K | "
        "*explained | white | *follows",
        ["no"],
        explained=lambda u: bool(u["explained"]),
        white=lambda u: _white(left.get((u["test"], u["channel"]))),
        follows=lambda u: _followed(left.get((u["test"], u["channel"]))),
    )
    differing = contradiction(document["contradiction"])
    evident = [h for h in document["where"] if h["evidence_nats"] > EVIDENT]
    lines = [
        f"Heat missing at {h['place']} (log odds {h['evidence_nats']:.0f}; 3 is twenty to one): {_pulses(h)}."
        for h in evident[:3]
    ]
    missing = lines or ["No place where heat is clearly missing (beyond what calibration mends)."]
    return [*differing[:1], table, *differing[1:], *missing]


def _white(pattern: Mapping[str, Any] | None) -> bool | str:
    return "" if pattern is None else bool(min(pattern["ljung_box_p"], pattern["periodogram_p"]) > WHITE)


def _followed(pattern: Mapping[str, Any] | None) -> str:
    """The two inputs that a residual follows most."""
    by_ratio = sorted(pattern["follows"].items(), key=lambda kv: -kv[1]) if pattern else []
    return ", ".join(name for name, ratio in by_ratio[:2] if ratio > 1.0)


def contradiction(row: Mapping[str, Any] | None) -> list[Table | str]:
    """What would have to differ between tests: in a sentence, then as a table."""
    if not row:
        return []
    table = contradiction_table(row)
    return [*sentences([row["words"]]), *([table] if table.rows else [])]


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
