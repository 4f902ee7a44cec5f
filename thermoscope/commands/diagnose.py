"""thermoscope diagnose CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.commands.ahead import show_ahead
from thermoscope.commands.bases import show_bases
from thermoscope.commands.compare import show_contradiction
from thermoscope.commands.error_budget import show_budget
from thermoscope.commands.opened import opened
from thermoscope.commands.saved import save_diagnosis
from thermoscope.terminal import give, notes, progress, say, sized, table

ROWS = 10
SHOWN = 0.005  # probabilities below half a per cent are in --json


def diagnose(case: str, target: str | None, older: bool = False) -> int:
    """Exit code 1 when no effect is named.  older : an option of older versions was given"""
    from lumped.error_budget import ErrorBudget
    from thermoscope.error_budget import budgets_of_tests, documents
    from validation import diagnose as search

    if older:
        notes(["--draws is no longer needed: nothing is drawn"])
    with progress() as tell:
        folder = opened(case, tell)
        budgets = budgets_of_tests(folder, tell)
        found = search(folder.case, folder.settings.kinds, tell, budget=ErrorBudget.worst(budgets.values()).total_K)
    named = {"case": folder.case.name, "revision": folder.case.model.revision}
    document = {**named, **found.document(), "error_budget": documents(budgets)}
    save_diagnosis(folder, document)
    give(document, target, lambda: show(document))
    return 0 if found.verdict in ("named", "group", "several") else 1


def show(document: Mapping[str, Any]) -> None:
    """Candidates, next tests, and the verdict in a sentence; of a wrong base only that, for it comes first."""
    bases = document.get("bases", [])
    if any(h["declared"] and h["excluded"] for h in bases):
        show_bases(bases)
    else:
        _searched(document)
        show_budget(document.get("error_budget", {}))
    say(f"{document['verdict']}: {document['words']}")
    for row in document["remainder"]:
        say(row["words"])


def _searched(document: Mapping[str, Any]) -> None:
    rows = [_row(c) for c in document["candidates"][:ROWS]]
    headers = ["hypothesis", "probability (%)"]
    odds = [[o["hypothesis"], f"{100 * o['probability']:.1f}"] for o in document["odds"] if o["probability"] > SHOWN]
    table("What the readings say", headers, odds[:ROWS])
    headers = ["effect", "%", "amplitude (95 %)", "unit", "error (K)", "held out (K)", "decision"]
    table("Candidates", headers, rows, marked=["named", "group"])
    for c in document["candidates"][1:ROWS]:
        if c["note"] and c["probability"] > SHOWN:
            say(f"against {c['effect']}: it {c['note']} than {document['candidates'][0]['effect']}")
    if document["candidates"] and (alike := document["candidates"][0]["confused_with"]):
        say(f"{document['candidates'][0]['effect']} looks like {', '.join(alike)} to these tests and sensors")
    show_events(document)
    show_contradiction(document.get("contradiction"))
    show_ahead(document)
    hidden = [h["effect"] for h in document["cannot_see"]]
    if hidden:
        say(f"{len(hidden)} effects could be there unseen, e.g. {', '.join(hidden[:4])} (all in --json)")


def show_events(document: Mapping[str, Any]) -> None:
    """When something may have been different, every stretch that was tried."""
    rows = [
        [e["words"], f"{100 * e['probability']:.1f}", e["effect"].split(" in ")[0], e["value"],
         "" if e["unit"] == "1" else e["unit"]] for e in document.get("events", [])
    ]  # fmt: skip
    if rows:
        table("What may have differed for a while", ["when", "%", "most likely", "size", "unit"], rows)


def _row(c: Mapping[str, Any]) -> list[Any]:
    size, share = c["amplitude"], f"{100 * c['probability']:.1f}"
    return [
        c["effect"], share, sized(size["value"], *size["ci95"]), "" if size["unit"] == "1" else size["unit"],
        _arrow(c["rmse_K"]), _arrow(c["holdout_rmse_K"]), c["decision"],
    ]  # fmt: skip


def _arrow(pair: Mapping[str, float] | None) -> str:
    return f"{pair['before']:.2f} -> {pair['after']:.2f}" if pair else "-"
