"""Thermocouples on the machine: which get a label, and what must become transparent for the label to be true."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array, Mask
from viz.colours import Theme
from viz.data import Sensor, short
from viz.labels import signed
from viz.rendering import scene
from viz.rendering.callouts import Label, callouts, dot
from viz.rendering.cut import Surface
from viz.rendering.ghost import SLACK, Ghosted, covered, distance, ghosted, obstacle
from viz.rendering.scene import View

if TYPE_CHECKING:
    import pyvista

LABELS = 6  # sensors with a label: more hide the machine
LONGEST = 28  # letters of a sensor's name: longer ones would leave the machine less than half of the picture
PLAIN = 0.6  # size of a dot without a label


@dataclass(frozen=True)
class Marked:
    """labelled, others : sensors with and without a label;  hidden : of both, in this order, what something covers

    cut : the surface with a window to each labelled sensor that is hidden or was cut off with the wedge
    """

    labelled: tuple[Sensor, ...]
    others: tuple[Sensor, ...]
    hidden: Mask
    cut: Ghosted

    def draw(self, p: "pyvista.Plotter", surface: Surface, view: View, theme: Theme, note: str = "") -> None:
        """Dots, some with labels; those inside or behind something are hollow, and the picture says so after `note`."""
        sensors = (*self.labelled, *self.others)
        labels = [_label(s, bool(h)) for s, h in zip(sensors, self.hidden, strict=True)]
        n = len(self.labelled)
        callouts(p, labels[:n], frame_points(surface, sensors), view, theme)
        for label in labels[n:]:
            dot(p, label, PLAIN)
        says = [note] if note else []
        says += [SIDES[v] for v in SIDES if any(s.verdict == v for s in sensors)]
        says += ["hollow dots lie inside or behind"] if self.hidden.any() else []
        says += [f"{len(self.others)} without a label"] if self.others else []
        if says:
            scene.footnote(p, "; ".join(says), theme)


SIDES = {"hot": "orange: hotter than the model", "cold": "blue: colder than the model"}  # of what is over


def frame_points(surface: Surface, sensors: Sequence[Sensor]) -> Array:
    """(n, 3) m that a picture must hold: the machine, and of a long base what is near it or has a sensor."""
    return np.concatenate([surface.framed, np.array([s.xyz for s in sensors]).reshape(-1, 3)])


def label_texts(sensors: Sequence[Sensor], labels: int = LABELS) -> list[str]:
    """The labels of those furthest beyond their uncertainty."""
    return [_label(s, False).text for s in sorted(sensors, key=lambda s: -s.weight)[:labels]]


def marked(surface: Surface, sensors: Sequence[Sensor], labels: int, eye: Array) -> Marked:
    """The sensors as seen from `eye` (m); labels for the first of them."""
    places, solid = np.array([s.xyz for s in sensors]).reshape(-1, 3), obstacle(surface)
    hidden = covered(solid, places, eye)
    afloat = distance(solid, places) > SLACK
    mine = places[:labels]
    cut = ghosted(surface, mine, (hidden | afloat)[:labels], eye)
    return Marked(tuple(sensors[:labels]), tuple(sensors[labels:]), hidden, cut)


def _label(sensor: Sensor, hidden: bool) -> Label:
    value = "" if sensor.residual_K is None else f"  {signed(sensor.residual_K)} K"
    name = short(sensor.name)
    name = name if len(name) <= LONGEST else f"{name[: LONGEST - 1]}…"
    return Label(sensor.xyz, f"{name}{value}".strip(), sensor.colour, hidden)
