"""See it: fields, residuals and the error falling. Nothing heavy is loaded before the first picture."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "Comparison": "data", "Sensor": "data", "sensors": "data",
    "SplitMesh": "nodes", "split": "nodes", "require_gl": "gl", "off_screen_window": "gl",
    "Wedge": "cut", "HALF": "cut", "QUARTER": "cut", "cutaway": "field", "pair": "field", "difference": "field",
    "regions": "parts", "exploded": "parts", "missing_heat": "heat", "missing_in_machine": "missing",
    "flux_arrows": "arrows", "heat_flux": "arrows",
    "heat_flows": "flows", "sankey_of_losses": "sankey", "network_in_machine": "network", "animate": "animation",
    "measured_and_model": "curves", "residuals": "curves", "before_after": "errors", "staircase": "errors",
    "scores": "candidates", "posterior": "candidates", "confusion": "candidates",
    "write_recording": "recording", "verify": "recording", "Report": "report", "write_report": "report",
    "write_pdf": "pdf", "screened": "screening", "ranking": "screening",
}  # fmt: skip
__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module 'viz' has no attribute '{name}'; known: {', '.join(__all__)}")
    return getattr(import_module(f"viz.{_HOME[name]}"), name)
