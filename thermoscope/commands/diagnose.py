"""thermoscope diagnose CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.commands.ahead import show_ahead
from thermoscope.commands.bases import show_bases
from thermoscope.commands.error_budget import show_budget
from thermoscope.commands.opened import opened
from thermoscope.commands.saved import save_diagnosis
from thermoscope.terminal import give, progress, say, sized, table

ROWS = 10


def diagnose(case: str, draws: int, sizes: bool, target: str | None) -> int:
    """Exit code 1 when no effect is named."""
    from thermoscope.error_budget import budgets_of_tests, documents
    from thermoscope.pipeline import cache_folder
    from validation.diagnose import diagnose as search

    with progress() as tell:
        folder = opened(case, tell)
        found = search(folder.case, draws=draws, cache=cache_folder() / "null", progress=tell, sizes=sizes)
        budgets = documents(budgets_of_tests(folder, tell))
    named = {"case": folder.case.name, "revision": folder.case.model.revision}
    document = {**named, **found.document(), "error_budget": budgets}
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


def _searched(document: Mapping[str, Any]) -> None:
    rows = [_row(c) for c in document["candidates"][:ROWS]]
    headers = ["effect", "score", "amplitude (95 %)", "unit", "error (K)", "held out (K)", "decision"]
    title = f"Candidates: a score beyond {document['threshold']:.2f} is not chance"
    table(title, headers, rows, marked=["named", "group"])
    if document["candidates"] and (alike := document["candidates"][0]["confused_with"]):
        say(f"{document['candidates'][0]['effect']} looks like {', '.join(alike)} to these tests and sensors")
    show_ahead(document)
    hidden = [h["effect"] for h in document["cannot_see"]]
    if hidden:
        say(f"{len(hidden)} effects could be there unseen, e.g. {', '.join(hidden[:4])} (all in --json)")


def _row(c: Mapping[str, Any]) -> list[Any]:
    size = c["amplitude"]
    return [
        c["effect"], c["score"], sized(size["value"], *size["ci95"]), "" if size["unit"] == "1" else size["unit"],
        _arrow(c["rmse_K"]), _arrow(c["holdout_rmse_K"]), c["decision"],
    ]  # fmt: skip


def _arrow(pair: Mapping[str, float] | None) -> str:
    return f"{pair['before']:.2f} -> {pair['after']:.2f}" if pair else "-"
