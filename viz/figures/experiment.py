"""A planned test: what each hypothesis predicts at the sensors that tell them apart."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from viz.colours import BLUE, GREEN, LIGHT, ORANGE, PURPLE, VERMILION
from viz.data import LONG_S, POINTS, short
from viz.figures import paper
from viz.labels import end_labels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from validation.revision.predicted_curves import PredictedCurves

COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE)
SENSORS = 4  # panels that a page holds side by side


@paper.styled
def predicted(plan: PredictedCurves, *, sensors: int = SENSORS, png: str | Path | None = None) -> Figure:
    """One panel per sensor, those first that tell most: a line per hypothesis with the sensor's own 2-sigma band."""
    channels = sorted(plan.test.channels, key=lambda c: -plan.spread_K(c.name))[:sensors]
    time = np.asarray(plan.test.time, float)
    unit, unit_s = ("min", 60.0) if time[-1] - time[0] < LONG_S else ("h", 3600.0)
    at = plan.decisive()
    thin = slice(None, None, max(1, -(-len(time) // POINTS)))
    t = (time - time[0])[thin] / unit_s
    words = "", f"time ({unit})", "temperature (°C)"
    figure, axes = paper.panels(len(channels), 2, (4.3, 2.6), *words)
    for ax, channel in zip(axes, channels, strict=False):
        for colour, curves in zip(COLOURS, plan.curves.values(), strict=False):
            y, band = curves[channel.name][thin], 2 * float(np.hypot(channel.sigma_K, channel.model_K))
            ax.fill_between(t, y - band, y + band, color=colour, alpha=0.15, lw=0)
            ax.plot(t, y, color=colour)
        spread_K = np.ptp([curves[channel.name] for curves in plan.curves.values()], axis=0).max()
        ax.set_title(f"{short(channel.name)}: up to {spread_K:.1f} K apart")
        ax.margins(x=0)
        ax.axvline((time[at] - time[0]) / unit_s, color=LIGHT.ink, lw=0.8, ls=":")
        ends = [float(curves[channel.name][-1]) for curves in plan.curves.values()][: len(COLOURS)]
        end_labels(ax, ends, [f"{end:.1f}" for end in ends], COLOURS)
    names = list(plan.curves)[: len(COLOURS)]
    figure.legend(
        axes[0].get_lines()[: len(names)],
        names,
        loc="outside upper left",
        ncols=2,
        frameon=False,
        labelcolor="linecolor",
        handlelength=1.2,
        fontsize=8.5,
    )
    return paper.save(figure, png)
