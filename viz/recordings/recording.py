"""A recording of a test for the rerun viewer: the machine warming up, its sensors, curves, and the error falling.

Two timelines: `test_time` runs through the test, `revision` through the model's history. Written to a file only:
nothing listens on the network. Open it with `rerun FILE.rrd`.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr

from geom.arrays import Array
from geom.errors import InputError
from measured.case import Channel
from viz.colours import BLUE, GREEN, LIGHT, ORANGE, PURPLE, SKY, VERMILION, decimals, heat, marks, rounded
from viz.data import Comparison, Curve, Sensor, short
from viz.figures.errors import PALE, error_paths
from viz.machine.thermocouples import LABELS
from viz.recordings.arrangement import blueprint, eye, non_overlapping, outside_outline
from viz.rendering import scene
from viz.rendering.cut import QUARTER, Surface, Wedge, cut_away
from viz.rendering.ghost import covered, obstacle
from viz.rendering.nodes import SplitMesh, on_nodes

MARKED, MARK = re.compile(r"([^\w\s])"), r"\\\1"  # signs that Markdown could read, each taken as it is
TIME, REVISION = "test_time", "revision"


def write_recording(
    path: str | Path,
    nodes: SplitMesh,
    comparison: Comparison,
    frames: tuple[Array, Array],
    positions: Mapping[str, Sequence[float]],
    *,
    history: Sequence[Mapping[str, Any]] = (),
    revision_fields: Array | None = None,
    revision_residuals: Sequence[Mapping[str, float]] = (),
    wedge: Wedge | None = QUARTER,
    limits: tuple[float, float] | None = None,
) -> Path:
    """Write an .rrd file and return its path.

    frames : times (n_frames,) s and fields (n_frames, n_nodes) degC
    positions : channel name -> (x, y, z) m; channels without one appear as curves only
    history : revisions as in viz.figures.errors.staircase
    revision_fields : (n_revisions + 1, n_nodes) degC, the field at the end of the test, start first
    revision_residuals : for each of these channel -> measured - modelled (K) then
    limits : of the colour scale (degC), widened to round numbers; those of all fields if not given
    """
    times, fields = np.asarray(frames[0], float), on_nodes(nodes, frames[1])
    if fields.shape[:1] != times.shape:
        raise InputError(f"{len(times)} times but {len(fields)} fields", "recording", "one field per time")
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    stream = rr.RecordingStream("thermoscope", recording_id=f"{comparison.test.name}", send_properties=False)
    worst = max(comparison.channels, key=comparison.rmse).name
    surface = cut_away(nodes, wedge)
    stream.save(path, default_blueprint=blueprint(comparison, worst, surface.points, bool(history)))
    ends = rounded(*(limits or (float(fields.min()), float(fields.max()))))
    _machine(stream, surface, times, fields, revision_fields, ends)
    colour_bar(stream, *ends)
    inputs(stream, comparison, TIME)
    events(stream, comparison, TIME)
    _sensors(stream, comparison, times, positions, revision_residuals, surface)
    _curves(stream, comparison)
    _revisions(stream, history)
    stream.flush()
    stream.disconnect()
    return path


def _machine(
    stream: rr.RecordingStream,
    surface: Surface,
    times: Array,
    fields: Array,
    revisions: Array | None,
    limits: tuple[float, float],
) -> None:
    stream.log("machine", rr.ViewCoordinates.RIGHT_HAND_Y_UP, static=True)
    mesh = rr.Mesh3D(vertex_positions=surface.points, triangle_indices=surface.triangles)
    stream.log("machine/field", mesh, static=True)
    edges = scene.feature_edges(scene.polydata(surface))
    strips = np.asarray(edges.points)[edges.lines.reshape(-1, 3)[:, 1:]]
    lines = rr.LineStrips3D(list(strips), colors=[31, 41, 51, 150], radii=rr.Radius.ui_points(0.6))
    stream.log("machine/edges", lines, static=True)
    stream.log("legend", rr.TextDocument(_LEGEND, media_type="text/markdown"), static=True)
    _colours(stream, surface, rr.TimeColumn(TIME, duration=times), fields, limits)
    if revisions is not None:
        steps = rr.TimeColumn(REVISION, sequence=range(len(revisions)))
        _colours(stream, surface, steps, on_nodes(surface.nodes, revisions), limits)


def _colours(
    stream: rr.RecordingStream, surface: Surface, index: Any, fields: Array, limits: tuple[float, float]
) -> None:
    """Vertex colours for every entry of `index`; the geometry is not repeated."""
    share = (surface.values(fields.T).T - limits[0]) / max(limits[1] - limits[0], 1e-9)
    rgba = heat()(share, bytes=True)
    columns = rr.Mesh3D.columns(vertex_colors=rgba.reshape(-1, 4)).partition([rgba.shape[1]] * len(rgba))
    stream.send_columns("machine/field", indexes=[index], columns=columns)


def _sensors(
    stream: rr.RecordingStream,
    c: Comparison,
    times: Array,
    positions: Mapping[str, Sequence[float]],
    revisions: Sequence[Mapping[str, float]],
    surface: Surface,
) -> None:
    channels = [channel for channel in c.channels if channel.name in positions]
    if not channels:
        return
    names = [channel.name for channel in channels]
    points, labels = [positions[name] for name in names], [short(name) for name in names]
    dots = rr.Points3D(points, labels=labels, radii=rr.Radius.ui_points(5.0), show_labels=False)
    stream.log("machine/sensors", dots, static=True)
    _names(stream, sorted(channels, key=lambda channel: -c.rmse(channel) / c.limit_K(channel)), positions, surface)
    residual = np.stack([np.interp(times, c.test.time, c.residual(channel)) for channel in channels], axis=1)
    _markers(stream, c, channels, rr.TimeColumn(TIME, duration=times), residual)
    if revisions:
        ends = np.array([[row.get(channel.name, np.nan) for channel in channels] for row in revisions])
        _markers(stream, c, channels, rr.TimeColumn(REVISION, sequence=range(len(ends))), ends)


def _names(
    stream: rr.RecordingStream, channels: Sequence[Channel], positions: Mapping[str, Sequence[float]], surface: Surface
) -> None:
    """Names of the first that have room; what the machine hides has its name beside it, on a line from its place."""
    places = np.array([positions[channel.name] for channel in channels])
    hidden = covered(obstacle(surface), places, eye(surface.points))
    at = np.where(hidden[:, None], outside_outline(places, surface.points), places)
    visible = np.flatnonzero(non_overlapping(at, surface.points))[:LABELS]
    style: dict[str, Any] = {"radii": rr.Radius.ui_points(0.0), "show_labels": True, "colors": [255, 255, 255]}
    names = rr.Points3D(at[visible], labels=[short(channels[i].name) for i in visible], **style)
    stream.log("machine/names", names, static=True)
    stubs = [np.stack([places[i], at[i]]) for i in visible if hidden[i]]
    lines = rr.LineStrips3D(stubs, colors=rgba(LIGHT.ink), radii=rr.Radius.ui_points(0.8))
    stream.log("machine/stubs", lines, static=True)


def _markers(
    stream: rr.RecordingStream, c: Comparison, channels: Sequence[Channel], index: Any, residual: Array
) -> None:
    """Colours of the sensors for every entry of `index`, from residuals (n, n_sensors) K."""
    colours = [
        rgba(Sensor(channel.name, (0, 0, 0), r, c.limit_K(channel)).colour)
        for row in residual
        for channel, r in zip(channels, row, strict=True)
    ]
    columns = rr.Points3D.columns(colors=colours).partition([len(channels)] * len(residual))
    stream.send_columns("machine/sensors", indexes=[index], columns=columns)


def _curves(stream: rr.RecordingStream, c: Comparison) -> None:
    """Entities: measured and model of each channel, the earlier model where there is one, and the residual."""
    for channel in c.channels:
        name = rr.escape_entity_path_part(channel.name)
        for curve in c.temperatures(channel):
            word = curve.name.split()[0]
            curve = replace(curve, name=word, colour=LIGHT.faint) if curve.ink else curve
            _series(stream, f"curves/{name}/{word}", c.test.time, curve)
        _series(stream, f"residual/{name}", c.test.time, c.residual_curve(channel))


def _series(stream: rr.RecordingStream, path: str, time: Array, curve: Curve) -> None:
    finite = np.isfinite(curve.y)
    index = time_column(TIME, np.asarray(time)[finite])
    line(stream, path, index, curve.y[finite], curve.colour, curve.name, widths=2.0)


def _revisions(stream: rr.RecordingStream, history: Sequence[Mapping[str, Any]]) -> None:
    for (name, role), errors in error_paths(history).items():
        path = f"error/{rr.escape_entity_path_part(name)}"
        colour, width = (BLUE, 4.0) if role == "hold-out" else (PALE, 2.0)
        index, style = rr.TimeColumn(REVISION, sequence=range(len(errors))), {"interpolation_mode": "StepAfter"}
        line(stream, path, index, np.array(errors), colour, f"{name} ({role})", widths=width, **style)
    for i, text in enumerate(["as built", *(f"{r['action']} {r.get('effect') or ''}" for r in history)]):
        if history:
            stream.set_time(REVISION, sequence=i)
            stream.log(
                "step", rr.TextDocument(f"# Revision {i}\n\n{MARKED.sub(MARK, text)}", media_type="text/markdown")
            )


_LEGEND = """Sensors: green within the uncertainty, vermilion where the machine is hotter than the model,
blue where it is colder. Six have names, those furthest beyond their uncertainty; the others under the pointer.
A name on a line belongs to a sensor inside or behind.

