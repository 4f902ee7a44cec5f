"""Liquid jackets of the series-wound motor: wetted areas against hand formulas, names, refusals."""

import math

import pytest
from measures import area

from geom import COARSE, InputError, build_mesh, library, load_machine
from geom.machine import machine_from


def jacketed(**jacket):
    table = {"machine": {"family": "series-dc"}, "geometry": {"jacket": {"sides": 1, **jacket}}}
    return machine_from(table)


@pytest.mark.parametrize("machine", [name for name in library() if name.startswith("series-dc-100kw-jacket")])
def test_each_side_has_its_own_fluid_and_wall(machine):
    loaded = load_machine(machine)
    fluids = {fluid.name for fluid in loaded.fluids}
    for index, side in enumerate(("left", "right")):
        assert (f"jacket.{side}" in fluids) == (index < loaded.geometry.jacket.sides)


def test_zigzag_is_one_passage_whose_walls_follow_from_its_channels():
    """n channels in a row, joined in pairs at alternate ends: n - 1 openings between neighbours, as wide as deep."""
    machine = jacketed(layout="zigzag")
    g, coolant = machine.geometry.jacket, machine.part("jacket.left")
    (z0, z1), n = coolant.span, g.channels
    inner = machine.part("housing").prisms[0][0].holes[0][0][0] + machine.geometry.housing.thickness
    outer = inner + g.height
    sweep = 2 * math.pi / n - g.rib / inner
    rib = 2 * math.pi / n - sweep
    section, over_rib = sweep * (outer**2 - inner**2) / 2, rib * (outer**2 - inner**2) / 2
    separate = n * ((sweep * (inner + outer) + 2 * g.height) * (z1 - z0) + 2 * section)
    # each opening adds the ribs' curved walls and its bottom, and takes away two radial walls
    opening = rib * (inner + outer) * g.height + 2 * over_rib - 2 * g.height * g.height
    wetted = separate + (n - 1) * opening
    mesh = build_mesh(machine, **COARSE)
    assert area(mesh, mesh.patches["jacket.left.wall"].facets) == pytest.approx(wetted, rel=0.01)
    assert coolant.volume == pytest.approx(n * section * (z1 - z0) + (n - 1) * over_rib * g.height)


@pytest.mark.parametrize("layout", ["zigzag", "helical"])
def test_inlet_and_outlet_are_named_and_lie_on_the_outer_wall(layout):
    machine = jacketed(layout=layout, sides=2)
    names = [f"jacket.{side}.{end}" for side in ("left", "right") for end in ("inlet", "outlet")]
    assert [port.name for port in machine.ports] == names
    inner = machine.part("housing").prisms[0][0].holes[0][0][0] + machine.geometry.housing.thickness
    wall = inner + machine.geometry.jacket.height + machine.geometry.jacket.wall
    for port in machine.ports:
        x, y, z = port.position
        z0, z1 = machine.part(port.fluid).span
        assert math.hypot(x, y) == pytest.approx(wall)
        assert z0 < z < z1


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
