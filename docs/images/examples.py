"""Draws the gallery of the examples: python docs/images/examples.py [NAME ...]

What an example computes over time beside what it should be; of one that computes a number the run that it is read
from, or else the numbers themselves.
"""

import runpy
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from viz.colours import BLUE, LIGHT, ORANGE
from viz.figures import paper
from viz.labels import end_labels

ROOT = Path(__file__).resolve().parents[2]
PICTURES = Path(__file__).parent / "gallery"
LINES = 5  # of a picture; of forty cells every tenth
OWN_PAGES = {"hust", "tclab", "live_bench"}  # minutes long, or of many programs; their pages have their pictures


def numbers(left: Mapping[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """(n, k) computed and expected, a column each."""
    pair = (np.asarray(x, float) for x in (left["computed"], left.get("expected", left.get("exact"))))
    computed, expected = (a.reshape(a.shape[0], -1) if a.ndim else a.reshape(1, 1) for a in pair)
    return computed, expected


@paper.styled
def drawn(left: Mapping[str, Any], png: Path | None = None) -> Figure:
    """left : the variables that an example leaves"""
    figure, (ax,) = paper.subplots(6.4, 3.0)
    computed, expected = numbers(left)
    time, run = left.get("time"), left.get("run")
    if time is not None and len(computed) == len(time):
        over(ax, "time (s)", np.asarray(time), computed, expected)
    elif time is not None and run is not None and getattr(run, "z", None) is not None:
        states(ax, np.asarray(time), run.z[:, : len(left["network"].states)], left["network"].states)
    elif computed.size <= LINES:
        bars(ax, computed.ravel(), expected.ravel())
    else:
        over(ax, "number", np.arange(computed.size), computed.reshape(-1, 1), expected.reshape(-1, 1))
    paper.save(figure, png)
    if png is not None:
        Image.open(png).convert("RGB").quantize(64, dither=Image.Dither.NONE).save(png, optimize=True)
    return figure


def over(ax: Axes, name: str, x: np.ndarray, computed: np.ndarray, expected: np.ndarray) -> None:
    """The computed columns, and over them dashed what they should be."""
    for a, b in zip(computed.T, expected.T, strict=True):
        ax.plot(x, a, color=BLUE, lw=2.4, label="computed")
        ax.plot(x, b, "--", color=ORANGE, lw=1.2, label="expected")
    handles, words = ax.get_legend_handles_labels()
    ax.legend(handles[:2], words[:2], frameon=False, labelcolor=LIGHT.ink)
    ax.set_xlabel(name, color=LIGHT.ink)


def bars(ax: Axes, computed: np.ndarray, expected: np.ndarray) -> None:
    """A few numbers, each with its digits."""
    at = np.arange(computed.size)
    for off, values, colour, word in ((-0.2, computed, BLUE, "computed"), (0.2, expected, ORANGE, "expected")):
        drawn = ax.barh(at + off, values, 0.36, color=colour)
        ax.bar_label(drawn, [f" {word} {v:.6g}" for v in values], color=LIGHT.ink)
    ax.invert_yaxis()
    ax.set_yticks([])
    ax.margins(x=0.35)


def states(ax: Axes, time: np.ndarray, T: np.ndarray, names: tuple[str, ...]) -> None:
    """Temperatures of some bodies."""
    shown = np.unique(np.linspace(0, len(names) - 1, min(LINES, len(names))).round().astype(int))
    ax.plot(time, T[:, shown], color=BLUE)
    end_labels(ax, [float(T[-1, k]) for k in shown], [names[k] for k in shown], [LIGHT.ink] * len(shown))
    ax.set_xlabel("time (s)", color=LIGHT.ink)
    ax.set_ylabel("temperature (°C)", color=LIGHT.ink)


def main(wanted: list[str]) -> None:
    for file in sorted((ROOT / "examples").glob("*.py")):
        missing = file.stem not in OWN_PAGES and not list(PICTURES.glob(f"{file.stem}*"))
        if file.stem in wanted or (missing and not wanted):
            drawn(runpy.run_path(str(file)), PICTURES / f"{file.stem}.png")


if __name__ == "__main__":
    main(sys.argv[1:])
