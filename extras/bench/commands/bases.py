"""thermoscope bench bases CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.plugin import Summary, bases_table, give, open_case, progress


def bases(case: str, target: str | None) -> int:
    """Exit code 1 when the readings of a test exclude the base that its sheet says."""
    from thermoscope.plugin import which_base

    with progress() as tell:
        folder = open_case(case, tell)
        hypotheses = which_base(folder.case, progress=tell)
    wrong = [h for h in hypotheses if h.declared and h.excluded]
    document = {
        "case": folder.case.name,
        "revision": folder.case.model.revision,
        "wrong": [h.test for h in wrong],
        "hypotheses": [h.document() for h in hypotheses],
    }
    give(document, target, lambda: bases_summary(document))
    return 1 if wrong else 0


def bases_summary(document: Mapping[str, Any]) -> Summary:
    """Every base for every test, with what it carries off by mechanism, and which test was elsewhere."""
    words = []
    for test in document["wrong"]:
        better = [h["base"] for h in document["hypotheses"] if h["test"] == test and not h["excluded"]]
        words.append(f"{test} did not stand on the base its sheet says; the readings allow: {', '.join(better)}")
    sentence = "; ".join(words) or "No test's readings exclude the base that its sheet says"
    return Summary(f"{sentence}.", [bases_table(document["hypotheses"])])
