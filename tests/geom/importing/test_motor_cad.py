"""Motor-CAD files: radial-flux machines with magnets, jacket, gaps and losses; faults with section and key."""

import math
from pathlib import Path

import pytest
import shapely
from foreign_machines import V_SHAPE, motor_cad, saved

from geom import COARSE, InputError, build_mesh, import_draft, load_machine, material
from geom.description.profile import ArcGrid, Profile
from geom.machine_file import machine_from

E8 = Path(__file__).parents[4] / "shared/data/motor-cad/e8_ipmsm_jacket.mot"


def draft_of(folder, more="", **changes):
    return import_draft(saved(folder, motor_cad(more, **changes), "small.mot"))


def test_a_small_machine_has_the_volumes_of_its_file(tmp_path):
    machine = load_machine(saved(tmp_path, motor_cad(), "small.mot"))
    winding = machine.part("winding")
    assert winding.volume * winding.filling[0] == pytest.approx(12 * 40 * math.pi / 4 * 1e-6 * 0.04, rel=1e-6)
    assert winding.filling[1] == 0.8
    whole = 12 * (math.pi / 12 * (0.044**2 - 0.0315**2) - 0.008 * (0.044 - 0.0315)) * 0.04
    assert winding.volume == pytest.approx(whole, rel=0.05)  # tips and corners take some per cent
    angle = math.radians(150) / 2  # two pole pairs
    assert machine.part("magnets").volume == pytest.approx(4 * angle / 2 * (0.029**2 - 0.025**2) * 0.04, rel=1e-6)
    assert machine.part("housing").span == (0.008, 0.132)
    assert set(build_mesh(machine, **COARSE).parts) == {part.name for part in machine.parts}


def test_cooling_gaps_and_losses_are_those_of_the_file(tmp_path):
    draft = draft_of(tmp_path)
    sections = draft.sections()
    assert sections["cooling"]["flow_L_per_min"] == pytest.approx(3.0)
    assert sections["cooling"]["inlet_C"] == 30.0
    assert sections["contacts"]["housing|stator.core"] == {"gap_mm": 0.02}
    assert sections["contacts"]["stator.core|winding"]["h_W_m2K"] == pytest.approx(0.2 / 0.25e-3)
    magnet = sections["losses"]["magnet-iron-loss"]
    assert magnet["P_W"] == 10.0
    assert magnet["of"] == {"input": "speed_rpm", "at": 2000.0, "exponent": 2.0}
    assert sections["ratings"]["speed_rpm"] == 1500.0
    assert draft.readings == {"Winding (Avg)": 71.5}
    machine_from(sections, "small")


def test_parts_are_of_the_materials_of_the_file(tmp_path):
    """Sheets conduct as the file says in their plane alone; what the file does not say stays as usual."""
    machine, usual = load_machine(saved(tmp_path, motor_cad(), "small.mot")), material("electrical-steel")
    housing, core = machine.material_of("housing"), machine.material_of("stator.core")
    assert (housing.k_plane, housing.k_axial, housing.cp) == (168.0, 168.0, 833.0)
    assert housing.rho == material("aluminium-cast").rho
    assert (core.k_plane, core.k_axial, core.rho) == (30.0, usual.k_axial, usual.rho)
    assert machine.material_of("rotor.core") == usual
    for part in ("winding", "winding.left"):
        assert machine.material_of(part).mixture.k_conductor == 401.0


def test_a_v_of_buried_magnets(tmp_path):
    machine = load_machine(saved(tmp_path, motor_cad(V_SHAPE, BPM_Rotor="Interior_VShape"), "small.mot"))
    assert machine.part("magnets").volume == pytest.approx(8 * 0.003 * 0.014 * 0.04, rel=1e-6)
    assert "air.inside" in [fluid.name for fluid in machine.fluids]


def mm(name, draft):
    """Shapes of one pole or pitch, in mm, as polygons with their arcs."""
    (group,) = draft.sections()["outlines"][name]
    loops = [tuple((x, y, *(b or [0.0])) for x, y, *b in loop) for loop in group["loops_mm"]]
    return shapely.union_all([shapely.Polygon(ArcGrid([Profile(loop)], 720).facet(loop)) for loop in loops])


def disc(radius):
    return shapely.Point(0, 0).buffer(radius, quad_segs=500)


def turned(x0, y0, x1, y1, degrees):
    return shapely.affinity.rotate(shapely.box(x0, y0, x1, y1), degrees, origin=(0, 0))


