"""How a recording opens: the machine on the left, curves, residuals and the error beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from viz.data import Comparison

if TYPE_CHECKING:
    import rerun.blueprint as rrb


def blueprint(comparison: Comparison, first: str, with_history: bool) -> rrb.Blueprint:
    """The views; the curves of channel `first` lie on top, the time axis spans the test."""
    import rerun.blueprint as rrb

    end = float(comparison.test.time[-1])
    machine = rrb.Spatial3DView(
        origin="machine", name=f"{comparison.test.name}: temperature",
        background=[255, 255, 255], line_grid=False,
        eye_controls=rrb.EyeControls3D(position=(-1.3, 0.6, 1.0), look_target=(0, -0.03, 0.22), eye_up=(0, 1, 0)),
    )  # fmt: skip
    names = sorted((c.name for c in comparison.test.channels), key=lambda name: name != first)
    curves = rrb.Tabs(*(_over_time(f"curves/{name}", f"{name} (°C)", end) for name in names), active_tab=0)
    below = [_over_time("residual", "measured − model (K)", end)]
    if with_history:
        error = rrb.TimeSeriesView(origin="error", name="rms error (K) over revisions")
        below.append(rrb.Horizontal(error, rrb.TextDocumentView(origin="step", name="what was done")))  # type: ignore[arg-type]
    left = rrb.Vertical(machine, rrb.TextDocumentView(origin="legend", name="legend"), row_shares=[5, 1])
    return rrb.Blueprint(
        rrb.Horizontal(left, rrb.Vertical(curves, *below), column_shares=[3, 2]),
        rrb.TimePanel(timeline="test_time", state="collapsed"),
        collapse_panels=True,
    )


def _over_time(origin: str, name: str, end: float) -> rrb.TimeSeriesView:
    import rerun as rr
    import rerun.blueprint as rrb

    at = rrb.TimeRangeBoundary.absolute
    axis = rrb.TimeAxis(view_range=rr.TimeRange(start=at(seconds=0.0), end=at(seconds=end)))
    return rrb.TimeSeriesView(origin=origin, name=name, axis_x=axis)
