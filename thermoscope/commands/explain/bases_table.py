"""The table of bases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from thermoscope.console.answer import Grid


def hypotheses_table(hypotheses: Sequence[Mapping[str, Any]]) -> Grid:
    """Each with its deviance over the best, all tests calibrated together for each."""
    headers = [
        "test",
        "base",
        "said",
        "deviance",
        "verdict",
        "conduction (W)",
        "convection (W)",
        "radiation (W)",
        "W/K",
        "body W/K",
    ]
    rows = []
    for h in hypotheses:
        heat, verdict = h["heat_W"], "excluded" if h["excluded"] else "possible"
        numbers = [heat[k] for k in ("conduction", "convection", "radiation", "path_W_K", "body_W_K")]
        rows.append([h["test"], h["base"], "sheet" if h["declared"] else "", h["deviance"], verdict, *numbers])
    keep = ["base", "verdict", "deviance", "said"]
    return Grid("Which base: deviance over the best of each test", headers, rows, ["excluded"], keep)
