"""How a recording opens: the machine on the left, curves and residuals beside it; a second tab for the revisions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from viz.data import Comparison, short
from viz.rendering.scene import View

if TYPE_CHECKING:
    import rerun.blueprint as rrb

SPEED = 360.0  # times as fast as the test: an hour in ten seconds
NAME = 0.16, 0.04  # width and height of a sensor's name, share of the machine's diagonal in the first view
DISTANCE = 1.02  # of the machine's diagonal: fills the view at rerun's own angle of view


def blueprint(comparison: Comparison, first: str, points: NDArray[np.float64], with_history: bool) -> rrb.Blueprint:
    """The views; the curves of channel `first` lie on top, the time axis spans the test, the camera sees `points`."""
    import rerun.blueprint as rrb

    end = float(comparison.test.time[-1])
    names = sorted((c.name for c in comparison.channels), key=lambda name: name != first)
    curves = rrb.Tabs(*(_over_time(f"curves/{name}", f"{short(name)} (°C)", end) for name in names), active_tab=0)
    below: list[Any] = [_over_time("inputs", "inputs", end)] if comparison.test.inputs else []
    below += [rrb.TextLogView(origin="events", name="events")] if comparison.events else []
    right = rrb.Vertical(curves, _over_time("residual", "measured − model (K)", end), *below)
    shown = rrb.Horizontal(_machine(comparison, points), _bar(), column_shares=[6, 1])
    left = rrb.Vertical(shown, _text("legend", "legend"), row_shares=[5, 1])
    layout: Any = rrb.Horizontal(left, right, column_shares=[3, 2], name="test")
    if with_history:
        error = rrb.TimeSeriesView(origin="error", name="rms error (K)")
        beside = rrb.Vertical(error, _text("step", "what was done"), row_shares=[3, 1])
        revisions = rrb.Horizontal(_machine(comparison, points), beside, column_shares=[3, 2], name="revisions")
        layout = rrb.Tabs(layout, revisions, active_tab=0)
    plays = rrb.TimePanel(
        timeline="test_time", state="collapsed", play_state="playing", loop_mode="all", playback_speed=SPEED
    )
    return rrb.Blueprint(layout, plays, collapse_panels=True)


def apart(places: NDArray[np.float64], points: NDArray[np.float64]) -> list[bool]:
    """Which names, at places (n, 3) m in order of weight, cover none before them when the machine is first seen."""
    _, right, up = View().axes()
    size = np.linalg.norm(np.ptp(points, axis=0)) * np.array(NAME)
    taken: list[NDArray[np.float64]] = []
    out = []
    for at in np.stack([places @ right, places @ up], axis=1):
        out.append(not any((np.abs(at - other) < size).all() for other in taken))
        taken += [at] if out[-1] else []
    return out


def _bar() -> rrb.Spatial2DView:
    import rerun.blueprint as rrb

    return rrb.Spatial2DView(origin="scale", name="°C", background=[255, 255, 255])


def _machine(comparison: Comparison, points: NDArray[np.float64]) -> rrb.Spatial3DView:
    import rerun.blueprint as rrb

    low, high = points.min(axis=0), points.max(axis=0)
    towards, _, _ = View().axes()
    middle = (low + high) / 2
    eye = rrb.EyeControls3D(
        position=middle + DISTANCE * np.linalg.norm(high - low) * towards, look_target=middle, eye_up=View().up
    )  # fmt: skip
    return rrb.Spatial3DView(
        origin="machine", name=f"{comparison.test.name}: temperature", background=[255, 255, 255], line_grid=False,
        eye_controls=eye,
    )  # fmt: skip


def _text(origin: str, name: str) -> rrb.TextDocumentView:
    import rerun.blueprint as rrb

    return rrb.TextDocumentView(origin=origin, name=name)


def _over_time(origin: str, name: str, end: float) -> rrb.TimeSeriesView:
    import rerun as rr
    import rerun.blueprint as rrb

    at = rrb.TimeRangeBoundary.absolute
    axis = rrb.TimeAxis(view_range=rr.TimeRange(start=at(seconds=0.0), end=at(seconds=end)))
    return rrb.TimeSeriesView(origin=origin, name=name, axis_x=axis)
