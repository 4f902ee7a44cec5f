"""What explains a recording beside the machine: a colour bar with round numbers, the inputs, what happened when."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.arrays import Array
from viz.colours import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, heat
from viz.data import Comparison
from viz.rendering.scale import decimals, marks

if TYPE_CHECKING:
    import rerun as rr

WIDE, HIGH = 24, 256  # pixels of the bar
COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY)
GAP = 14  # pixels from the bar to its numbers


def colour_bar(stream: rr.RecordingStream, low: float, high: float) -> None:
    """A picture of the scale from a rounded range (degC), its marks beside it."""
    import rerun as rr

    ramp = (np.asarray(heat()(np.linspace(1.0, 0.0, HIGH)))[:, :3] * 255).astype(np.uint8)
    stream.log("scale/bar", rr.Image(np.repeat(ramp[:, None], WIDE, axis=1)), static=True)
    at = marks(low, high)
    height = [HIGH * (1 - (m - low) / (high - low)) for m in at]
    words = [f"{m:.{decimals(low, high)}f} °C" for m in at]
    points = rr.Points2D(
        [[WIDE + GAP, h] for h in height],
        labels=words,
        show_labels=True,
        radii=rr.Radius.ui_points(0.0),
        colors=[31, 41, 51],
    )
    stream.log("scale/marks", points, static=True)


def inputs(stream: rr.RecordingStream, comparison: Comparison, timeline: str) -> None:
    """A curve for each input of the test, as a share of its largest value, which its name tells."""
    import rerun as rr

    test = comparison.test
    for (name, values), colour in zip(test.inputs.items(), cycle(COLOURS), strict=False):
        value = np.broadcast_to(np.asarray(values, float), np.shape(test.time))
        largest = float(np.nanmax(np.abs(value), initial=0.0)) or 1.0
        path = f"inputs/{rr.escape_entity_path_part(name)}"
        line(stream, path, time_column(timeline, test.time), value / largest, colour, f"{name} / {largest:.4g}")


def time_column(timeline: str, seconds: Array) -> rr.TimeColumn:
    """The times (n,) s of a line's values."""
    import rerun as rr

    return rr.TimeColumn(timeline, duration=np.asarray(seconds, float))


def line(
    stream: rr.RecordingStream, path: str, index: rr.TimeColumn, y: Array, colour: str, name: str, **style: Any
) -> None:
    """A named line of values (n,) at the places of `index`."""
    import rerun as rr

    stream.log(path, rr.SeriesLines(colors=rgba(colour), names=name, **style), static=True)
    stream.send_columns(path, indexes=[index], columns=rr.Scalars.columns(scalars=y))


def rgba(colour: str) -> int:
    """'#rrggbb' as rerun's 0xRRGGBBAA."""
    return int(colour[1:] + "ff", 16)


def events(stream: rr.RecordingStream, comparison: Comparison, timeline: str) -> None:
    """When something was different: a line of text where each event begins and ends."""
    import rerun as rr

    for begin, end in comparison.events:
        for second, word in ((begin, "begins"), (end, "ends")):
            stream.set_time(timeline, duration=float(second))
            stream.log("events", rr.TextLog(f"something is different: {word} ({second / 60:.0f} min)", level="WARN"))
    stream.reset_time()
