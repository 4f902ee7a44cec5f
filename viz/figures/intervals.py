"""What the tests leave of what was expected: an interval per calibrated value, as posteriors are drawn."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.table import with_interval
from viz.colours import BLUE, LIGHT, VERMILION
from viz.figures import paper
from viz.labels import minus

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST = 16  # rows: more are not read
WIDEST = 2.5  # of what was expected: an interval that is wider runs off the picture


@paper.styled
def intervals(parameters: Sequence[Mapping[str, Any]], *, png: str | Path | None = None) -> Figure:
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
    rows = rows[:MOST][::-1]
    figure, (ax,) = paper.subplots(8.4, 0.3 * len(rows) + 1.2)
    ax.axvspan(-1.0, 1.0, color=LIGHT.faint, alpha=0.2, lw=0)
    for y, (p, (x, a, b)) in enumerate(rows):
        colour = VERMILION if abs(x) > 1.0 else BLUE
        alpha = 1.0 if p["identified"] else 0.35
        ax.plot([a, b], [y, y], color=colour, lw=2.2, alpha=alpha, solid_capstyle="butt")
        at, mark = (x, "o") if abs(x) < WIDEST else (0.98 * WIDEST, ">") if x > 0 else (-0.98 * WIDEST, "<")
        ax.plot([at], [y], mark, color=colour, ms=5.0, alpha=alpha)
        unit = "" if p["unit"] == "1" else f" {p['unit']}"
        words = f"{minus(with_interval(p['value'], *p['ci95']))}{unit}".replace(" ... ", " … ")
        ax.text(1.02, y, words, transform=ax.get_yaxis_transform(), va="center", fontsize=8)
    ax.set_yticks(range(len(rows)), [textwrap.fill(p.get("words", p["name"]), 44) for p, _ in rows], fontsize=8.5)
    ax.grid(False, axis="y")
    ax.set(
        xlim=(-WIDEST, WIDEST), xlabel="deviation from what was expected; grey: its 95 %; pale: not fixed by the data"
    )
    ax.set_title("Sizes, and how sure they are (95 %)")
    return paper.save(figure, png)