def test_arms_of_a_v_end_at_bridge_and_web(tmp_path):
    """Without the web their corners would lie in the next pole."""
    wide = V_SHAPE.replace("PoleArc_Array[0]=130", "PoleArc_Array[0]=150") + "WebThickness_Array[0]=1\n"
    draft = draft_of(tmp_path, wide, BPM_Rotor="Interior_VShape")
    beyond = disc(100).difference(disc(27)).union(turned(0, -0.5, 100, 100, 45))
    pockets = mm("pockets", draft)
    assert pockets.intersection(beyond).area == pytest.approx(0.0, abs=1e-3)
    assert pockets.distance(beyond) < 1e-3
    assert mm("magnets", draft).area == pytest.approx(2 * 3 * 14, rel=1e-6)


U_SHAPE = """Magnet_Layers=2
UShape_InnerDiameter_Array[0]=34
UShape_Thickness_Inner_Array[0]=3
UShape_Thickness_Outer_Array[0]=2
UShape_WebThickness_Array[0]=4
UShape_BridgeThickness_Array[0]=1
UShape_CentrePost_Array[0]=2
UMagnet_Length_Inner_Array[0]=6
UMagnet_Length_Outer_Array[0]=3
UShape_InnerDiameter_Array[1]=46
UShape_Thickness_Outer_Array[1]=1.5
UShape_WebThickness_Array[1]=20
UShape_BridgeThickness_Array[1]=1
UShape_Post_Outer_Array[1]=0.5
"""


def test_a_u_of_buried_magnets(tmp_path):
    """Arms along the edge of the pole, half the web from it; across the middle, without the post; inside the bridge."""
    draft = draft_of(tmp_path, U_SHAPE, BPM_Rotor="Interior_UShape")
    outer = turned(0, -4, 60, -2, 45).intersection(shapely.box(17, 0, 60, 60))
    across = shapely.box(17, 1, 20, 60).difference(turned(0, -2, 60, 60, 45))
    inner = turned(0, -11.5, 60, -10, 45).intersection(shapely.box(23, 0, 60, 60))
    half = shapely.union_all([outer, across, inner]).intersection(disc(28))
    assert mm("pockets", draft).area == pytest.approx(2 * half.area, rel=1e-4)
    assert mm("magnets", draft).area == pytest.approx(2 * (6 * 3 + 3 * 2), rel=1e-6)
    assert mm("magnets", draft).difference(mm("pockets", draft)).area < 1e-3
    assert [e.key for e in draft.entries if "no ribs" in e.source] == ["UShape_Post_Outer_Array[1]"]
    leaning = draft_of(tmp_path, U_SHAPE + "UShape_OuterAngleOffset_Array[0]=-10\n", BPM_Rotor="Interior_UShape")
    assert mm("pockets", leaning).area < mm("pockets", draft).area  # at the bridge it stays, inside it ends earlier
    machine_from(leaning.sections(), "leaning")


CAGE = """Top_Bar_Type={kind}
Rotor_Bars=28
Bar_Opening_[T]={opening}
Bar_Opening_Depth_[T]=1
Bar_Depth_[T]=9
Bar_Corner_Radius[T]=0.5
BarT_Opening_Radius=0.5
Bar_Tip_Angle_[T]=20
Rotor_Tooth_Width_T=3
EndRing_Thickness_F=6
EndRing_Inner_Add_F=1
Material_Rotor_Cage_Top=Copper (Pure)
Conductivity_Rotor_Cage_Top=390
Rotor_Copper_Loss_@Ref_Speed=50
"""


@pytest.mark.parametrize(("kind", "opening"), [("2", 1), ("4", 0)])
def test_a_cage_is_that_of_its_file(tmp_path, kind, opening):
    """Bars between parallel teeth, rounded below; above, with a slope, or rounded as well."""
    draft = draft_of(tmp_path, CAGE.format(kind=kind, opening=opening), Motor_Type="IM")
    half = 180 / 28
    side = 40 * math.tan(math.radians(half))
    pitch = shapely.Polygon([(0, 0), (40, -side), (40, side)])
    bar = pitch.difference(turned(0, -1.5, 40, 1.5, half)).difference(turned(0, -1.5, 40, 1.5, -half))
    bar = bar.intersection(disc(28)).difference(disc(20))
    round_ = bar.buffer(-0.5).buffer(0.5, quad_segs=90)
    if kind == "2":
        top, slope = math.sqrt(28**2 - opening**2 / 4), math.tan(math.radians(20))
        roof = [(top, opening / 2), (top - 9 * slope, opening / 2 + 9), (0, 20)]
        round_ = round_.union(bar.intersection(shapely.box(22, -9, 40, 9)))
        round_ = round_.intersection(shapely.Polygon([*roof, *((x, -y) for x, y in reversed(roof))]))
    assert mm("bars", draft).area == pytest.approx(round_.area, rel=2e-3)
    sections = draft.sections()
    assert ("notches" in sections["outlines"]) == (opening > 0)
    assert sections["geometry"]["rotor"]["end_mm"] == 6
    assert sections["geometry"]["rotor"]["ring_mm"] == pytest.approx(9, abs=0.1)
    assert sections["losses"]["rotor-copper-loss"]["at"] == "rotor.cage"
    machine = machine_from(sections, "cage")
    assert machine.material_of("rotor.cage").k_plane == 390
    assert set(build_mesh(machine, **COARSE).parts) == {part.name for part in machine.parts}


