"""Measured against modelled over time, sensor by sensor; and the columns of a recording as they were understood.

Measured is ink, the model is blue, an earlier model is dashed orange; nothing else has a colour unless it is wrong.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from validation.comparison.uncertainty import RULE
from viz.colours import BLUE, LIGHT, ORANGE, VERDICT
from viz.data import Comparison, input_title, short
from viz.figures import paper
from viz.labels import end_labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from measured.case import Channel

MOST = 6  # lines with a name: more of one colour nobody follows


@paper.styled
def measured_and_model(comparison: Comparison, *, columns: int = 3, png: str | Path | None = None) -> Figure:
    """A panel per sensor: readings with the band that counts as within, the model, and the earlier model if given.

    Below them a row of what the test was driven with.
    """
    channels, title = _read(comparison), f"{comparison.test.name}: measured and modelled (°C)"
    time, across = f"time ({comparison.clock[1]})", min(columns, len(channels))
    inputs, above = varying_inputs(comparison)[: max(across, 2)], -(-len(channels) // across) * across
    title += ", and what drove it" if inputs else ""
    figure, axes = paper.panels(above + len(inputs), across, (3.4, 2.1), title, time)
    for ax, channel in zip(axes, channels, strict=False):
        _panel(ax, comparison, channel)
    for ax in axes[len(channels) : above]:
        ax.set_visible(False)
    (t, _), thin = comparison.clock, comparison.thin
    for ax, (name, values) in zip(axes[above:], inputs, strict=False):
        ax.fill_between(t[thin], 0.0, values[thin], color=LIGHT.faint, alpha=0.35, lw=0)
        ax.plot(t[thin], values[thin], color=LIGHT.ink, lw=0.9)
        ax.set_title(input_title(name))
        ax.margins(x=0)
    axes[0].legend(labelcolor="linecolor", handlelength=1.0, handletextpad=0.5, frameon=False, fontsize=8.5)  # once
    return paper.save(figure, png)


@paper.styled
def residuals(comparison: Comparison, *, png: str | Path | None = None) -> Figure:
    """Measured - modelled per sensor over time, each in the colour of its sensor; only the worst have names."""
    worst = sorted(_read(comparison), key=comparison.rmse, reverse=True)
    channels = sorted(worst, key=lambda c: comparison.sensor(c).verdict == "within")
    figure, (ax,) = paper.subplots(8.4, 3.8)
    (t, unit), thin = comparison.clock, comparison.thin
    shade(ax, comparison)
    curves = [comparison.residual_curve(channel) for channel in channels]
    for k, c in enumerate(curves):
        width = 1.6 if c.colour != VERDICT["within"] else 1.1
        ax.plot(t[thin], c.y[thin], color=c.colour, lw=width if k < MOST else 0.6, alpha=1.0 if k < MOST else 0.35)
        alone(ax, t, c.y, c.colour)
    ends = [float(c.y[np.isfinite(c.y)][-1]) for c in curves[:MOST]]
    end_labels(ax, ends, [c.name for c in curves[:MOST]], [c.colour for c in curves[:MOST]])
    ax.axhline(0, color=LIGHT.ink, lw=0.8)
    ax.margins(x=0)
    pale = f" (the {MOST} worst; pale: {len(curves) - MOST} more)" if len(curves) > MOST else ""
    ax.set(xlabel=f"time ({unit}); green is {RULE}", ylabel="measured − model (K)")
    ax.set_title(f"{comparison.test.name}: what the model misses{pale}")
    return paper.save(figure, png)


def varying_inputs(comparison: Comparison) -> list[tuple[str, np.ndarray]]:
    """(name, values) of the inputs that change during the test: currents, speeds and flows first."""
    t = np.asarray(comparison.test.time)
    every = [(n, np.broadcast_to(np.asarray(v, float), t.shape)) for n, v in comparison.test.inputs.items()]
    order = ("current", "speed", "flow")
    rank = {name: next((i for i, word in enumerate(order) if word in name), len(order)) for name, _ in every}
    return sorted((x for x in every if np.unique(x[1][np.isfinite(x[1])]).size > 1), key=lambda x: rank[x[0]])


def _read(comparison: Comparison) -> tuple[Channel, ...]:
    if not comparison.channels:
        raise InputError("no channel was ever read", f"test '{comparison.test.name}'", "at least one with readings")
    return comparison.channels


def _panel(ax: Axes, comparison: Comparison, channel: Channel) -> None:
    (t, _), thin, limit = comparison.clock, comparison.thin, comparison.limit_K(channel)
    shade(ax, comparison)
    for curve in comparison.temperatures(channel):
        if curve.ink:
            y = curve.y[thin]
            ax.fill_between(t[thin], y - limit, y + limit, color=LIGHT.faint, alpha=0.45, lw=0)
            alone(ax, t, curve.y, curve.colour, limit)
        dashes = (0, (4, 2)) if curve.dashed else "-"
        lw = 1.0 if curve.ink else 1.4 if curve.dashed else 1.6
        ax.plot(t[thin], curve.y[thin], color=curve.colour, lw=lw, ls=dashes, label=curve.name)
    ax.set_title(short(channel.name))
    ax.margins(x=0)
    sensor = comparison.sensor(channel)
    weight = "normal" if sensor.verdict == "within" else "bold"
    ax.set_title(f"rms {sensor.rmse_K:.2f} K", loc="right", color=sensor.colour, fontweight=weight)


def alone(ax: Axes, t: np.ndarray, y: np.ndarray, colour: str, within: float = 0.0) -> None:
    """Dots where a reading has no neighbour, so that no line would show it, with a bar of +- `within` on each."""
    finite = np.pad(np.isfinite(y), 1)
    lone = finite[1:-1] & ~finite[:-2] & ~finite[2:]
    if lone.any():
        ax.errorbar(t[lone], y[lone], yerr=within or None, fmt="o", ms=3.5, color=colour, elinewidth=1.0, zorder=3)


def shade(ax: Axes, comparison: Comparison) -> None:
    """When something was different."""
    unit_s = 60.0 if comparison.clock[1] == "min" else 3600.0
    for begin, end in comparison.events:
        ax.axvspan(begin / unit_s, end / unit_s, color=ORANGE, alpha=0.15, lw=0)


ACROSS, PANELS = 4, 48  # of a recording in a row; and in all, more cannot be read
POINTS = 2000  # of a curve: more do not show
SHORT = 30  # characters of a title


@dataclass(frozen=True)
class Panel:
    """time (n,) s;  values (n,) as written;  meaning : what the column is taken for, "" if it is left out"""

    name: str
    time: Array
    values: Array
    meaning: str
    is_temperature: bool


@paper.styled
def columns(panels: Sequence[Panel], title: str, *, png: str | Path | None = None) -> Figure:
    """Temperatures are blue, inputs orange, what is left out grey; the meaning stands under the name."""
    visible_panels = panels[:PANELS]
    figure, axes = paper.panels(len(visible_panels), ACROSS, (3.0, 1.8), title, more=0.5)
    for ax, panel in zip(axes, visible_panels, strict=False):
        colour = LIGHT.faint if not panel.meaning else BLUE if panel.is_temperature else ORANGE
        ax.plot(panel.time, panel.values, color=colour, lw=1.0)
        ax.set_title(panel.name[:SHORT], fontsize=8.5)
        ax.set_xlabel(f"{panel.meaning or 'left out'} over time (s)", fontsize=8)
        ax.margins(x=0)
    return paper.save(figure, png)
