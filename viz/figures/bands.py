"""Predicted temperatures over time with their 95 % bands, at sensors and at places without one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from viz.colours import BLUE, LIGHT, ORANGE
from viz.data import short
from viz.figures import paper

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
COLUMNS, MOST = 3, 12  # panels: more are not read


@dataclass(frozen=True)
class Predicted:
    """One place.  y, half95 (nt,) degC and K;  read (nt,) degC of a sensor there, None where there is none"""

    name: str
    y: Array
    half95: Array
    read: Array | None = None


@paper.styled
def predicted(time: Array, places: Sequence[Predicted], *, title: str = "", png: str | Path | None = None) -> Figure:
    """A panel per place, the least sure first: the model with its band, and what a sensor read.  time (nt,) s

    Where no sensor reads, model and band are orange.
    """
    widest = sorted(places, key=lambda p: -float(p.half95.max()))[:MOST]
    left = f"; {len(widest)} of {len(places)} places, the least sure" if len(widest) < len(places) else ""
    words = f"{title}{left}", "time (min)", "temperature, 95 % band (°C)"
    figure, axes = paper.panels(len(widest), COLUMNS, (3.4, 2.1), *words, more=0.5)
    for ax, place in zip(axes, widest, strict=False):
        _panel(ax, np.asarray(time, float) / 60.0, place)
    return paper.save(figure, png)


def _panel(ax: Axes, minutes: Array, place: Predicted) -> None:
    colour = BLUE if place.read is not None else ORANGE
    ax.fill_between(minutes, place.y - place.half95, place.y + place.half95, color=colour, alpha=0.25, lw=0)
    if place.read is not None:
        ax.plot(minutes, place.read, color=LIGHT.ink, lw=1.0)
    ax.plot(minutes, place.y, color=colour)
    ax.margins(x=0)
    ax.set_title(short(place.name.removeprefix("sensor ")))
    ax.set_title(f"± {float(place.half95.max()):.1f} K", loc="right", fontweight="normal", fontsize=8.5)
    if place.read is None:
        ax.text(0.03, 0.95, "no sensor", transform=ax.transAxes, va="top", color=LIGHT.ink, fontsize=8.5)
