"""The error over the revisions of a model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from viz.colours import BLUE, LIGHT, Theme
from viz.figures.errors import PALE, error_paths
from viz.live.style import figure

if TYPE_CHECKING:
    import plotly.graph_objects as go


def staircase(history: Sequence[Mapping[str, Any]], *, theme: Theme = LIGHT) -> go.Figure:
    """Rms error (K) of every test before the first revision and after each; held-out tests strong."""
    out = figure(theme, title={"text": "The error, step by step", "x": 0.02})
    names = ["start", *(f"{r['number']} {r['action']} {r.get('effect') or ''}".strip() for r in history)]
    for (name, role), errors in error_paths(history).items():
        strong = role == "hold-out"
        style = {"color": BLUE if strong else PALE, "width": 3 if strong else 2, "shape": "hv"}
        out.add_scatter(x=names[-len(errors) :], y=errors, name=f"{name} ({role})", line=style, mode="lines+markers")
    out.update_yaxes(title="rms error (K)", rangemode="tozero")
    return out
