"""Liquid jackets of the series-wound motor: wetted areas against hand formulas, names, refusals."""

import math
from dataclasses import replace

import pytest
from measures import area

from geom import COARSE, InputError, build_mesh, export_cad, import_step, load_machine
from geom.description.part import Helix
from geom.machine_file import machine_from
from geom.solids.cad import solids
from geom.solids.screw import channel

SPIRAL_AND_ZIGZAG = ["ipmsm-48s8p-jacket", "series-dc-100kw-jacket-one"]
HELICAL = ["ipmsm-48s8p-jacket", "series-dc-100kw-jacket-two"]


def jacketed(**jacket):
    table = {"machine": {"family": "series-dc"}, "geometry": {"jacket": {"sides": 1, **jacket}}}
    return machine_from(table)


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
    bores = sum(2.5 * g.port * math.pi / 4 * g.port**2 for _ in machine.ports)  # an upper bound of the liquid in ports
    found = coolant.volume - n * section * (z1 - z0) - (n - 1) * over_rib * g.height
    assert 0 < found < bores


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
    rings = [prism for prism in machine.part("jacket.left").prisms if prism[0].holes]
    for profile, z0, z1 in rings:
        outer, inner = profile.outer[0][0], profile.holes[0][0][0]
        wetted += 2 * math.pi * (outer + inner) * (z1 - z0) + 2 * profile.area
    assert len(rings) == 3
    assert area(mesh, mesh.patches["jacket.left.wall"].facets) == pytest.approx(wetted, rel=0.01)


@pytest.mark.parametrize("layout", ["zigzag", "helical"])
def test_ribs_that_leave_no_channel_are_refused(layout):
    with pytest.raises(InputError, match=r"jacket\] rib_mm: 70 does not fit"):
        jacketed(layout=layout, rib_mm=70.0)


@pytest.mark.parametrize("name", SPIRAL_AND_ZIGZAG)
def test_every_port_is_a_tube_with_a_wet_bore(name):
    """A square bore of the round one's cross-section: four sides, as long as the tube."""
    machine = load_machine(name)
    mesh, bore = build_mesh(machine, **COARSE), 0.010
    assert len(machine.ports) == 2 * sum(fluid.material != "air" for fluid in machine.fluids)
    for port in machine.ports:
        patch = mesh.patches[f"{port.name}.bore"]
        assert (patch.part, patch.fluid) == (f"{port.name}.tube", port.fluid)
        exact = 4 * (bore * math.sqrt(math.pi) / 2) * 1.5 * bore
        assert area(mesh, patch.facets) == pytest.approx(exact, rel=0.02)
        assert f"{port.name}.tube.outer" in mesh.patches
        assert f"housing|{port.name}.tube" in mesh.contacts


def helices(machine):
    return [cut for cut in machine.part("housing").cad_shape.cuts if isinstance(cut, Helix)]


@pytest.mark.parametrize("name", HELICAL)
def test_helix_has_the_volume_and_the_wetted_area_of_the_rings(name):
    """The volume; the area within 2 %, which its end walls add."""
    machine = load_machine(name)
    for helix, jacket in zip(helices(machine), (f for f in machine.fluids if f.material != "air"), strict=True):
        rings = [(profile, z0, z1) for profile, z0, z1 in jacket.prisms if profile.holes]
        wetted = sum(2 * math.pi * (helix.inner + helix.outer) * (z1 - z0) + 2 * p.area for p, z0, z1 in rings)
        solid = channel(helix)
        assert solid.Volume() * 1e-9 == pytest.approx(sum(p.area * (z1 - z0) for p, z0, z1 in rings), rel=1e-9)
        assert 1.0 < solid.Area() * 1e-6 / wetted < 1.02
        assert helix.turns == pytest.approx(len(rings), abs=0.3)


@pytest.mark.parametrize("name", SPIRAL_AND_ZIGZAG)
def test_bores_of_the_made_housing_lead_into_its_channel(name, run_cache):
    """A thin probe through every port meets no metal before the inner wall, in the helix as in the prisms."""
    import cadquery as cq

    machine = load_machine(name)
    g = machine.geometry
    depth = 1e3 * (g.jacket.wall + g.jacket.height if hasattr(g, "jacket") else g.housing.wall + g.housing.channel)
    (housing,) = solids(machine.part("housing"), run_cache)
    for port in machine.ports:
        x, y, z = (1e3 * value for value in port.position)
        out = cq.Vector(x, y, 0).normalized()
        probe = cq.Solid.makeCylinder(4.0, depth + 5.0, cq.Vector(x, y, z) - out * (depth - 0.5), out)
        assert housing.intersect(probe).Volume() < 1e-3 * probe.Volume(), port.name


@pytest.mark.nightly
def test_step_of_prisms_reads_back_where_the_made_one_is_refused(tmp_path):
    """Of the housing and its ports: the other parts have nothing to add."""
    whole = jacketed(layout="helical", turns=2)
    parts = tuple(part for part in whole.parts if part.cad_shape)
    assert len(parts) == 3
    machine = replace(whole, parts=parts)
    written = export_cad(machine, tmp_path, ("step",))
    back = import_step(written["step:prisms"])
    assert {part.name for part in back.parts} == {part.name for part in machine.parts}
    for part in back.parts:
        assert part.volume == pytest.approx(machine.part(part.name).volume, rel=1e-6), part.name
    with pytest.raises(InputError, match=r"housing.*not prismatic along the axis"):
        import_step(written["step"])


@pytest.mark.parametrize(
    ("jacket", "words"),
    [
        ({"port_mm": 60.0}, "port_mm: 60 does not fit"),
        ({"layout": "helical", "port_mm": 30.0}, "port_mm: 30 does not fit"),
    ],
)
def test_ports_wider_than_their_channel_are_refused(jacket, words):
    with pytest.raises(InputError, match=words):
        jacketed(**jacket)
