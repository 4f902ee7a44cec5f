"""Measured against modelled over time, sensor by sensor.

Measured is ink, the model is blue, an earlier model is dashed orange; nothing else has a colour unless it is wrong.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geom.errors import InputError
from validation.comparison.uncertainty import RULE
from viz.colours import BLUE, LIGHT, ORANGE, VERMILION
from viz.data import Comparison, short
from viz.figures import paper
from viz.labels import end_labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from measured.case import Channel


@paper.styled
def measured_and_model(comparison: Comparison, *, columns: int = 3, png: str | Path | None = None) -> Figure:
    """A panel per sensor: readings with the band that counts as within, the model, and the earlier model if given."""
    channels = _read(comparison)
    columns = min(columns, len(channels))
    rows = -(-len(channels) // columns)
    figure, axes = paper.subplots(3.4 * columns, 2.2 * rows + 0.4, rows, columns)
    for ax, channel in zip(axes, channels, strict=False):
        _panel(ax, comparison, channel)
    for ax in axes[len(channels) :]:
        ax.set_visible(False)
    _name_lines(axes[0], comparison)
    figure.suptitle(f"{comparison.test.name}: measured and modelled", fontsize=10.5, color=LIGHT.ink)
    figure.supxlabel(f"time ({comparison.clock[1]})", fontsize=9.5, color=LIGHT.ink)
    figure.supylabel("temperature (°C)", fontsize=9.5, color=LIGHT.ink)
    return paper.save(figure, png)


@paper.styled
def residuals(comparison: Comparison, *, png: str | Path | None = None) -> Figure:
    """Measured - modelled per sensor over time; those that are over are coloured, named in bold."""
    figure, (ax,) = paper.subplots(8.4, 3.8)
    (t, unit), thin = comparison.clock, comparison.thin
    channels = _read(comparison)
    shade(ax, comparison)
    colours = []
    for channel in channels:
        r = comparison.residual(channel)
        colours.append(wrongness(r, comparison.limit_K(channel)))
        ax.plot(t[thin], r[thin], color=colours[-1], lw=1.6 if colours[-1] != LIGHT.faint else 1.0)
        alone(ax, t, r, colours[-1])
    ends = [float(r[np.isfinite(r)][-1]) for r in map(comparison.residual, channels)]
    end_labels(ax, ends, [short(c.name) for c in channels], [LIGHT.ink if c == LIGHT.faint else c for c in colours])
    ax.axhline(0, color=LIGHT.ink, lw=0.8)
    ax.margins(x=0)
    ax.set(
        xlabel=f"time ({unit})", ylabel="measured − model (K)", title=f"{comparison.test.name}: what the model misses"
    )
    ax.set_title(f"grey is {RULE}", loc="right", fontweight="normal", fontsize=8.5)
    return paper.save(figure, png)


def _read(comparison: Comparison) -> tuple[Channel, ...]:
    if not comparison.channels:
        raise InputError("no channel was ever read", f"test '{comparison.test.name}'", "at least one with readings")
    return comparison.channels


def _panel(ax: Axes, comparison: Comparison, channel: Channel) -> None:
    thin = comparison.thin
    t, y = comparison.clock[0][thin], np.asarray(channel.y, float)[thin]
    shade(ax, comparison)
    limit = comparison.limit_K(channel)
    ax.fill_between(t, y - limit, y + limit, color=LIGHT.faint, alpha=0.45, lw=0)
    ax.plot(t, y, color=LIGHT.ink, lw=1.0)
    read = np.asarray(channel.y, float)
    alone(ax, comparison.clock[0], read, LIGHT.ink, limit)
    if comparison.before is not None:
        ax.plot(t, comparison.before[channel.name][thin], color=ORANGE, lw=1.4, ls=(0, (4, 2)))
    ax.plot(t, comparison.model[channel.name][thin], color=BLUE)
    ax.set_title(short(channel.name))
    ax.margins(x=0)
    over = comparison.rmse(channel) > limit
    colour = VERMILION if over else LIGHT.ink
    ax.set_title(
        f"rms {comparison.rmse(channel):.1f} K", loc="right", color=colour, fontweight="bold" if over else "normal"
    )


def alone(ax: Axes, t: np.ndarray, y: np.ndarray, colour: str, within: float = 0.0) -> None:
    """Dots where a reading has no neighbour, so that no line would show it, with a bar of +- `within` on each."""
    finite = np.pad(np.isfinite(y), 1)
    lone = finite[1:-1] & ~finite[:-2] & ~finite[2:]
    if lone.any():
        ax.errorbar(t[lone], y[lone], yerr=within or None, fmt="o", ms=3.5, color=colour, elinewidth=1.0, zorder=3)


def _name_lines(ax: Axes, comparison: Comparison) -> None:
    """Names written once, top left of the first panel, in the colour of their lines."""
    lines = [("measured ± limit", LIGHT.ink), ("model", BLUE)] + [("earlier model", ORANGE)] * (
        comparison.before is not None
    )
    for i, (text, colour) in enumerate(lines):
        ax.text(0.03, 0.97 - 0.12 * i, text, transform=ax.transAxes, va="top", color=colour, fontsize=8.5)


def shade(ax: Axes, comparison: Comparison) -> None:
    """When something was different."""
    unit_s = 60.0 if comparison.clock[1] == "min" else 3600.0
    for begin, end in comparison.events:
        ax.axvspan(begin / unit_s, end / unit_s, color=ORANGE, alpha=0.15, lw=0)


def wrongness(residual: np.ndarray, limit: float) -> str:
    """Faint where the rms of the test is within the limit; else by sign: vermilion where the machine, once warm, is
    hotter than the model, blue where it is colder."""
    finite = residual[np.isfinite(residual)]
    if not finite.size or np.sqrt(np.mean(finite**2)) <= limit:
        return LIGHT.faint
    return VERMILION if finite[len(finite) // 2 :].mean() > 0 else BLUE