Timelines (chosen at the bottom left): **test_time** runs through the test; for the tab *revisions* choose **revision**.
"""


# What explains a recording beside the machine: a colour bar with round numbers, the inputs, what happened when.
WIDE, HIGH = 24, 256  # pixels of the bar
COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
GAP = 14  # pixels from the bar to its numbers


def colour_bar(stream: rr.RecordingStream, low: float, high: float) -> None:
    """A picture of the scale from a rounded range (degC), its marks beside it."""
    ramp = (np.asarray(heat()(np.linspace(1.0, 0.0, HIGH)))[:, :3] * 255).astype(np.uint8)
    stream.log("scale/bar", rr.Image(np.repeat(ramp[:, None], WIDE, axis=1)), static=True)
    at = marks(low, high)
    height = [HIGH * (1 - (m - low) / (high - low)) for m in at]
    words = [f"{m:.{decimals(low, high)}f} °C" for m in at]
    style: dict[str, Any] = {"radii": rr.Radius.ui_points(0.0), "show_labels": True, "colors": [31, 41, 51]}
    stream.log("scale/marks", rr.Points2D([[WIDE + GAP, h] for h in height], labels=words, **style), static=True)


def inputs(stream: rr.RecordingStream, comparison: Comparison, timeline: str) -> None:
    """A curve for each input of the test, as a share of its largest value, which its name tells."""
    test = comparison.test
    for (name, values), colour in zip(test.inputs.items(), cycle(COLOURS), strict=False):
        value = np.broadcast_to(np.asarray(values, float), np.shape(test.time))
        largest = float(np.nanmax(np.abs(value), initial=0.0)) or 1.0
        path = f"inputs/{rr.escape_entity_path_part(name)}"
        line(stream, path, time_column(timeline, test.time), value / largest, colour, f"{name} / {largest:.4g}")


def time_column(timeline: str, seconds: Array) -> rr.TimeColumn:
    """The times (n,) s of a line's values."""
    return rr.TimeColumn(timeline, duration=np.asarray(seconds, float))


def line(
    stream: rr.RecordingStream, path: str, index: rr.TimeColumn, y: Array, colour: str, name: str, **style: Any
) -> None:
    """A named line of values (n,) at the places of `index`."""
    stream.log(path, rr.SeriesLines(colors=rgba(colour), names=name, **style), static=True)
    stream.send_columns(path, indexes=[index], columns=rr.Scalars.columns(scalars=y))


def rgba(colour: str) -> int:
    """'#rrggbb' as rerun's 0xRRGGBBAA."""
    return int(colour[1:] + "ff", 16)


def events(stream: rr.RecordingStream, comparison: Comparison, timeline: str) -> None:
    """When something was different: a line of text where each event begins and ends."""
    for begin, end in comparison.events:
        for second, word in ((begin, "begins"), (end, "ends")):
            stream.set_time(timeline, duration=float(second))
            stream.log("events", rr.TextLog(f"something is different: {word} ({second / 60:.0f} min)", level="WARN"))
    stream.reset_time()
