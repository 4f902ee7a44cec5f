"""thermoscope bench bases CASE"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope import plugin as th


def bases_summary(document: Mapping[str, Any]) -> th.Summary:
    """Every base for every test, with what it carries off by mechanism, and which test was elsewhere."""
    words = []
    for test in document["wrong"]:
        better = [h["base"] for h in document["hypotheses"] if h["test"] == test and not h["excluded"]]
        words.append(f"{test} did not stand on the base its sheet says; the readings allow: {', '.join(better)}")
    sentence = "; ".join(words) or "No test's readings exclude the base that its sheet says"
    return th.Summary(f"{sentence}.", [th.bases_table(document["hypotheses"])])
