"""See it: fields, residuals and the error falling. Nothing heavy is loaded before the first picture."""

from __future__ import annotations

from geom.lazy import loaded_when_used

_HOME = {
    "Comparison": "data",
    "Sensor": "data",
    "sensors": "data",
    "SplitMesh": "rendering.nodes",
    "split": "rendering.nodes",
    "require_gl": "rendering.gl",
    "off_screen_window": "rendering.gl",
    "Wedge": "rendering.cut",
    "HALF": "rendering.cut",
    "QUARTER": "rendering.cut",
    "cutaway": "machine.field",
    "pair": "machine.field",
    "difference": "machine.field",
    "regions": "machine.parts",
    "exploded": "machine.parts",
    "missing_heat": "figures.heat",
    "missing_in_machine": "machine.missing",
    "flux_arrows": "machine.arrows",
    "heat_flux": "machine.arrows",
    "heat_flows": "figures.flows",
    "sankey_of_losses": "figures.sankey",
    "network_in_machine": "machine.network",
    "animate": "machine.animation",
    "measured_and_model": "figures.curves",
    "residuals": "figures.curves",
    "before_after": "figures.errors",
    "staircase": "figures.errors",
    "scores": "figures.candidates",
    "posterior": "figures.candidates",
    "confusion": "figures.candidates",
    "write_recording": "recordings.recording",
    "Report": "pages.report",
    "write_report": "pages.report",
    "write_pdf": "pages.pdf",
    "misses": "machine.misses",
    "uncertainty": "machine.field",
    "predicted": "figures.bands",
    "Predicted": "figures.bands",
}
__all__ = sorted(_HOME)
__getattr__, __dir__ = loaded_when_used(__name__, _HOME, within="viz.")
