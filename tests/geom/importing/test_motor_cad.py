"""Motor-CAD files: radial-flux machines with magnets, jacket, gaps and losses; faults with section and key."""

import math
from pathlib import Path

import pytest
from foreign_machines import V_SHAPE, motor_cad, saved

from geom import COARSE, InputError, build_mesh, import_draft, load_machine, material
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


def test_a_v_of_buried_magnets(tmp_path):
    machine = load_machine(saved(tmp_path, motor_cad(V_SHAPE, BPM_Rotor="Interior_VShape"), "small.mot"))
    assert machine.part("magnets").volume == pytest.approx(8 * 0.003 * 0.014 * 0.04, rel=1e-6)
    assert "air.inside" in [fluid.name for fluid in machine.fluids]


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
    assert "385 W/m/K" in left["Thermal_Conductivity_Copper_-_Active"]


REPEATED = {"Slot_Number": 18, "Magnet_Thickness": 5, "ConductorsPerSlot": 30, "Liner_Thickness": 1}


@pytest.mark.parametrize("key", REPEATED)
def test_a_key_that_stands_there_twice_is_said(tmp_path, key):
    """Whatever is read of a file; what nobody reads may stand there as often as it likes."""
    draft = draft_of(tmp_path, f"{key}={REPEATED[key]}\nOf_No_Use=1\nOf_No_Use=2\n")
    left = {e.key: e.source for e in draft.entries if e.kind == "not understood"}
    assert "stands there twice" in left[key]
    assert "Of_No_Use" not in left


def test_of_sections_that_have_a_key_one_counts_and_may_not_repeat_it(tmp_path):
    other = draft_of(tmp_path, "Shaft_Speed=900\n")
    assert (other.value("ratings", "speed_rpm"), "Shaft_Speed" in {e.key for e in other.entries}) == (1500.0, False)
    twice = draft_of(tmp_path, Shaft_Speed="1500\nShaft_Speed=900")
    assert "1500 is taken" in {e.key: e.source for e in twice.entries}["Shaft_Speed"]


@pytest.mark.parametrize(("slot", "more"), [("Parallel_Slot", "Slot_Width=7\n"), ("Parallel_Tooth", "")])
def test_slots_of_either_shape_mesh(tmp_path, slot, more):
    machine = machine_from(draft_of(tmp_path, more, Slot_Type=slot, Slot_Corner_Radius=0).sections(), slot)
    assert machine.part("winding").volume > 0


FAULTS = {
    "foreign": ({"Program_Name": "Other"}, r"\[Header\]"),
    "damaged": ({"Tooth_Width": None}, r"\[Dimensions\].*a number"),
    "no number": ({"Stator_Bore": "wide"}, r"\[Dimensions\]: Stator_Bore = wide"),
    "linear": ({"Motor_Type": "LIN"}, r"\[Calc_Options\]: Motor_Type = 'LIN' is not read"),
    "axial": ({"Motor_Type": "AFPM"}, "one of: BPM"),
    "other rotor": ({"BPM_Rotor": "Spoke"}, "Interior_VShape"),
    "other slot": ({"Slot_Type": "Form_Wound"}, "Parallel_Tooth"),
    "teeth too wide": ({"Tooth_Width": "17"}, "outlines|no shape|take"),
    "slot too deep": ({"Slot_Depth": "40"}, "from the axis"),
    "too many conductors": ({"ConductorsPerSlot": "400"}, "% of a slot"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_one_message_with_section_or_key(tmp_path, fault):
    changes, words = FAULTS[fault]
    with pytest.raises(InputError, match=words):
        load_machine(saved(tmp_path, motor_cad(**changes), "small.mot"))


@pytest.mark.parametrize("text", ["", "[Header]", "Program_Name=Motor-CAD\nMotor_Type=BPM", "\0\1"])
def test_damaged_files_are_refused(tmp_path, text):
    with pytest.raises(InputError):
        load_machine(saved(tmp_path, text, "small.mot"))


@pytest.mark.skipif(not E8.exists(), reason="the public file is not here")
def test_the_public_file_has_its_volumes():
    draft = import_draft(E8)
    machine = machine_from(draft.sections(), "e8")
    winding = machine.part("winding")
    assert winding.volume * winding.filling[0] == pytest.approx(48 * 120 * math.pi / 4 * 0.8e-3**2 * 0.16, rel=1e-6)
    magnets = 16 * (21.33 * 2.6 + 13.9 * 3.862) * 1e-6 * 0.15
    assert machine.part("magnets").volume == pytest.approx(magnets, rel=1e-6)
    assert len(draft.readings) == 10