def test_magnets_with_parallel_sides_are_as_wide_as_their_arc_outside(tmp_path):
    draft = draft_of(tmp_path, BPM_Rotor="Surface_Parallel", **{"Magnet_Arc_[ED]": "90"})
    width = 2 * 29 * math.sin(math.radians(90 / 2 / 2))
    expected = disc(29).difference(disc(25)).intersection(shapely.box(0, -width / 2, 40, width / 2))
    assert mm("magnets", draft).area == pytest.approx(expected.area, rel=1e-4)


def test_a_hairpin_has_its_layers(tmp_path):
    pins = "Armature_CoilStyle=1\nCopper_Width=3\nCopper_Height=1.5\n"
    draft = draft_of(tmp_path, pins, ConductorsPerSlot=6)
    machine = machine_from(draft.sections(), "pins")
    layers = [part for part in machine.parts if ".layer-" in part.name]
    assert len(layers) == 6
    for part in layers:
        assert part.volume * part.filling[0] == pytest.approx(12 * 4.5e-6 * 0.04, rel=1e-6)
    assert machine.sections["sensors"]["winding.copper"]["mean_of"][:1] == ["winding.layer-1"]
    assert not [pair for pair in machine.sections["contacts"] if "winding" in pair.split("|")]


def test_bars_that_are_no_layers_are_a_solid_winding(tmp_path):
    pins = "Armature_CoilStyle=1\nCopper_Width=3\nCopper_Height=2.5\n"
    draft = draft_of(tmp_path, pins, ConductorsPerSlot=6)
    assert "equivalent solid" in {e.key: e.source for e in draft.entries}["Armature_CoilStyle"]
    machine = machine_from(draft.sections(), "pins")
    copper = machine.part("winding").volume * machine.part("winding").filling[0]
    assert copper == pytest.approx(12 * 6 * 7.5e-6 * 0.04, rel=1e-6)


def test_what_contradicts_or_goes_nowhere_is_said(tmp_path):
    more = "Sleeve_Thickness=1\nStator_Bore=61\nSpray_Cooling=True\n"
    left = {
        e.key: e.source for e in draft_of(tmp_path, more, Rotor_Lam_Length=36).entries if e.kind == "not understood"
    }
    assert "contradicts Stator_Lam_Length" in left["Rotor_Lam_Length"]
    assert "60 is taken" in left["Stator_Bore"]
    assert {"Sleeve_Thickness", "Spray_Cooling", "[Losses_At_RPM_Ref]"} <= set(left)


def test_a_key_that_stands_there_twice_is_said(tmp_path):
    """Whatever is read of a file; what nobody reads may stand there as often as it likes."""
    draft = draft_of(tmp_path, "Slot_Number=18\nOf_No_Use=1\nOf_No_Use=2\n")
    left = {e.key: e.source for e in draft.entries if e.kind == "not understood"}
    assert "stands there twice" in left["Slot_Number"]
    assert "Of_No_Use" not in left


FAULTS = {
    "foreign": ({"Program_Name": "Other"}, r"\[Header\]"),
    "damaged": ({"Tooth_Width": None}, r"\[Dimensions\].*a number"),
    "no number": ({"Stator_Bore": "wide"}, r"\[Dimensions\]: Stator_Bore = wide"),
    "axial": ({"Motor_Type": "AFPM"}, "one of: BPM, IM"),
    "other rotor": ({"BPM_Rotor": "Spoke"}, "Interior_VShape"),
    "slot too deep": ({"Slot_Depth": "40"}, "from the axis"),
    "too many conductors": ({"ConductorsPerSlot": "400"}, "% of a slot"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_one_message_with_section_or_key(tmp_path, fault):
    changes, words = FAULTS[fault]
    with pytest.raises(InputError, match=words):
        load_machine(saved(tmp_path, motor_cad(**changes), "small.mot"))


@pytest.mark.skipif(not E8.exists(), reason="the public file is not here")
def test_the_public_file_has_its_volumes():
    draft = import_draft(E8)
    machine = machine_from(draft.sections(), "e8")
    winding = machine.part("winding")
    assert winding.volume * winding.filling[0] == pytest.approx(48 * 120 * math.pi / 4 * 0.8e-3**2 * 0.16, rel=1e-6)
    magnets = 16 * (21.33 * 2.6 + 13.9 * 3.862) * 1e-6 * 0.15
    assert machine.part("magnets").volume == pytest.approx(magnets, rel=1e-6)
    assert len(draft.readings) == 10
