"""Heat: where it is missing and when, and where it goes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from viz.colours import LIGHT, ORANGE, VERMILION
from viz.figures import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    words = f"{best['place']}: {best['evidence_nats']:.0f} nats", "time (min)", "missing heat (W)"
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
