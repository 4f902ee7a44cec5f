"""Over time, with 95 % bands: predicted temperatures at sensors and elsewhere, and where heat is missing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from viz.colours import BLUE, LIGHT, ORANGE, VERMILION
from viz.data import short
from viz.figures import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
        minutes = np.asarray(time, float) / 60.0
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
    return paper.save(figure, png)


@paper.styled
def missing_heat(
    where: Sequence[Mapping[str, Any]], *, events: Sequence[Mapping[str, Any]] = (), png: str | Path | None = None
) -> Figure:
    """Missing heat (W) over each test at the likeliest place, with its 2-sigma band.

    events : of the same document, shaded as far as they are probable
    where : [{"place", "evidence_nats", "heat": {test: {"time_s", "heat_W", "sd_W"}}}], as in a `diagnose` document
    """
    best = max(where, key=lambda w: w["evidence_nats"])
    tests = list(best["heat"].items())
    title = f"{best['place']}: log odds {best['evidence_nats']:.0f} (3 is twenty to one)"
    words = title, "time (min)", "missing heat (W)"
    figure, axes = paper.panels(len(tests), 3, (3.2, 2.1), *words, more=0.5)
    for ax, (name, series) in zip(axes, tests, strict=False):
        t, q, sd = (np.asarray(series[key], float) for key in ("time_s", "heat_W", "sd_W"))
        ax.fill_between(t / 60, q - 2 * sd, q + 2 * sd, color=LIGHT.faint, alpha=0.4, lw=0)
        ax.plot(t / 60, q, color=VERMILION)
        ax.axhline(0, color=LIGHT.ink, lw=0.8)
        for event, span in [(e, s) for e in events for s in e["spans"] if s["test"] == name]:
            shade = 0.25 * event["probability"]
            ax.axvspan(span["begin_s"] / 60, span["end_s"] / 60, color=ORANGE, alpha=shade, lw=0)
        ax.margins(x=0)
        ax.set_title(name)
    return paper.save(figure, png)
