"""What might be missing: half-normal plot, confusion matrix, Pareto of what each candidate explains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import halfnorm

from viz.candidates import DECISION, amplitude
from viz.colours import BLUE, LIGHT, Theme
from viz.live.style import figure, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go


def half_normal(candidates: Sequence[Mapping[str, Any]], *, theme: Theme = LIGHT) -> go.Figure:
    """Sorted |score| against half-normal quantiles with the line of the simulated nulls."""
    ranked = sorted(candidates, key=lambda c: abs(c["score"]))
    x = halfnorm.ppf((np.arange(len(ranked)) + 0.5) / max(len(ranked), 1))
    out = figure(theme, title={"text": "Scores against chance", "x": 0.02})
    colours = [DECISION[c["decision"]] for c in ranked]
    out.add_scatter(
        x=plain(x), y=[abs(c["score"]) for c in ranked], mode="markers", showlegend=False,
        marker={"color": colours, "size": 8}, text=[f"{c['effect']}<br>{amplitude(c)}" for c in ranked],
        hovertemplate="%{text}<br>|score| %{y:.1f}<extra></extra>",
    )  # fmt: skip
    if ranked:
        threshold = float(np.median([c["threshold"] for c in ranked]))
        out.add_hline(
            threshold, line={"color": theme.ink, "dash": "dot"}, annotation_text="threshold (simulated nulls)"
        )
    out.update_xaxes(title="half-normal quantile")
    out.update_yaxes(title="|score|", rangemode="tozero")
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
