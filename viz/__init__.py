"""See it: fields, residuals and the error falling. Nothing heavy is loaded before the first picture."""

from __future__ import annotations

from geom.lazy import loaded_when_used

_MODULES = {
    "data": "Comparison,Sensor,sensors",
    "rendering.nodes": "SplitMesh,split",
    "rendering.gl": "require_gl,off_screen_window",
    "rendering.cut": "Wedge,HALF,QUARTER",
    "machine.field": "cutaway,pair,machine_row,difference,uncertainty",
    "machine.parts": "regions,exploded",
    "machine.missing": "missing_in_machine",
    "machine.arrows": "flux_arrows",
    "rendering.flux": "heat_flux",
    "figures.flows": "heat_flows",
    "figures.sankey": "sankey_of_losses",
    "machine.network": "network_in_machine",
    "machine.animation": "animate",
    "figures.curves": "measured_and_model,residuals",
    "figures.intervals": "intervals",
    "figures.errors": "before_after,staircase",
    "figures.candidates": "scores,posterior,confusion",
    "recordings.recording": "write_recording",
    "pages.report": "Report,write_report",
    "pages.pdf": "write_pdf",
    "machine.misses": "misses",
    "figures.bands": "predicted,Predicted,missing_heat",
}
_HOME = {name: module for module, names in _MODULES.items() for name in names.split(",")}
__all__ = sorted(_HOME)
__getattr__, __dir__ = loaded_when_used(__name__, _HOME, within="viz.")
