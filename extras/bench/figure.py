"""What a screening found: which of many factors move a temperature, and which effects are no more than noise.

Sources: Daniel 1959 (half-normal plot); Lenth 1989 (limits); Morris 1991 and Sobol by their own measures.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import halfnorm

from thermoscope import plugin as th

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from extras.bench.measuring.drift import Drift
    from extras.bench.steady_law.law import SteadyLaw
    from extras.bench.steady_law.steady_tests import SteadyTests

Row = Mapping[str, Any]
TOP = 8  # bars that can be read
SERIES = (th.BLUE, th.VERMILION, "#009e73", "#cc79a7", "#e69f00", "#56b4e9", th.LIGHT.ink)  # Okabe and Ito
LENTH = (("margin", "Lenth, each", "--"), ("simultaneous", "Lenth, all at once", ":"))


@th.paper.styled
def screened(effects: Row, *, unit: str = "K", title: str = "", png: str | Path | None = None) -> Figure:
    """Half-normal plot and Pareto chart of the effects on one response, with Lenth's limits.

    effects : {"margin", "simultaneous", "effects": [{"effect", "words", "value", "active"}]}, as `screen` gives it
    """
    rows = sorted(effects["effects"], key=lambda e: abs(e["value"]))
    figure, (left, right) = th.paper.subplots(9.6, 4.0, columns=2)
    size = np.array([abs(e["value"]) for e in rows])
    x = halfnorm.ppf((np.arange(len(rows)) + 0.5) / len(rows))
    shades = [th.BLUE if e["active"] else th.LIGHT.faint for e in rows]
    left.scatter(size, x, s=22, c=shades, zorder=3)
    for i in [i for i, e in enumerate(rows) if e["active"]][-TOP:]:
        left.annotate(rows[i]["effect"], (size[i], x[i]), (6, 0), textcoords="offset points", va="center", fontsize=8)
    left.set(ylabel="half-normal quantile", ylim=(0, None))
    _bars(right, [e["words"] for e in rows[-TOP:]], list(size[-TOP:]), shades[-TOP:])
    for ax in (left, right):
        for key, words, line in LENTH:
            ax.axvline(effects[key], color=th.LIGHT.ink, lw=1.0, ls=line, label=words)
        ax.set_xlabel(f"|high - low| ({unit})")
    left.legend(fontsize=8, frameon=False, loc="lower right")
    left.set_title(title)
    return th.paper.save(figure, png)


@th.paper.styled
def ranking(rows: Sequence[Row], *, measure: str, title: str = "", png: str | Path | None = None) -> Figure:
    """Factors by their share or size, with 95 % intervals: [{"factor", "measure", "conf95"}], as Morris or Sobol."""
    up = sorted(rows, key=lambda r: r["measure"])
    figure, (ax,) = th.paper.subplots(6.4, 0.4 * len(up) + 1.2)
    sizes = [r["measure"] for r in up]
    _bars(ax, [r["factor"] for r in up], sizes, [th.BLUE] * len(up))
    ax.errorbar(sizes, range(len(up)), xerr=[r["conf95"] for r in up], fmt="none", ecolor=th.LIGHT.ink, lw=1.0)
    ax.set(xlabel=measure, title=title, xlim=(0, None))
    return th.paper.save(figure, png)


@th.paper.styled
def two_tests(result: Drift, *, png: str | Path | None = None) -> Figure:
    """A panel per sensor, what changed first: the earlier test with the band of equal ones, and the later test."""
    first = [c.channel for c in result.changes]
    sensors = sorted(result.sensors, key=lambda s: first.index(s.changes[0].channel))[:TOP]
    titles = f"{result.later} against {result.earlier}: {result.verdict}", "time (min)", "rise over ambient (K)"
    figure, axes = th.paper.panels(len(sensors), 3, (3.4, 2.4), *titles)
    for ax, s in zip(axes, sensors, strict=False):
        changed = any(c.verdict == "changed" for c in s.changes)
        ax.fill_between(s.minutes, s.earlier - s.band, s.earlier + s.band, color=th.LIGHT.faint, alpha=0.3, lw=0)
        ax.plot(s.minutes, s.earlier, color=th.LIGHT.ink, lw=1.0, label=result.earlier)
        ax.plot(s.minutes, s.later, color=th.VERMILION if changed else th.BLUE, label=result.later)
        ax.set_title(s.changes[0].place)
        rise = f"{100 * s.changes[0].change:+.1f} ± {100 * s.changes[0].U95:.1f} %"
        ax.set_title(rise, loc="right", fontweight="normal", fontsize=8.5)
    axes[0].legend(fontsize=8, frameon=False, loc="lower right")
    return th.paper.save(figure, png)


@th.paper.styled
def odds_over_time(run: th.BenchRun, *, png: str | Path | None = None) -> Figure:
    """The odds of a live bench over bench time, and the set points beneath, each as a share of its largest."""
    figure, (upper, lower) = th.paper.subplots(7.2, 4.6, rows=2)
    for name, minutes, percent in run.odds:
        upper.plot(minutes, percent, label=name)
    for (name, minutes, percent), dash in zip(run.set_points, ("-", "--", ":") * len(run.set_points), strict=False):
        lower.step(minutes, percent, where="post", label=name, ls=dash)  # one may hide another
    upper.axhline(90.0, color=th.LIGHT.faint, lw=1.0, ls="--")
    upper.set(ylabel="odds (%)", ylim=(0, 101))
    lower.set(xlabel="time (min)", ylabel="set point (%)", ylim=(-3, 103))
    for ax in (upper, lower):
        ax.set_xlim(0.0, run.end)
        ax.legend(fontsize=8, frameon=False)
    return th.paper.save(figure, png)


@th.paper.styled
def cooling_law(law: SteadyLaw, further: SteadyTests | None = None, *, png: str | Path | None = None) -> Figure:
    """Conductance to the coolant over the input with most levels: a panel per inlet, a line per level of the others.

    further : tests that the law was not made from, as rings
    """
    tests, columns = law.tests, law.tests.columns.inputs
    across = int(np.argmax([tests.levels(i).size for i in range(len(columns))]))
    (name, unit), top = columns[across], tests.scales.highest[across]
    units = [u or n for i, (n, u) in enumerate(columns) if i != across]
    every = [tests, *([further] if further is not None and further.names else [])]
    groups = [np.column_stack([np.round(t.coolant), np.delete(t.inputs, across, axis=1)]) for t in every]
    x = np.linspace(tests.scales.lowest[across], 1.5 * top, 61)
    inlets = np.unique(groups[0][:, 0])[:3]
    title = f"A law of {len(law.numbers)} numbers; dashed, rings: not among its tests"
    figure, axes = th.paper.panels(len(inlets), 3, (3.8, 3.2), title, f"{name} ({unit})", "W/K to the coolant")
    for ax, inlet in zip(axes, inlets, strict=True):
        lines = np.unique(np.vstack(groups)[np.concatenate(groups)[:, 0] == inlet], axis=0)
        for colour, group in zip(SERIES, lines, strict=False):
            G, half = law.curve(np.insert(np.tile(group[1:], (x.size, 1)), across, x, axis=1), inlet)
            inside = (x <= top) & (groups[0] == group).all(axis=1).any()
            ax.fill_between(x, G - half, G + half, color=colour, alpha=0.25, lw=0)
            label = ", ".join(f"{v:g} {u}" for v, u in zip(group[1:], units, strict=True))
            ax.plot(x, G, "--", color=colour, label=label)
            ax.plot(x[inside], G[inside], color=colour)
            for t, of, face in zip(every, groups, (colour, "none"), strict=False):
                rows = (of == group).all(axis=1)
                measured = (law.to_coolant(t) / (t.mean - t.coolant))[rows]
                ax.plot(t.inputs[rows, across], measured, "o", ms=4, color=colour, mfc=face)
        ax.set(title=f"coolant {inlet:g} degC", ylim=(0.0, None))
    if units:
        axes[0].legend(fontsize=8, frameon=False)
    return th.paper.save(figure, png)


def _bars(ax: Axes, words: Sequence[str], sizes: Sequence[float], colours: Sequence[str]) -> None:
    ax.barh(range(len(words)), sizes, color=list(colours))
    ax.set_yticks(range(len(words)), list(words))
    ax.grid(False, axis="y")
