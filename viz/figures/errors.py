"""The error falling: before and after per test, and over the revisions of a model."""

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.errors import InputError
from viz.colours import BLUE, LIGHT, VERMILION
from viz.figures import paper
from viz.labels import end_labels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PALE = "#8DB9DB"
TITLED = 0.93  # of an axis' height, from where on small words would run into the title
BESIDE = 100.0  # points that the second label of two levels stands to the right: they may be close


@paper.styled
def before_after(
    tests: Sequence[Mapping[str, Any]],
    *,
    floor_K: float | None = None,
    most_K: float = 0.0,
    title: str = "",
    png: str | Path | None = None,
) -> "Figure":
    """A bar per test: what is left of its error, and pale what fell; what rose is vermilion. Held-out tests in bold.

    tests : [{"name", "role", "rmse_K": {"before", "after"}}] as in an `add` document;  most_K : the largest error ever
    """
    if not tests:
        raise InputError("no tests to draw", "before_after", "the `tests` list of an add, remove or calibrate result")
    figure, (ax,) = paper.subplots(8.4, 0.45 * len(tests) + 1.3)
    for y, test in enumerate(reversed(tests)):
        before, after = test["rmse_K"]["before"], test["rmse_K"]["after"]
        ax.barh(y, min(before, after), height=0.6, color=BLUE)
        change = {"color": VERMILION} if after > before else {"color": PALE, "alpha": 0.5}
        ax.barh(y, abs(after - before), left=min(before, after), height=0.6, **change)
        ax.text(max(before, after), y, f"\u00a0{before:.2f} → {after:.2f} K", va="center", fontsize=8.5)
    ax.set_yticks(range(len(tests)), [f"{t['name']}\n({t['role']})" for t in reversed(tests)])
    for label, test in zip(ax.get_yticklabels(), reversed(tests), strict=True):
        label.set_fontweight("bold" if test["role"] == "hold-out" else "normal")
    if floor_K is not None:
        ax.axvline(floor_K, color=LIGHT.faint, lw=0.9, ls=":", zorder=0)
        ax.text(floor_K, 1.0, "sensors' uncertainty", transform=ax.get_xaxis_transform(), fontsize=8, va="bottom")
    ax.grid(False, axis="y")
    most = max([most_K, *(error for t in tests for error in t["rmse_K"].values())])
    ax.set(xlabel="rms error (K); pale: what fell", title=title, xlim=(0.0, 1.18 * most))
    return paper.save(figure, png)


@paper.styled
def staircase(
    history: Sequence[Mapping[str, Any]],
    *,
    floor_K: float | None = None,
    plain_K: float | None = None,
    png: str | Path | None = None,
) -> "Figure":
    """Error of every test over the revisions: a step per revision, held-out tests drawn strong.

    floor_K, plain_K : what the sensors' own uncertainty explains, and what the best plain model leaves
    history : [{"number", "action", "words", "tests": [{"name", "role", "rmse_K": {"before", "after"}}]}]
    """
    if not history:
        raise InputError("no revisions to draw", "staircase", "a model with at least one revision")
    figure, (ax,) = paper.subplots(max(8.4, 1.3 * len(history) + 3.0), 4.2)
    paths = error_paths(history)
    for (_, role), errors in paths.items():
        style: dict[str, Any] = {"color": BLUE, "lw": 2.4} if role == "hold-out" else {"color": PALE, "lw": 1.4}
        ax.step(range(len(errors)), errors, where="post", **style)
        ax.plot([len(errors) - 1, len(errors) - 0.5], [errors[-1]] * 2, **style)
    colours = [BLUE if role == "hold-out" else LIGHT.ink for _, role in paths]
    ax.set_ylim(0, 1.12 * max(max(e) for e in paths.values()))
    ax.set_xlim(-0.1, len(history) + 0.5)
    end_labels(ax, [e[-1] for e in paths.values()], [f"{name} ({role})" for name, role in paths], colours)
    if floor_K is not None:
        _level(ax, floor_K, "sensors' uncertainty")
    if plain_K is not None and plain_K < ax.get_ylim()[1]:
        _level(ax, plain_K, "best plain model", BESIDE)
    words = [f"{r['number']}\n{textwrap.fill('+ ' * (r['action'] == 'add') + r['words'], 17)}" for r in history]
    ax.set_xticks(range(len(history) + 1), ["start", *words])
    ax.grid(False, axis="x")
    ax.set(ylabel="rms error (K)", title="Error of every test; strong: never used")
    return paper.save(figure, png)


def _level(ax: "Axes", error_K: float, words: str, right: float = 0.0) -> None:
    """A dotted line at an error, with what it is: above it, or below where the title would be.  right : points"""
    ax.axhline(error_K, color=LIGHT.ink, lw=0.9, ls=":")
    side, of = "top" if error_K > TITLED * ax.get_ylim()[1] else "bottom", "offset points"
    ax.annotate(words, (0, error_K), (right, 0), textcoords=of, fontsize=8, va=side)


def error_paths(history: Sequence[Mapping[str, Any]]) -> dict[tuple[str, str], list[float]]:
    """(test, role) -> error before the first revision and after each (K)."""
    paths: dict[tuple[str, str], list[float]] = {}
    for revision in history:
        for test in revision["tests"]:
            path = paths.setdefault((test["name"], test["role"]), [test["rmse_K"]["before"]])
            path.append(test["rmse_K"]["after"])
    return paths
