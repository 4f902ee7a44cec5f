"""thermoscope bench bases CASE"""

from collections.abc import Mapping
from typing import Any

from thermoscope import plugin as th


def bases(case: th.CaseArgument, json: th.JsonOption = None) -> int:
    """Which base a machine stood on in each test. Exit code 1 if the readings exclude the one that a sheet says."""
    with th.progress() as tell:
        folder = th.open_case(case, tell)
        hypotheses = th.which_base(folder.case, progress=tell)
    wrong = [h.test for h in hypotheses if h.declared and h.excluded]
    rows, model = [h.document() for h in hypotheses], folder.case.model
    document = {"case": folder.case.name, "revision": model.revision, "wrong": wrong, "hypotheses": rows}
    th.give(document, json, lambda: bases_summary(document))
    return 1 if wrong else 0


def bases_summary(document: Mapping[str, Any]) -> th.Summary:
    """Every base for every test, with what it carries off by mechanism, and which test was elsewhere."""
    words = []
    for test in document["wrong"]:
        better = [h["base"] for h in document["hypotheses"] if h["test"] == test and not h["excluded"]]
        words.append(f"{test} did not stand on the base its sheet says; the readings allow: {', '.join(better)}")
    sentence = "; ".join(words) or "No test's readings exclude the base that its sheet says"
    return th.Summary(f"{sentence}.", [th.bases_table(document["hypotheses"])])
