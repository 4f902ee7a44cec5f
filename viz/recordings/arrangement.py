"""How a recording opens: the machine on the left, curves and residuals beside it; a second tab for the revisions."""

from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb

from geom.arrays import Array
from viz.data import Comparison, short
from viz.rendering.scene import View

SPEED = 360.0  # times as fast as the test: an hour in ten seconds
NAME = 0.17, 0.045  # width and height of a sensor's name, share of the machine's diagonal in the first view
OUT = 0.05  # of the diagonal: as far beyond the machine's outline stand the names of what it hides
DISTANCE = 1.1  # of the machine's diagonal: fills the view at rerun's own angle of view, a base included


def blueprint(comparison: Comparison, first: str, points: Array, with_history: bool) -> rrb.Blueprint:
    """The views; the curves of channel `first` lie on top, the time axis spans the test, the camera sees `points`."""
    end = float(comparison.test.time[-1])
    names = sorted((c.name for c in comparison.channels), key=lambda name: name != first)
    low = rrb.Corner2D.RightBottom  # free where a machine warms up
    warming = (
        _over_time(f"curves/{rr.escape_entity_path_part(name)}", f"{short(name)} (°C)", end, low) for name in names
    )
    curves = rrb.Tabs(*warming, active_tab=0)
    shares = "inputs, shares of the largest"
    below: list[Any] = [_over_time("inputs", shares, end)] if comparison.test.inputs else []
    below += [rrb.TextLogView(origin="events", name="events")] if comparison.events else []
    right = rrb.Vertical(curves, _over_time("residual", "measured − model (K)", end), *below)
    scale = rrb.Spatial2DView(origin="scale", name="°C", background=[255, 255, 255])
    views = rrb.Horizontal(_machine(comparison, points), scale, column_shares=[6, 1])
    left = rrb.Vertical(views, _text("legend", "legend"), row_shares=[5, 1])
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


def non_overlapping(places: Array, points: Array) -> list[bool]:
    """Which names, at places (n, 3) m in order of weight, cover none before them when the machine is first seen."""
    size = np.array(NAME) / DISTANCE
    labels: list[Array] = []
    out = []
    for at in in_view(places, points)[0]:
        out.append(not any((np.abs(at - other) < size).all() for other in labels))
        labels += [at] if out[-1] else []
    return out


def eye(points: Array) -> Array:
    """(3,) m, from where the machine is first seen."""
    low, high = points.min(axis=0), points.max(axis=0)
    return np.asarray((low + high) / 2 + DISTANCE * np.linalg.norm(high - low) * View().axes()[0])


def in_view(points: Array, machine: Array) -> tuple[Array, Array]:
    """(n, 2) right and up per metre of distance, and (n,) m of distance, of points (n, 3) m when it is first seen."""
    towards, right, up = View().axes()
    distance = (eye(machine) - points) @ towards
    return (points - eye(machine)) @ np.stack([right, up], axis=1) / distance[:, None], distance


def outside_outline(places: Array, machine: Array) -> Array:
    """(n, 3) m: out from places (n, 3) m, across the first line of sight, to just beyond the machine's outline."""
    _, right, up = View().axes()
    (at, distance), outline = in_view(places, machine), in_view(machine, machine)[0]
    away = at / np.linalg.norm(at, axis=1, keepdims=True)
    far = (outline @ away.T).max(axis=0) + OUT / DISTANCE - np.einsum("ij,ij->i", at, away)
    return np.asarray(places + (far * distance)[:, None] * (away @ np.stack([right, up])))


def _machine(comparison: Comparison, points: Array) -> rrb.Spatial3DView:
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    first = rrb.EyeControls3D(position=eye(points), look_target=middle, eye_up=View().up)
    name, white = f"{comparison.test.name}: temperature", [255, 255, 255]
    return rrb.Spatial3DView(origin="machine", name=name, background=white, line_grid=False, eye_controls=first)


def _text(origin: str, name: str) -> rrb.TextDocumentView:
    return rrb.TextDocumentView(origin=origin, name=name)


def _over_time(origin: str, name: str, end: float, legend: rrb.Corner2D | None = None) -> rrb.TimeSeriesView:
    at = rrb.TimeRangeBoundary.absolute
    axis = rrb.TimeAxis(view_range=rr.TimeRange(start=at(seconds=0.0), end=at(seconds=end)))
    return rrb.TimeSeriesView(origin=origin, name=name, axis_x=axis, plot_legend=legend)
