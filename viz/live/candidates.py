"""Which candidates cannot be told apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viz.colours import LIGHT, Theme
from viz.live.style import as_text, figure, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go


def confusion(names: Sequence[str], cosine: NDArray[np.float64], *, theme: Theme = LIGHT) -> go.Figure:
    """|cosine| between the traces of candidates, (n, n): 1 cannot be told apart with these sensors and tests."""
    c = np.abs(np.asarray(cosine, float))
    out = figure(theme, title={"text": "Traces in common (1: cannot be told apart)", "x": 0.02, "font": {"size": 13}})
    numbers = [str(i) for i in range(1, len(names) + 1)]
    labels = [f"{as_text(name)}  {i}" for name, i in zip(names, numbers, strict=True)]
    out.add_heatmap(
        z=[plain(row) for row in c],
        x=numbers,
        y=labels,
        zmin=0,
        zmax=1,
        colorscale="Blues",
        showscale=False,
        texttemplate="%{z:.2f}",
        hovertemplate="%{x}<br>%{y}<br>%{z:.3f}<extra></extra>",
    )
    out.update_yaxes(autorange="reversed", dtick=1)
    out.update_xaxes(type="category", dtick=1, tickangle=0)
    return out
