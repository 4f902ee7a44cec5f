"""thermoscope diagnose CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.commands.ahead import show_ahead
from thermoscope.commands.bases import show_bases
from thermoscope.commands.opened import opened
from thermoscope.commands.saved import save_diagnosis
from thermoscope.terminal import cell, give, progress, say, table

ROWS = 10


def diagnose(case: str, draws: int, sizes: bool, target: str | None) -> int:
    """Exit code 1 when no effect is named."""
    from thermoscope.pipeline import cache_folder
    from validation.diagnose import diagnose as search

    with progress() as tell:
        folder = opened(case, tell)
        found = search(folder.case, draws=draws, cache=cache_folder() / "null", progress=tell, sizes=sizes)
    document = {"case": folder.case.name, "revision": folder.case.model.revision, **found.document()}
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
    say(f"{document['verdict']}: {document['words']}")


def _searched(document: Mapping[str, Any]) -> None:
    rows = [_row(c) for c in document["candidates"][:ROWS]]
    headers = ["effect", "score", "amplitude", "95 %", "error (K)", "held out (K)", "confused with", "decision"]
    title = f"Candidates: a score beyond {document['threshold']:.2f} is not chance"
    table(title, headers, rows, marked=["named", "group"])
    show_ahead(document)
    hidden = [h["effect"] for h in document["cannot_see"]]
    if hidden:
        say(f"{len(hidden)} effects could be there unseen, e.g. {', '.join(hidden[:4])} (all in --json)")


def _row(c: Mapping[str, Any]) -> list[Any]:
    size, alike = c["amplitude"], c["confused_with"]
    low, high = size["ci95"]
    more = f" + {len(alike) - 1}" if len(alike) > 1 else ""
    return [
        c["effect"], c["score"], f"{cell(size['value'])} {size['unit']}", f"{cell(low)} ... {cell(high)}",
        _arrow(c["rmse_K"]), _arrow(c["holdout_rmse_K"]), f"{alike[0]}{more}" if alike else "", c["decision"],
    ]  # fmt: skip


def _arrow(pair: Mapping[str, float] | None) -> str:
    return f"{pair['before']:.2f} -> {pair['after']:.2f}" if pair else "-"
