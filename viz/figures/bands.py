"""How sure a model is: temperatures and missing heat over time with 95 % bands, calibrated values with intervals."""

import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from geom.table import unit_suffix, with_interval
from viz.colours import BLUE, LIGHT, ORANGE, VERMILION
from viz.data import short
from viz.figures import paper
from viz.labels import minus

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMNS, MOST, ROWS = 3, 12, 16  # panels, and rows of intervals: more are not read


@dataclass(frozen=True)
class Predicted:
    """One place.  y, half95 (nt,) degC and K;  read (nt,) degC of a sensor there, None where there is none"""

    name: str
    y: Array
    half95: Array
    read: Array | None = None


@paper.styled
def predicted(time: Array, places: Sequence[Predicted], *, title: str = "", png: str | Path | None = None) -> "Figure":
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
) -> "Figure":
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


WIDEST = 2.5  # of what was expected: an interval that is wider runs off the picture


@paper.styled
def intervals(parameters: Sequence[Mapping[str, Any]], *, png: str | Path | None = None) -> "Figure":
    """Each value with its 95 % interval on the scale of what was expected (grey), in the order given.

    Blue is what the data fix; pale what they leave as it was; vermilion what left the expected.
    parameters : name, value, unit, ci95, prior [value, low, high] and identified, as `calibrate` lists them, and words
        if there are; those of sensors are left out
    """
    rows = []
    for p in (p for p in parameters if p["prior"] and not p.get("of_measurement")):
        middle, low, high = p["prior"]
        half = (high - low) / 2
        rows.append((p, [(x - middle) / half for x in (p["value"], *p["ci95"])]))
    rows = rows[:ROWS][::-1]
    figure, (ax,) = paper.subplots(8.4, 0.3 * len(rows) + 1.2)
    ax.axvspan(-1.0, 1.0, color=LIGHT.faint, alpha=0.2, lw=0)
    for y, (p, (x, a, b)) in enumerate(rows):
        colour = VERMILION if abs(x) > 1.0 else BLUE
        alpha = 1.0 if p["identified"] else 0.35
        ax.plot([a, b], [y, y], color=colour, lw=2.2, alpha=alpha, solid_capstyle="butt")
        at, mark = (x, "o") if abs(x) < WIDEST else (0.98 * WIDEST, ">") if x > 0 else (-0.98 * WIDEST, "<")
        ax.plot([at], [y], mark, color=colour, ms=5.0, alpha=alpha)
        words = f"{minus(with_interval(p['value'], *p['ci95']))}{unit_suffix(p['unit'])}".replace(" ... ", " … ")
        ax.text(1.02, y, words, transform=ax.get_yaxis_transform(), va="center", fontsize=8)
    ax.set_yticks(range(len(rows)), [textwrap.fill(p.get("words", p["name"]), 44) for p, _ in rows], fontsize=8.5)
    ax.grid(False, axis="y")
    ax.set(
        xlim=(-WIDEST, WIDEST), xlabel="deviation from what was expected; grey: its 95 %; pale: not fixed by the data"
    )
    ax.set_title("Sizes, and how sure they are (95 %)")
    return paper.save(figure, png)
