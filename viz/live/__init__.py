"""Figures to move about in: plotly, for the workbench, notebooks and pages that may be 5 MB.

Each function returns a plotly figure; viz.live.curves.save writes it as HTML, or as PNG or SVG where a Chromium is
installed. The drawings on paper (viz.figures) need no browser.
"""

from typing import TYPE_CHECKING

from geom.lazy import loaded_when_used

if TYPE_CHECKING:
    from viz.live.curves import against_input as against_input, confusion as confusion, parity as parity
    from viz.live.curves import residuals as residuals, sensor as sensor
    from viz.live.curves import save as save

__getattr__, __dir__ = loaded_when_used(__name__, __file__)
