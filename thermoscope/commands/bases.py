"""thermoscope bases CASE"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from thermoscope.commands.opened import opened
from thermoscope.terminal import give, progress, say, table


def bases(case: str, target: str | None) -> int:
    """Exit code 1 when the readings of a test exclude the base that its sheet says."""
    from validation.procedure.which_base import which_base

    with progress() as tell:
        folder = opened(case, tell)
        found = which_base(folder.case, progress=tell)
    wrong = [h for h in found if h.declared and h.excluded]
    document = {"case": folder.case.name, "revision": folder.case.model.revision,
                "wrong": [h.test for h in wrong], "hypotheses": [h.document() for h in found]}  # fmt: skip
    give(document, target, lambda: show(document))
    return 1 if wrong else 0


def show(document: Mapping[str, Any]) -> None:
    """Every base for every test, with what it carries off by mechanism, and which test was elsewhere."""
    show_bases(document["hypotheses"])
    for test in document["wrong"]:
        better = [h["base"] for h in document["hypotheses"] if h["test"] == test and not h["excluded"]]
        say(f"{test} did not stand on the base its sheet says; the readings allow: {', '.join(better)}")
    if not document["wrong"]:
        say("no test's readings exclude the base that its sheet says")


def show_bases(hypotheses: Sequence[Mapping[str, Any]]) -> None:
    """The table."""
    headers = ["test", "base", "", "deviance", "", "conduction (W)", "convection (W)", "radiation (W)", "W/K",
               "body W/K"]  # fmt: skip
    rows = []
    for h in hypotheses:
        heat, verdict = h["heat_W"], "excluded" if h["excluded"] else "possible"
        numbers = [heat[k] for k in ("conduction", "convection", "radiation", "path_W_K", "body_W_K")]
        rows.append([h["test"], h["base"], "sheet" if h["declared"] else "", h["deviance"], verdict, *numbers])
    table("Which base: all tests calibrated together for each; deviance over the best", headers, rows, ["excluded"])
