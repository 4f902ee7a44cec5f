"""Figures on paper: one style for all plots, as PNG, or as SVG whose ink follows the page's light or dark theme."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from threading import current_thread, main_thread
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from viz.colours import BLUE, LIGHT, VERDICT, VERMILION

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

P = ParamSpec("P")
R = TypeVar("R")
DPI = 150  # sharp on a page
_STYLE: dict[Any, Any] = {
    "font.size": 9.5,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": LIGHT.faint,
    "axes.labelcolor": LIGHT.ink,
    "axes.titlecolor": LIGHT.ink,
    "text.color": LIGHT.ink,
    "xtick.color": LIGHT.ink,
    "ytick.color": LIGHT.ink,
    "axes.grid": True,
    "grid.color": LIGHT.faint,
    "grid.alpha": 0.25,
    "grid.linewidth": 0.6,
    "xtick.major.size": 0,
    "ytick.major.size": 0,
    "lines.linewidth": 1.6,
    "svg.fonttype": "none",
    "svg.hashsalt": "thermoscope",
    "figure.constrained_layout.use": True,
    "text.parse_math": False,
}
_CSS = {LIGHT.ink: "ink", LIGHT.faint: "faint", LIGHT.paper: "paper", BLUE: "blue", VERMILION: "red"}
_CSS |= {VERDICT["hot"]: "warn", VERDICT["within"]: "good"}


def subplots(width: float, height: float, rows: int = 1, columns: int = 1) -> tuple[Figure, list[Axes]]:
    """A figure of width x height inches and its axes, row by row; no window, no global state."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), facecolor=LIGHT.paper)
    axes = figure.subplots(rows, columns, squeeze=False, sharex=columns > 1)
    return figure, list(axes.ravel())


def panels(
    count: int, across: int, size: tuple[float, float], title: str = "", x: str = "", y: str = "", more: float = 0.4
) -> tuple[Figure, list[Axes]]:
    """As many panels of a size (inches), at most so many `across`, with words above, below and beside all of them."""
    across = min(across, count)
    rows = -(-count // across)
    figure, axes = subplots(size[0] * across, size[1] * rows + more, rows, across)
    for ax in axes[count:]:
        ax.set_visible(False)
    for ax in axes[count - across : count]:
        ax.tick_params(labelbottom=True)  # also where the row below ends before
    figure.suptitle(title, fontsize=10, color=LIGHT.ink)
    figure.supxlabel(x, fontsize=9.5, color=LIGHT.ink)
    figure.supylabel(y, fontsize=9.5, color=LIGHT.ink)
    return figure, axes


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw in the house style, whatever the user's matplotlib is set to."""

    @wraps(draw)
    def inner(*args: P.args, **options: P.kwargs) -> Figure:
        from matplotlib import rc_context

        with rc_context(_STYLE):
            return draw(*args, **options)

    return inner


def draw_all(draws: Sequence[Callable[[], R]]) -> list[R]:
    """What each of them returns, in two processes where there is room: Matplotlib holds Python's lock as it draws.

    Beside other threads of a server nothing is forked.
    """
    from fem.solvers.two_processes import LEAST, in_two_processes

    alone = current_thread() is main_thread()
    return in_two_processes(lambda draw: draw(), draws, LEAST) if alone else [draw() for draw in draws]


def save(figure: Figure, path: str | Path | None) -> Figure:
    """The figure, also written as .png, .svg or .pdf if a path is given."""
    if path is not None:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Glyph .* missing")  # a header in Japanese has boxes for letters
            figure.savefig(path, dpi=DPI)
    return figure


def svg(figure: Figure, name: str) -> str:
    """An <svg> element for a page: its own ids, transparent, ink and paper as CSS variables with fallbacks."""
    from matplotlib import rc_context

    out = io.StringIO()
    with rc_context({**_STYLE, "svg.hashsalt": name}):
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None, "Creator": None})
    text = out.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text[text.index("<svg") :], flags=re.S)
    for colour, variable in _CSS.items():
        text = text.replace(colour.lower(), f"var(--{variable}, {colour})")
    text = re.sub(r'(width|height)="[\d.]+pt" ', "", text, count=2)
    return re.sub(r'(id="|url\(#|href="#)', rf"\g<1>{re.sub(r'[^a-z0-9]+', '-', name.lower())}-", text)
