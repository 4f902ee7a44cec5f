"""Liquid jackets of the series-wound motor: wetted areas against hand formulas, names, refusals."""

import math

import pytest
from measures import area

from geom import COARSE, InputError, build_mesh, load_machine
from geom.machine import machine_from


def jacketed(**jacket):
    table = {"machine": {"family": "series-dc"}, "geometry": {"jacket": {"sides": 1, **jacket}}}
    return machine_from(table)


@pytest.mark.parametrize("machine", ["series-dc-100kw-jacket-one", "series-dc-100kw-jacket-two"])
def test_each_side_has_its_own_fluid_and_wall(machine):
    loaded = load_machine(machine)
    fluids = {fluid.name for fluid in loaded.fluids}
    for index, side in enumerate(("left", "right")):
        assert (f"jacket.{side}" in fluids) == (index < loaded.geometry.jacket.sides)


def test_zigzag_channels_wet_the_perimeter_times_the_length_and_two_ends():
    machine = jacketed(layout="zigzag")
    g, coolant = machine.geometry.jacket, machine.part("jacket.left")
    inner = machine.part("housing").prisms[0][0].holes[0][0][0] + machine.geometry.housing.thickness
    outer = inner + g.height
    (_, z0, z1) = coolant.prisms[0]
    sweep = 2 * math.pi / g.channels - g.rib / inner
    section = sweep * (outer**2 - inner**2) / 2
    wetted = g.channels * ((sweep * (inner + outer) + 2 * g.height) * (z1 - z0) + 2 * section)
    mesh = build_mesh(machine, **COARSE)
    assert area(mesh, mesh.patches["jacket.left.wall"].facets) == pytest.approx(wetted, rel=0.01)


def test_helical_turns_are_rings():
    machine = jacketed(layout="helical", turns=3)
    mesh = build_mesh(machine, **COARSE)
    wetted = 0.0
    for profile, z0, z1 in machine.part("jacket.left").prisms:
        outer, inner = profile.outer[0][0], profile.holes[0][0][0]
        wetted += 2 * math.pi * (outer + inner) * (z1 - z0) + 2 * profile.area
    assert len(machine.part("jacket.left").prisms) == 3
    assert area(mesh, mesh.patches["jacket.left.wall"].facets) == pytest.approx(wetted, rel=0.01)


@pytest.mark.parametrize("layout", ["zigzag", "helical"])
def test_ribs_that_leave_no_channel_are_refused(layout):
    with pytest.raises(InputError, match=r"jacket\] rib_mm: 70 does not fit"):
        jacketed(layout=layout, rib_mm=70.0)


def test_unknown_layout_lists_the_known():
    with pytest.raises(InputError, match="zigzag, helical"):
        jacketed(layout="spiral")
