"""Cross-sections that a file draws: their volumes, and shapes that cannot be."""

import math

import pytest

from geom import COARSE, InputError, build_mesh
from geom.machine_file import machine_from

HALF = 0.06  # rad


def sector(inner, outer, half, lid=True):
    """A slot between two radii (mm); the last edge, back to the start, is an arc or left out."""
    at = lambda r, a: [r * math.cos(a), r * math.sin(a)]  # noqa: E731
    back = [-math.tan(half / 2)] if lid else []
    return [at(inner, -half), [*at(outer, -half), math.tan(half / 2)], at(outer, half), at(inner, half) + back]


def sections(**outlines):
    slots = {"slots": [{"copies": 12, "loops_mm": [sector(60, 80, HALF, lid=False)]}]}
    wires = {"wires": [{"copies": 12, "loops_mm": [sector(64, 80, HALF)]}]}
    stator = {"outer_diameter_mm": 200.0, "bore_diameter_mm": 120.0, "stack_length_mm": 100.0, "air_gap_mm": 1.0}
    return {
        "machine": {"family": "cross-section"},
        "geometry": {"stator": stator},
        "outlines": slots | wires | outlines,
    }


def magnets(inner, outer, half=0.4):
    return [{"copies": 4, "loops_mm": [sector(inner, outer, half)]}]


def test_volumes_are_those_of_the_outlines():
    machine = machine_from(sections(magnets=magnets(50, 54), pockets=magnets(50, 54)), "drawn")
    wire = 12 * HALF * (0.08**2 - 0.064**2) * 0.1
    slots = 12 * HALF * (0.08**2 - 0.06**2) * 0.1
    assert machine.part("winding").volume == pytest.approx(wire, rel=1e-9)
    assert machine.part("stator.core").volume == pytest.approx(math.pi * (0.1**2 - 0.06**2) * 0.1 - slots, rel=1e-9)
    assert machine.part("magnets").volume == pytest.approx(4 * 0.4 * (0.054**2 - 0.05**2) * 0.1, rel=1e-9)
    assert "air.inside" not in [fluid.name for fluid in machine.fluids]


def test_magnets_on_the_surface_and_a_rotor_without_bore_mesh():
    table = sections(
        magnets=magnets(55, 59), pockets=[{"copies": 6, "loops_mm": [[[30, -4], [34, -4], [34, 4], [30, 4]]]}]
    )
    table["geometry"]["rotor"] = {"core_diameter_mm": 110.0, "inside": "solid", "stack_length_mm": 90.0}
    machine = machine_from(table, "drawn")
    mesh = build_mesh(machine, **COARSE)
    assert {"rotor.core", "magnets", "shaft"} <= set(mesh.parts)
    core = math.pi * 0.055**2 * 0.09 - 6 * 0.004 * 0.008 * 0.09
    assert machine.part("rotor.core").volume == pytest.approx(core, rel=1e-9)


FAULTS = {
    "neighbour": ({"magnets": magnets(50, 54, 0.9), "pockets": magnets(50, 54, 0.9)}, "cuts its neighbour"),
    "crossing": ({"pockets": [{"copies": 1, "loops_mm": [[[30, 0], [40, 5], [40, 0], [30, 2]]]}]}, "crosses itself"),
    "outside": ({"magnets": magnets(50, 70)}, "from the axis"),
    "unknown": ({"coil": []}, "unknown shapes 'coil'"),
    "no point": ({"bars": [{"copies": 3, "loops_mm": [[[1, "x"], [2, 3]]]}]}, "is not a point"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_shapes_that_cannot_be_are_refused(fault):
    outlines, words = FAULTS[fault]
    with pytest.raises(InputError, match=words):
        machine_from(sections(**outlines), "drawn.toml")
