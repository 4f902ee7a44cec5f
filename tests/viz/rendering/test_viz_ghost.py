"""Labels that are true: what hides a labelled sensor is ghosted, and a ray from the eye ends at the sensor."""

import numpy as np
import pytest
from small_motor import motor
from vtkmodules.vtkCommonCore import mutable

from viz import QUARTER, Sensor, cutaway, split
from viz.machine.thermocouples import marked
from viz.rendering.cut import Surface, cut_away, exposed
from viz.rendering.ghost import SLACK, obstacle
from viz.rendering.scene import View

NODES = split(motor(24))
VIEWS = {"default": View(), "from the right": View((1.0, 0.4, 0.6)), "from below": View((-1.0, -0.5, -0.4))}
INSIDE = {
    "winding.armature": (0.105, 0.01, 0.3),
    "shaft": (0.01, 0.0, 0.3),
    "housing": (0.15, -0.145, 0.3),
    "yoke": (-0.13, 0.12, 0.3),
}


def eye_of(points: np.ndarray, view: View) -> np.ndarray:
    towards = view.axes()[0]
    return points.mean(axis=0) + 4 * np.ptp(points, axis=0).max() * towards


def first_hit(surface: Surface, eye: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, str]:
    """Where a ray from the eye through a place first meets the surface, and which part that is."""
    hit, t, where, sub, cell = [0.0] * 3, mutable(0.0), [0.0] * 3, mutable(0), mutable(0)
    solid = obstacle(surface)
    solid.IntersectWithLine(eye, at + 3 * (at - eye) / np.linalg.norm(at - eye), 1e-6, t, hit, where, sub, cell)
    return np.array(hit), surface.nodes.parts[surface.part[int(cell)]]


@pytest.mark.parametrize("view", VIEWS)
def test_a_ray_to_a_sensor_ends_at_its_own_part(view):
    """The yoke's lies in what the wedge takes away, the others inside or behind."""
    surface = cut_away(NODES, QUARTER)
    eye = eye_of(surface.points, VIEWS[view])
    sensors = [Sensor(name, xyz, 1.0) for name, xyz in INSIDE.items()]
    cut = marked(surface, sensors, len(sensors), eye).cut
    for name, xyz in INSIDE.items():
        at, part = first_hit(cut.solid, eye, np.array(xyz))
        assert part == name
        assert np.linalg.norm(at - xyz) < SLACK


def test_a_window_takes_no_area_away():
    """What became transparent and what stays solid, the sections at the sensors apart, are the surface."""
    surface = exposed(NODES)
    sensor = Sensor("shaft", (0.0, 0.0, 0.3), 1.0)
    cut = marked(surface, [sensor], 1, eye_of(surface.points, View())).cut
    floor = cut.windows[0].cropped(cut.solid)
    assert area(cut.ghost) > 0
    assert area(cut.solid) + area(cut.ghost) - area(surface) == pytest.approx(flat(floor, cut.windows[0]), rel=1e-6)


def area(surface: Surface) -> float:
    a, b, c = surface.points[surface.triangles].transpose(1, 0, 2)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def flat(surface: Surface, window) -> float:
    """Area of what lies in the plane of a window's bottom (m2)."""
    off = np.abs((surface.points - window.bottom) @ window.towards)
    return area(surface.only((off < 1e-9)[surface.triangles].all(axis=1)))


def test_six_labels_for_those_furthest_beyond_their_uncertainty(monkeypatch):
    written = []
    monkeypatch.setattr(
        "viz.machine.thermocouples.callouts", lambda p, labels, *_: written.extend(q.text for q in labels)
    )
    sensors = [Sensor(f"s{i}", (0.0, 0.22, 0.1 + 0.05 * i), float(i), 1.0) for i in range(8)]
    cutaway(NODES, np.linspace(20.0, 80.0, NODES.size), sensors=sensors).close()
    assert [text.split()[0] for text in written] == ["s7", "s6", "s5", "s4", "s3", "s2"]
