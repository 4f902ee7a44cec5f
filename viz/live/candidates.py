"""What might be missing: odds, confusion matrix, Pareto of what each candidate explains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from viz.colours import BLUE, LIGHT, PURPLE, VERMILION, Theme
from viz.figures.candidates import DECISION, LEAST_PROBABILITY
from viz.live.style import figure, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go

MOST = 10  # hypotheses drawn


def posterior(odds: Sequence[Mapping[str, Any]], *, theme: Theme = LIGHT) -> go.Figure:
    """The probability of every hypothesis that carries weight as bars, most probable on top."""
    best = [o for o in odds if o["probability"] >= LEAST_PROBABILITY][:MOST][::-1]
    out = figure(theme, title={"text": "What the readings say", "x": 0.02})
    colours = [BLUE if o["hypothesis"] == "nothing" else VERMILION if o["effects"] else PURPLE for o in best]
    out.add_bar(
        x=[100.0 * o["probability"] for o in best], y=[o["hypothesis"] for o in best], orientation="h",
        marker={"color": colours}, texttemplate="%{x:.0f} %", hovertemplate="%{y}<br>%{x:.1f} %<extra></extra>",
        showlegend=False,
    )  # fmt: skip
    out.update_xaxes(title="probability (%)", range=[0, 112])
    return out


def confusion(names: Sequence[str], cosine: NDArray[np.float64], *, theme: Theme = LIGHT) -> go.Figure:
    """|cosine| between the traces of candidates, (n, n): 1 cannot be told apart with these sensors and tests."""
    c = np.abs(np.asarray(cosine, float))
    out = figure(theme, title={"text": "Traces in common (1: cannot be told apart)", "x": 0.02, "font": {"size": 13}})
    numbers = [str(i) for i in range(1, len(names) + 1)]
    labels = [f"{name}  {i}" for name, i in zip(names, numbers, strict=True)]
    out.add_heatmap(
        z=[plain(row) for row in c], x=numbers, y=labels, zmin=0, zmax=1, colorscale="Blues", showscale=False,
        texttemplate="%{z:.2f}", hovertemplate="%{x}<br>%{y}<br>%{z:.3f}<extra></extra>",
    )  # fmt: skip
    out.update_yaxes(autorange="reversed", dtick=1)
    out.update_xaxes(type="category", dtick=1, tickangle=0)
    return out


def pareto(candidates: Sequence[Mapping[str, Any]], *, most: int = 12, theme: Theme = LIGHT) -> go.Figure:
    """The error (K) that each refitted candidate would take away, largest first, held-out tests beside those used."""
    fitted = [c for c in candidates if c.get("rmse_K")]
    best = sorted(fitted, key=lambda c: _fall(c["rmse_K"]), reverse=True)[:most]
    out = figure(theme, title={"text": "What each candidate would take away", "x": 0.02}, barmode="group")
    names = [c["effect"] for c in best]
    colours = [DECISION[c["decision"]] for c in best]
    out.add_bar(x=names, y=[_fall(c["rmse_K"]) for c in best], name="tests used", marker_color=colours)
    if any(c.get("holdout_rmse_K") for c in best):
        held = [_fall(c["holdout_rmse_K"]) if c.get("holdout_rmse_K") else None for c in best]
        out.add_bar(x=names, y=held, name="held-out tests", marker_color=BLUE, opacity=0.6)
    out.update_yaxes(title="fall of the rms error (K)")
    out.update_xaxes(tickangle=35)
    return out


def _fall(pair: Mapping[str, float]) -> float:
    return pair["before"] - pair["after"]
