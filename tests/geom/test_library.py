"""Every machine that comes with the tool: its gaps, its quality, its published dimensions, its variants."""

import math

import pytest
import shapely
from library_machines import DISTINCT
from measures import area

from geom import COARSE, InputError, build_mesh, library, load_machine, part_table
from geom.machine_file import machine_from
from geom.meshing.mesher import _planned

pytestmark = pytest.mark.nightly


@pytest.fixture(scope="module", params=DISTINCT)
def meshed(request):
    machine = load_machine(request.param)
    return machine, build_mesh(machine, **COARSE)


def test_nothing_is_a_hair_apart(meshed):
    """A gap nobody meant shows as a sliver of fluid; between chords that are cut differently 0.1 mm is left."""
    machine, _ = meshed
    cut = _planned((*machine.parts, *machine.fluids), COARSE["segments"]).cut
    empty = ~cut.solid.all(axis=1)
    width = 2 * cut.area() / shapely.length(cut.faces)
    assert width[empty].min() > 5e-5


@pytest.mark.parametrize(
    ("name", "slots", "length", "gap"), [("m1", 18, 0.29, 1.4), ("m2", 48, 0.29, 0.7), ("m3", 48, 0.465, 1.0)]
)
def test_machines_of_the_table(name, slots, length, gap):
    for variant in ("", "-no-base", "-plate"):
        g = load_machine(f"pmsm-{name}{variant}").geometry
        assert g.winding.kind == ("concentrated" if name == "m1" else "distributed")
        assert (g.stator.slots, g.rotor.poles, g.frame.length) == (slots, 16, pytest.approx(length))
        assert g.stator.liner_gap == pytest.approx(gap * 1e-3)


def test_stack_touches_the_housing_over_its_whole_cylinder():
    machine = load_machine("tefc-industrial")
    mesh = build_mesh(machine, **COARSE)
    g = machine.geometry.stator
    exact = math.pi * g.outer_diameter * g.stack_length
    assert area(mesh, mesh.contacts["housing|stator.core"].facets) == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize(
    ("geometry", "words"),
    [
        ({"housing": {"kind": "axial-fins", "fins": 200, "fin_thickness_mm": 5.0}}, ["fin_thickness_mm", "overlap"]),
        ({"stator": {"liner_gap_mm": 5.0, "slots": 48, "tooth_mm": 5.0}}, ["tooth_mm"]),
        ({"rotor": {"magnet_width_mm": 60.0}}, ["magnet_width_mm", "pole pitch"]),
        ({"rotor": {"magnet_thickness_mm": 60.0}}, ["magnet_thickness_mm", "shaft"]),
        ({"base": {"kind": "plate", "width_mm": 50.0}}, ["width_mm", "foot"]),
    ],
)
def test_impossible_magnet_machines_are_refused(geometry, words):
    with pytest.raises(InputError) as caught:
        machine_from({"machine": {"family": "pmsm"}, "geometry": geometry})
    for word in words:
        assert word in str(caught.value)


def test_three_cooling_layouts_of_the_series_motor_keep_its_envelope():
    for name in (name for name in library() if name.startswith("series-dc-100kw")):
        machine = load_machine(name)
        assert machine.sections["ratings"]["envelope_mm"] == [440.0, 1090.0, 1155.0]
        assert all(size <= limit + 1e-9 for size, limit in zip(machine.extent, (0.44, 1.09, 1.155)))


def test_forced_air_has_fan_ducts_and_fins():
    machine = load_machine("series-dc-100kw-air")
    assert {"fan.cowl", "fan.wheel", "commutator.mica"} < {part.name for part in machine.parts}
    assert {"air.fan", "air.ducts"} < {fluid.name for fluid in machine.fluids}
    faces = {row.name: row.faces for row in part_table(machine, segments=48)}
    inside = math.pi * (0.15**2 - 0.0625**2)  # the cowl's circle on the flange, less the bearing seat
    assert faces["flange.left"]["flange.left.air.fan"] == pytest.approx(inside, rel=0.01)
    assert faces["rotor.core"]["rotor.core.air.ducts"] == pytest.approx(12 * math.pi * 0.02 * 0.188, rel=0.01)


