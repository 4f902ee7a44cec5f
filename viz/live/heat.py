"""Where the heat goes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geom.errors import InputError
from viz.colours import LIGHT, VERMILION, Theme
from viz.figures.flows import Heat
from viz.figures.sankey import colour_of, exits
from viz.live.style import faded, figure

if TYPE_CHECKING:
    import plotly.graph_objects as go


def sankey(heat: Heat, *, theme: Theme = LIGHT) -> go.Figure:
    """Losses on the left, exits and what warms the machine on the right (W)."""
    left, right = {k: v for k, v in heat.losses.items() if v > 0}, exits(heat)
    if not left:
        raise InputError("no losses to draw", "sankey", "a machine that is running")
    names, middle = [*left, "all losses", *right], len(left)
    watts = [*left.values(), *right.values()]
    source = [*range(middle), *[middle] * len(right)]
    target = [*[middle] * len(left), *range(middle + 1, len(names))]
    colours = [VERMILION] * len(left) + [colour_of(k, heat) for k in right]
    out = figure(theme, title={"text": f"{sum(left.values()):.0f} W", "x": 0.02})
    out.add_sankey(
        node={"label": names, "color": theme.faint, "pad": 18, "line": {"width": 0}}, valueformat=".0f",
        valuesuffix=" W", arrangement="snap",
        link={"source": source, "target": target, "value": watts, "color": [faded(c, 0.6) for c in colours]},
    )  # fmt: skip
    return out
