"""One look for all live figures, on light or dark paper."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.errors import InputError, MissingDependency
from viz.colours import LIGHT, Theme, rgb

if TYPE_CHECKING:
    import plotly.graph_objects as go

STATIC = (".png", ".svg", ".pdf")


def figure(theme: Theme = LIGHT, rows: Sequence[float] = (1.0,), **layout: Any) -> go.Figure:
    """An empty figure of `rows` panels of the given heights over one x axis."""
    from plotly.subplots import make_subplots

    out = make_subplots(len(rows), 1, shared_xaxes=True, row_heights=list(rows), vertical_spacing=0.06)
    grid = {"gridcolor": faded(theme.faint, 0.25), "linecolor": theme.faint, "zeroline": False, "automargin": True}
    out.update_layout(
        template=None,
        paper_bgcolor=theme.paper,
        plot_bgcolor=theme.paper,
        hovermode="closest",
        font={"family": "DejaVu Sans, Arial, sans-serif", "size": 12, "color": theme.ink},
        margin={"l": 56, "r": 16, "t": 56, "b": 44},
        legend={"orientation": "h", "y": 1.0, "yanchor": "bottom"},
        **layout,
    )
    out.update_xaxes(**grid)
    out.update_yaxes(**grid)
    return out


def as_text(name: str) -> str:
    """A name as a label that Plotly, which takes some tags, shows as it is."""
    return escape(name, quote=False)


def faded(colour: str, opacity: float) -> str:
    """'#rrggbb' as rgba."""
    return f"rgba({','.join(map(str, rgb(colour)))},{opacity})"


def plain(values: Any) -> list[float | None]:
    """Numbers as JSON holds them: what is not finite is a gap."""
    return [float(v) if np.isfinite(v) else None for v in np.asarray(values, float).ravel()]


def save(figure: go.Figure, path: str | Path) -> Path:
    """Write .html (one file that needs no network), or .png, .svg, .pdf through kaleido and an installed Chromium."""
    path = Path(path)
    if path.suffix not in (".html", *STATIC):
        raise InputError(f"cannot write '{path.suffix}'", str(path), f"a name that ends in .html, {', '.join(STATIC)}")
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix == ".html":
        figure.write_html(path, include_plotlyjs=True, full_html=True)
        return path
    try:
        figure.write_image(path, scale=2)
    except (ImportError, ValueError, RuntimeError) as fault:
        raise MissingDependency(
            "a static picture of a live figure needs kaleido and Chromium (uv pip install kaleido; apt-get install -y "
            "chromium; a browser elsewhere is found through BROWSER_PATH); the drawings of viz.figures "
            f"need none without: {' '.join(str(fault).split())[:200]}"
        ) from None
    return path
