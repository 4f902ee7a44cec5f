"""Figures to move about in: plotly, for the workbench, notebooks and pages that may be 5 MB.

Each function returns a plotly figure; viz.live.style.save writes it as HTML, or as PNG or SVG where a Chromium is
installed. The drawings on paper (viz.figures) need no browser.
"""

from __future__ import annotations

from geom.lazy import loaded_when_used

_HOME = {
    "sensor": "curves",
    "residuals": "curves",
    "against_input": "curves",
    "parity": "curves",
    "confusion": "curves",
    "save": "style",
}
__all__ = sorted(_HOME)
__getattr__, __dir__ = loaded_when_used(__name__, _HOME, within="viz.live.")