def test_cowl_and_fan_may_be_meshed_on_a_machine_with_a_round_rotor():
    """Off, nothing changes; on, the cowl stands on the end-cap and the wheel on the shaft, which reaches out to it."""
    tefc = {"machine": {"family": "tefc"}}
    plain, blown = machine_from(tefc), machine_from({**tefc, "geometry": {"fan": {"depth_mm": 60.0}}})
    assert [p.name for p in blown.parts] == [*(p.name for p in plain.parts), "fan.cowl", "fan.wheel"]
    mesh = build_mesh(blown, 0.1, 24)
    assert {"endcap.left|fan.cowl", "fan.wheel|shaft"} <= set(mesh.contacts)
    assert {"fan.cowl.outer", "fan.wheel.outer"} <= set(mesh.patches)
    assert blown.part("shaft").span[0] == pytest.approx(-0.8 * 0.060)
    assert blown.part("fan.cowl").volume == pytest.approx(math.pi * (0.1015**2 - 0.1**2) * 0.060)


def test_brush_gear_may_be_meshed_on_a_commutator_machine():
    """Carbons on the commutator, arms to the flange; half of the brushes' loss is then theirs."""
    series = {"machine": {"family": "series-dc"}}
    geared = machine_from({**series, "geometry": {"brushes": {"arms": 4}}})
    assert not {"brushes", "brush.arms"} & {p.name for p in machine_from(series).parts}
    mesh = build_mesh(geared, 0.1, 24)
    assert {"brushes|commutator", "brush.arms|brushes", "brush.arms|flange.right"} <= set(mesh.contacts)
    carbon = geared.part("brushes").volume * geared.material_of("brushes").rho
    assert 0.1 < carbon < 5.0  # kg: four rows of a machine of 100 kW
    with pytest.raises(InputError, match="armature's radius"):
        machine_from({**series, "geometry": {"brushes": {"arms": 4, "height_mm": 60.0}}})


def pmsm(**geometry):
    return machine_from({"machine": {"family": "pmsm"}, "geometry": geometry})


def test_wedges_fill_the_slot_openings():
    g = pmsm().geometry.stator
    assert pmsm(stator={"wedge_mm": 2.0}).part("slot.wedge").volume == pytest.approx(
        18 * 0.002 * g.opening * g.stack_length, rel=0.01
    )


def test_fins_at_a_spacing_stand_around_the_top():
    machine = machine_from(
        {"machine": {"family": "tefc"}, "geometry": {"housing": {"fins": 9, "fin_spacing_mm": 10.0}}}
    )
    loop = machine.part("housing").prisms[0][0].outer
    tips = sorted({round(math.atan2(y, x), 6) for x, y, _ in loop if math.hypot(x, y) > 0.129})
    assert len(tips) == 18
    assert sum(tips) / 18 == pytest.approx(math.pi / 2, abs=1e-6)


def test_radial_fins_go_all_around_but_for_the_foot():
    """18 discs; those beside the foot lack the strip that it takes, with a fin's thickness free on either side."""
    machine = load_machine("tefc-industrial-radial")
    g, housing = machine.geometry, machine.part("housing")
    wall = g.stator.outer_diameter / 2 + g.housing.thickness
    tip, half, thick = wall + g.housing.fin_height, g.foot.width / 2 + g.housing.fin_thickness, g.housing.fin_thickness
    fins = [(profile, z0, z1) for profile, z0, z1 in housing.prisms if profile.area > 1.1 * housing.prisms[0][0].area]
    assert len(fins) == 18
    foot0, foot1 = machine.part("foot").span
    beside = sum(z1 > foot0 - thick / 2 and z0 < foot1 + thick / 2 for _, z0, z1 in fins)
    assert 3 < beside < 12
    under = [half * math.sqrt(r**2 - half**2) + r**2 * math.asin(half / r) for r in (tip, wall)]
    by_hand = thick * (18 * math.pi * (tip**2 - wall**2) - beside * (under[0] - under[1]))
    bare = housing.prisms[0][0].area * (housing.span[1] - housing.span[0])
    assert housing.volume - bare == pytest.approx(by_hand, rel=1e-9)
