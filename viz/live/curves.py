"""Live figures in one look: measured against modelled, residuals, against an input, parity, and like candidates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from geom.errors import InputError, MissingDependency
from viz.colours import LIGHT, Theme, rgb
from viz.data import Comparison, Curve, short

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from measured.case import Channel

STATIC = (".png", ".svg", ".pdf")


def figure(theme: Theme = LIGHT, rows: Sequence[float] = (1.0,), **layout: Any) -> go.Figure:
    """An empty figure of `rows` panels of the given heights over one x axis."""
    from plotly.subplots import make_subplots

    out = make_subplots(len(rows), 1, shared_xaxes=True, row_heights=list(rows), vertical_spacing=0.06)
    grid = {"gridcolor": faded(theme.faint, 0.25), "linecolor": theme.faint, "zeroline": False, "automargin": True}
    look: dict[str, Any] = {
        "template": None,
        "paper_bgcolor": theme.paper,
        "plot_bgcolor": theme.paper,
        "hovermode": "closest",
    }
    look |= {"font": {"family": "DejaVu Sans, Arial, sans-serif", "size": 12, "color": theme.ink}}
    look |= {"margin": {"l": 56, "r": 16, "t": 56, "b": 44}}
    look |= {"legend": {"orientation": "h", "y": 1.0, "yanchor": "bottom"}}
    out.update_layout(**look, **layout)
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


LABEL = 30  # letters of a label's line


def channel_of(comparison: Comparison, name: str) -> Channel:
    """The channel of that name; an InputError lists the others."""
    channel = next((c for c in comparison.channels if c.name == name), None)
    if channel is None:
        right = ", ".join(c.name for c in comparison.channels)
        raise InputError(f"no channel '{name}'", f"test '{comparison.test.name}'", f"known: {right}")
    return channel


def sensor(comparison: Comparison, channel: str, *, theme: Theme = LIGHT) -> go.Figure:
    """Readings with the band that counts as within, the model, the earlier one; below them measured - modelled (K)."""
    c = channel_of(comparison, channel)
    (t, unit), thin = comparison.clock, comparison.thin
    x, y, band = plain(t[thin]), np.asarray(c.y, float)[thin], comparison.limit_K(c)
    title = {"text": as_text(f"{short(c.name)} ({c.place})"), "x": 0.02, "y": 0.98, "font": {"size": 14}}
    out = figure(theme, (0.66, 0.34), title=title)
    shade = {"fill": "tonexty", "fillcolor": faded(theme.faint, 0.4), "line": {"width": 0}, "hoverinfo": "skip"}
    for values, style in ((y - band, {"line": {"width": 0}, "hoverinfo": "skip"}), (y + band, shade)):
        out.add_scatter(x=x, y=plain(values), mode="lines", showlegend=False, row=1, col=1, **style)
    out.add_hrect(-band, band, fillcolor=faded(theme.faint, 0.3), line_width=0, row=2, col=1)
    for row, curves in enumerate((comparison.temperatures(c), comparison.residuals(c)), 1):
        for curve in curves:
            _line(out, x, replace(curve, y=curve.y[thin]), row, theme)
    out.update_yaxes(title="°C", row=1, col=1)
    out.update_yaxes(title="residual (K)", nticks=4, row=2, col=1)
    out.update_xaxes(title=f"time ({unit})", row=2, col=1)
    return out


def residuals(comparison: Comparison, *, theme: Theme = LIGHT) -> go.Figure:
    """Measured - modelled of every sensor over time (K); each in the colour of its sensor."""
    (t, unit), thin = comparison.clock, comparison.thin
    out = figure(theme, title={"text": f"{as_text(comparison.test.name)}: what the model misses", "x": 0.02})
    for c in comparison.channels:
        curve = comparison.residual_curve(c)
        _line(out, plain(t[thin]), replace(curve, y=curve.y[thin]), 1, theme)
    out.update_xaxes(title=f"time ({unit})")
    out.update_yaxes(title="measured − model (K)", zeroline=True, zerolinecolor=theme.ink)
    return out


def against_input(comparison: Comparison, channel: str, name: str, *, theme: Theme = LIGHT) -> go.Figure:
    """The residual of one sensor (K) against an input or boundary of the test: a trend names what is missing."""
    c, inputs = channel_of(comparison, channel), {**comparison.test.inputs, **comparison.test.boundaries}
    if name not in inputs:
        raise InputError(f"no input '{name}'", f"test '{comparison.test.name}'", f"known: {', '.join(inputs)}")
    (t, unit), thin = comparison.clock, comparison.thin
    x = np.broadcast_to(np.asarray(inputs[name], float), t.shape)[thin]
    out = figure(theme, title={"text": as_text(f"{short(c.name)}: residual against {name}"), "x": 0.02})
    dots = {"color": plain(t[thin]), "colorscale": "Viridis", "size": 5, "colorbar": {"title": f"time ({unit})"}}
    out.add_scatter(x=plain(x), y=plain(comparison.residual(c)[thin]), mode="markers", marker=dots, showlegend=False)
    out.update_xaxes(title=as_text(name))
    out.update_yaxes(title="measured − model (K)", zeroline=True, zerolinecolor=theme.ink)
    return out


def parity(comparison: Comparison, *, theme: Theme = LIGHT) -> go.Figure:
    """Modelled against measured (degC), a colour per sensor; a right model lies on the line."""
    out = figure(theme, title={"text": f"{as_text(comparison.test.name)}: modelled against measured", "x": 0.02})
    thin = 4
    low, high = np.inf, -np.inf
    for c in comparison.channels:
        y, model = np.asarray(c.y, float), np.asarray(comparison.model[c.name], float)
        pair = np.concatenate([y[np.isfinite(y)], model])
        low, high = min(low, float(pair.min())), max(high, float(pair.max()))
        style = {"mode": "markers", "name": as_text(short(c.name)), "marker_size": 4}
        out.add_scatter(x=plain(y[::thin]), y=plain(model[::thin]), **style)
    out.add_scatter(x=[low, high], y=[low, high], mode="lines", showlegend=False, line={"color": theme.ink, "width": 1})
    out.update_xaxes(title="measured (°C)")
    out.update_yaxes(title="modelled (°C)", scaleanchor="x")
    return out


def confusion(names: Sequence[str], cosine: Array, *, theme: Theme = LIGHT) -> go.Figure:
    """|cosine| between the traces of candidates, (n, n): 1 cannot be told apart with these sensors and tests."""
    c = np.abs(np.asarray(cosine, float))
    out = figure(theme, title={"text": "Traces in common (1: cannot be told apart)", "x": 0.02, "font": {"size": 13}})
    numbers = [str(i) for i in range(1, len(names) + 1)]
    labels = [f"{'<br>'.join(map(as_text, wrap(name, LABEL)))}  {i}" for name, i in zip(names, numbers, strict=True)]
    style = {"zmin": 0, "zmax": 1, "colorscale": "Blues", "showscale": False, "texttemplate": "%{z:.2f}"}
    style |= {"hovertemplate": "%{x}<br>%{y}<br>%{z:.3f}<extra></extra>"}
    out.add_heatmap(z=[plain(row) for row in c], x=numbers, y=labels, **style)
    out.update_yaxes(autorange="reversed", dtick=1)
    out.update_xaxes(type="category", dtick=1, tickangle=0)
    return out


def _line(out: go.Figure, x: list, curve: Curve, row: int, theme: Theme) -> None:
    colour = theme.ink if curve.ink else curve.colour
    line = {"color": colour, "width": 2.0 if row == 1 else 1.6, "dash": "dash" if curve.dashed else "solid"}
    style = {"line": line, "showlegend": row == 1, "row": row, "col": 1, "hovertemplate": "%{y:.2f}"}
    out.add_scatter(x=x, y=plain(curve.y), mode="lines", name=as_text(curve.name), **style)
