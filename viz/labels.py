"""Labels that do not sit on each other."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def signed(value: float, digits: int = 1) -> str:
    """A number with its sign, which is the one of mathematics; what rounds to zero is +0."""
    return minus(f"{round(value, digits) + 0.0:+.{digits}f}")


def minus(number: str) -> str:
    """A printed number with the sign that matplotlib and the pages write, not a hyphen."""
    return number.replace("-", "−")


def spread_labels(values: Sequence[float], low: float, high: float, gap: float) -> list[float]:
    """Rising values moved apart to at least `gap` (less if they do not fit), within low..high, near where they were."""
    if not len(values):
        return []
    gap = min(gap, (high - low) / max(len(values) - 1, 1))
    steps = gap * np.arange(len(values))
    away = np.clip(np.asarray(values, float) - steps, low, high - steps[-1])  # apart by the gap where these rise
    upwards, downwards = np.maximum.accumulate(away), np.minimum.accumulate(away[::-1])[::-1]
    return (0.5 * (upwards + downwards) + steps).tolist()  # a crowd spreads about its middle


def end_labels(
    ax: "Axes", ends: Sequence[float], names: Sequence[str], colours: Sequence[str], size: float = 8.5
) -> None:
    """Names at the right edge of the axes, each tied to the end of its line."""
    low, high = ax.get_ylim()
    order = np.argsort(ends)
    heights = spread_labels([float(ends[i]) for i in order], low, high, 0.055 * (high - low))
    ax.set_ylim(low, high)
    across = ax.get_yaxis_transform()
    for i, y in zip(order, heights, strict=True):
        ax.plot([1.0, 1.012], [ends[i], y], transform=across, color=colours[i], lw=0.7, clip_on=False)
        style: dict[str, Any] = {"color": colours[i], "fontsize": size, "va": "center", "annotation_clip": False}
        place: dict[str, Any] = {"xycoords": ("axes fraction", "data"), "textcoords": "offset points"}
        ax.annotate(names[i], (1.0, y), (9, 0), **place, **style)
