"""Figures to move about in: plotly, for the workbench, notebooks and pages that may be 5 MB.

Each function returns a plotly figure; viz.live.style.save writes it as HTML, or as PNG or SVG where a Chromium is
installed. The drawings on paper (viz.figures) need no browser.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "sensor": "curves", "residuals": "curves", "against_input": "curves", "parity": "curves",
    "confusion": "candidates", "save": "style", "parallel_coordinates": "designs", "objective_space": "designs",
}  # fmt: skip
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'viz.live' has no attribute '{name}'; known: {', '.join(__all__)}")
    return getattr(import_module(f"viz.live.{_HOME[name]}"), name)
