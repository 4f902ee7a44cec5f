"""The columns of a recording, one small panel each, as they were understood."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from geom.arrays import Array
from viz.colours import BLUE, LIGHT, ORANGE
from viz.figures import paper

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ACROSS, MOST = 4, 48  # panels in a row; and in all, more cannot be read
POINTS = 2000  # of a curve: more do not show
SHORT = 30  # characters of a title


@dataclass(frozen=True)
class Panel:
    """time (n,) s;  values (n,) as written;  meaning : what the column is taken for, "" if it is left out"""

    name: str
    time: Array
    values: Array
    meaning: str
    is_temperature: bool


@paper.styled
def columns(panels: Sequence[Panel], title: str, *, png: str | Path | None = None) -> Figure:
    """Temperatures are blue, inputs orange, what is left out grey; the meaning stands under the name."""
    visible_panels = panels[:MOST]
    figure, axes = paper.panels(len(visible_panels), ACROSS, (3.0, 1.8), title, more=0.5)
    for ax, panel in zip(axes, visible_panels, strict=False):
        colour = LIGHT.faint if not panel.meaning else BLUE if panel.is_temperature else ORANGE
        ax.plot(panel.time, panel.values, color=colour, lw=1.0)
        ax.set_title(panel.name[:SHORT], fontsize=8.5)
        ax.set_xlabel(f"{panel.meaning or 'left out'} over time (s)", fontsize=8)
        ax.margins(x=0)
    return paper.save(figure, png)
