"""What would tell a group apart: tests of the menu and further sensors, or the word that no test is expected to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.terminal import say, table
from viz.ahead import deciding, undecided

MOST = 3


def show_ahead(document: Mapping[str, Any]) -> None:
    """Three tests and three sensors at most of a diagnosis's document; nothing where there is no group."""
    offers = deciding(document)
    chosen = [o for kind in ("test", "sensor") for o in [x for x in offers if x.kind == kind][:MOST]]
    if chosen:
        rows = [[o.what, o.kind, o.hours, "; ".join(o.separates), o.gain] for o in chosen]
        table("What would decide", ["what", "kind", "hours", "separates", "predicted gain"], rows)
    elif words := undecided(document):
        say(words)
