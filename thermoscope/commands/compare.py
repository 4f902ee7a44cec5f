"""thermoscope compare CASE"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from thermoscope.commands.error_budget import show_budget
from thermoscope.commands.opened import opened
from thermoscope.terminal import give, progress, say, table

EVIDENT = 10.0  # nats
WHITE = 0.01
ROWS = 12
TURNS = {True: "yes", False: "no", None: ""}


def compare(case: str, target: str | None, why: bool = False) -> int:
    """Exit code 1 when a sensor is outside its uncertainty and outside the 4 % rule."""
    from thermoscope.error_budget import budgets_of_tests, documents
    from validation.compare import compare as held_against
    from validation.failing import failing

    with progress() as tell:
        folder = opened(case, tell)
        tell("running the model")
        result = held_against(folder.case)
        more = failing(folder.case, tell).document() if why else {}
        budgets = budgets_of_tests(folder, tell)
    document = {**result.document(), **more, "error_budget": documents(budgets)}
    give(document, target, lambda: show(document))
    return 0 if result.agrees else 1


def show(document: Mapping[str, Any]) -> None:
    """A table per test, and the whole in one sentence."""
    headers = ["sensor", "place", "n", "rms (K)", "bias (K)", "largest (K)", "1 sigma (K)", "% of rise", "verdict"]
    keys = ["channel", "place", "n", "rmse_K", "bias_K", "max_abs_K", "sigma_K", "percent_of_rise", "verdict"]
    for test in document["tests"]:
        title = f"{test['name']} ({test['role']}): rms {test['rmse_K']:.2f} K"
        table(title, headers, [[c[k] for k in keys] for c in test["channels"]], marked=["over"])
    if "patterns" in document:
        show_why(document)
    show_roles(document["roles"])
    show_budget(document["error_budget"])
    model, over = document["model"], [c for t in document["tests"] for c in t["channels"] if c["verdict"] == "over"]
    effects = f" with {', '.join(model['effects'])}" if model["effects"] else ""
    say(
        f"{document['case']}, revision {model['revision']}{effects}: rms {document['rmse_K']:.2f} K; the sensors' own "
        f"uncertainty explains {document['floor_K']:.2f} K; {len(over)} sensor records out of tolerance"
    )


def show_roles(roles: Sequence[Mapping[str, Any]]) -> None:
    """What was guessed, with its evidence, and how to say it; nothing where all is declared."""
    guessed = [r for r in roles if r["known"] == "guessed"]
    if not guessed:
        return
    rows = [[r["name"], r["role"] or "?", TURNS[r["turns"]], r["evidence"]] for r in guessed]
    table("Roles that nobody declares, guessed from topology and losses", ["name", "role", "turns", "evidence"], rows)
    missing = sum(r["role"] is None for r in guessed)
    say(
        f"{len(guessed)} roles guessed, {missing} of them unknown: the diagnosis places effects by them. "
        'Say role = "..." in [nodes.NAME] or [boundaries.NAME] of network.toml'
    )


def show_why(document: Mapping[str, Any]) -> None:
    """The error against the uncertainty of readings, inputs and arithmetic; what it follows; where heat is missing."""
    headers = ["test", "sensor", "error (K)", "u reading", "u inputs", "u numeric", "explained", "white", "follows"]
    left = {(p["test"], p["channel"]): p for p in document["patterns"]}
    rows = []
    for u in document["uncertainty"]:
        numbers = [u[k] for k in ("error_K", "reading_K", "input_K", "numeric_K")]
        p = left.get((u["test"], u["channel"]))
        rows.append([u["test"], u["channel"], *numbers, "yes" if u["explained"] else "no", *_pattern(p)])
    table("Against all uncertainties (ASME V&V 20, standard uncertainties in K)", headers, rows, marked=["no"])
    show_contradiction(document["contradiction"])
    found = [h for h in document["where"] if h["evidence_nats"] > EVIDENT]
    for h in found[:3]:
        say(f"heat missing at {h['place']} ({h['evidence_nats']:.0f} nats): {_pulses(h)}")
    if not found:
        say("no place where heat is clearly missing (beyond what calibration mends)")


def show_contradiction(found: Mapping[str, Any] | None) -> None:
    """What would have to differ between tests: in a sentence, then as a table."""
    if not found:
        return
    rows = [
        [d["test"], d["parameter"], d["others"], d["here"], "" if d["unit"] == "1" else d["unit"], abs(d["sd"]),
         "yes" if d["possible"] else "no"] for d in found["differences"][:ROWS]
    ]  # fmt: skip
    if rows:
        headers = ["test", "parameter", "other tests", "this test", "unit", "deviations", "can it differ?"]
        table("What would have to differ between tests (by tangents)", headers, rows, marked=["no"])
    say(found["words"])


def _pulses(h: Mapping[str, Any]) -> str:
    """Every pulse of a missing-heat curve; of one without any its largest value."""
    if h["pulses"]:
        told = [
            f"{p['heat_W']:+.3g} W from {p['begin_s']:.0f} to {p['end_s']:.0f} s of {p['test']}" for p in h["pulses"]
        ]
        return ", ".join(told)
    name, series = max(h["heat"].items(), key=lambda kv: max(map(abs, kv[1]["heat_W"])))
    k = max(range(len(series["heat_W"])), key=lambda i: abs(series["heat_W"][i]))
    return f"{series['heat_W'][k]:+.3g} W after {series['time_s'][k]:.0f} s of {name}"


def _pattern(p: Mapping[str, Any] | None) -> list[str]:
    if p is None:
        return ["", ""]
    ranked = sorted(p["follows"].items(), key=lambda kv: -kv[1])
    white = min(p["ljung_box_p"], p["periodogram_p"]) > WHITE
    return ["yes" if white else "no", ", ".join(name for name, ratio in ranked[:2] if ratio > 1.0)]
