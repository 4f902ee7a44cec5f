"""What would tell a group apart: candidate tests and further sensors, or the word that no test is expected to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.console.answer import Grid
from viz.pages.next_tests import deciding, undecided

MOST = 3  # tests and as many sensors fit the screen


def next_tests(document: Mapping[str, Any]) -> list[Grid | str]:
    """Three tests and three sensors at most of a diagnosis's document, and the currents of those tests.

    Nothing where there is no group.
    """
    offers = deciding(document)
    best = [o for kind in ("test", "sensor") for o in [x for x in offers if x.kind == kind][:MOST]]
    if not best:
        return [undecided(document)]
    rows = [[o.what, o.kind, o.hours, "; ".join(o.separates), o.gain] for o in best]
    headers = ["what", "kind", "hours", "separates", "predicted gain"]
    table = Grid("What would decide", headers, rows, keep=["kind", "predicted gain"])
    return [table, *(f"{o.what[0].upper()}{o.what[1:]}: {o.how}." for o in best if o.kind == "test" and o.how)]
