"""What would tell a group apart: tests of the menu and further sensors, or the word that no test is expected to."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from thermoscope.terminal import cell, say, table

MOST = 3


def show_ahead(document: Mapping[str, Any]) -> None:
    """Three tests and three sensors at most of a diagnosis's document; nothing where there is no group."""
    tests, sensors = ([o for o in document[k] if o["separates"]] for k in ("next_tests", "next_sensors"))
    rows = [[t["test"], "test", *_worth(t)] for t in tests[:MOST]]
    rows += [[s["place"], "sensor", *_worth(s)] for s in sensors[:MOST]]
    if rows:
        table("What would decide", ["what", "kind", "hours", "separates", "predicted gain"], rows)
    elif document["next_tests"]:
        best = max(document["next_tests"], key=lambda t: t["predicted_gain"])
        gain = f"with a predicted gain of {cell(best['predicted_gain'])} where 20 decides"
        say(f"no test of the menu would tell them apart: '{best['test']}' comes nearest, {gain}")


def _worth(o: Mapping[str, Any]) -> list[Any]:
    return [o["hours"], "; ".join(o["separates"]), o["predicted_gain"]]
