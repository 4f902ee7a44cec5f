"""Machines of pyleecan: every number at its place, shapes of the size that closed forms give, faults named."""

import itertools
import json
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from foreign_machines import put, pyleecan, saved

from geom import COARSE, InputError, build_mesh, check_cad, import_draft, load_machine, material
from geom.description.profile import loop_area
from geom.importing.holes import HOLES
from geom.importing.plane import Place, unite
from geom.importing.slots import CURVED, MAGNETS, STEPS, magnet_of, slot_of
from geom.machine_file import machine_from

GIVEN = sorted((Path(__file__).parents[4] / "shared/data/pyleecan").glob("*.json"))
STATOR, ROTOR = Place(0.08, 1, math.pi / 36), Place(0.08, -1, math.pi / 8)
PART = 2e-3  # areas by closed forms here leave out what an arc cuts off a chord


def mm(text, **more):
    """Sizes of a slot or hole in m, from a text in mm; angles and flags beside it."""
    pairs = (word.split("=") for word in text.split())
    return {key: float(value) / 1000 for key, value in pairs} | more


def area(loops):
    return sum(abs(loop_area(loop)) for loop in loops)


def trapeze(height, a, b):
    return height * (a + b) / 2


def half_chord(radius):
    """From the middle of a circle to a chord of 1 mm (m)."""
    return math.sqrt(radius**2 - 0.0005**2)


def cap(radius, width):
    """What a chord cuts off a circle."""
    return radius**2 * math.asin(width / 2 / radius) - width / 2 * math.sqrt(radius**2 - width**2 / 4)


SLOT = {"H0": 0.001, "H1": 0.0015, "H2": 0.02, "W0": 0.003, "W1": 0.007, "W2": 0.01, "W3": 0.011}
ROUND = math.pi / 2
FILLED = {  # what the winding fills, m2
    "SlotW10": (SLOT, trapeze(0.02, 0.003, 0.01)),
    "SlotW11": ({**SLOT, "R1": 0.002}, trapeze(0.018, 0.007, 0.01) + 0.01 * 0.002 - 2 * (1 - math.pi / 4) * 0.002**2),
    "SlotW12": ({"H0": 0.001, "R1": 0.002, "H1": 0.01, "R2": 0.001}, 0.01 * 0.002 + ROUND * 0.001**2),
    "SlotW13": (SLOT, trapeze(0.02, 0.01, 0.011)),
    "SlotW21": (SLOT, trapeze(0.02, 0.007, 0.01)),
    "SlotW22": ({"H0": 0.001, "H2": 0.02, "W0": 0.05, "W2": 0.1}, 0.05 * (0.101**2 - 0.081**2)),
    "SlotW24": ({"H2": 0.02, "W3": 0.006}, math.pi / 36 * (0.1**2 - 0.08**2) - 0.006 * 0.02),
    "SlotW26": (
        {"H0": 0.001, "H1": 0.012, "R1": 0.002, "R2": 0.001, "W0": 0.001},
        trapeze(0.012, 0.004, 0.002) + ROUND * (0.002**2 + 0.001**2),
    ),
    "SlotW27": (SLOT, trapeze(0.0015, 0.007, 0.01) + trapeze(0.02, 0.01, 0.011)),
    "SlotW29": (SLOT, 0.02 * 0.01),
    "SlotDC": (
        mm("W1=1 H1=2.5 D1=4 H2=6 W2=1 D2=3 H3=10 R3=1"),
        4e-6 * math.pi
        - 2 * cap(0.002, 0.001)
        + 1e-3 * (0.006 - half_chord(0.002) - half_chord(0.0015))
        + ROUND * 0.0015**2
        - cap(0.0015, 0.001)
        + trapeze(0.01, 0.003, 0.002)
        + ROUND * 1e-6,
    ),
}


@pytest.mark.parametrize("kind", FILLED)
def test_windings_fill_what_closed_forms_give(kind):
    sizes, expected = FILLED[kind]
    slot = slot_of(kind, STATOR, sizes | ({"2R2": 2 * sizes["R2"]} if "R2" in sizes else {}))
    assert area(slot.filled) == pytest.approx(expected, rel=0.01)
    assert all(abs(math.hypot(x, y) - 0.08) < 1e-12 for x, y, _ in (slot.path[0], slot.path[-1]))


MORE = {
    "SlotW14": {"H0": 0.001, "H1": 0.0015, "H3": 0.02, "W0": 0.003, "W3": 0.007},
    "SlotW15": {"H0": 0.001, "H1": 0.002, "H2": 0.02, "R1": 0.001, "R2": 0.002, "W0": 0.003, "W3": 0.007},
    "SlotW23": {"H0": 0.001, "H1": 0.001, "H2": 0.02, "W0": 0.003, "W3": 0.007, "is_cstt_tooth": 1.0},
    "SlotW25": {"H1": 0.002, "H2": 0.02, "W3": 0.007, "W4": 0.011},
    "SlotW30": {"H0": 0.001, "H1": 0.02, "R1": 0.001, "R2": 0.002, "W0": 0.003, "W3": 0.007},
    "SlotW28": {"H0": 0.001, "H3": 0.02, "R1": 0.002, "W0": 0.003, "W3": 0.007},
    "SlotWLSRPM": {"H2": 0.02, "H3": 0.002, "R1": 0.001, "W1": 0.004, "W3": 0.007},
}


@pytest.mark.parametrize("kind", MORE)
def test_parallel_teeth_have_their_width(kind):
    """Between two corners of neighbouring slots at mid depth."""
    path = slot_of(kind, STATOR, MORE[kind]).path
    flank = [complex(x, y) * np.exp(-1j * STATOR.half) for x, y, _ in path if y > 0]
    straight = [z for z, w in itertools.pairwise(flank) if abs(z.imag - w.imag) < 1e-9 and abs(z - w) > 0.01]
    assert [-2 * z.imag for z in straight] == pytest.approx([0.007])


MAGNET = {"H0": 0.001, "Hmag": 0.004, "W0": 0.03, "Wmag": 0.03, "Rtopm": 0.05}
ANGLE = {**MAGNET, "W0": 0.4, "Wmag": 0.4}
SURFACE = {
    "SlotM10": (MAGNET, 0.004 * 0.03),
    "SlotM11": (ANGLE, 0.2 * (0.083**2 - 0.079**2)),
    "SlotM18": ({"Hmag": 0.004}, math.pi / 8 * (0.084**2 - 0.08**2)),
}


@pytest.mark.parametrize("kind", SURFACE)
def test_magnets_on_the_surface(kind):
    sizes, expected = SURFACE[kind]
    assert area(magnet_of(kind, ROTOR, sizes).filled) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("kind", ["SlotM12", "SlotM13", "SlotM14", "SlotM15"])
def test_crowned_magnets_are_as_high_as_they_say(kind):
    sizes = ANGLE if kind == "SlotM14" else {**MAGNET, "W0": 0.4} if kind == "SlotM15" else MAGNET
    (loop,) = magnet_of(kind, ROTOR, sizes).filled
    assert 0.7 * 0.004 * 0.03 < area([loop]) < 0.004 * 0.032


FOOT = 0.35 - math.asin(1 / 50)  # of a magnet whose sides are parallel: where they begin (rad)
LSRPM = mm("H1=4 R1=1 R2=50 R3=45 W2=1", W1=0.35, W0=2 * (0.05 * math.sin(FOOT) - 0.001))
U51 = "W0=20 W2=2 W3=12 W4=2 W5=10 W6=2 W7=8 H0=20 H1=2 H2=6"
BURIED = {  # magnets, and the whole hole where it has a closed form
    "HoleM50": (mm("H0=20 H1=2 H2=2.5 H3=6 H4=0.8 W0=43.4 W1=3 W2=1 W3=10 W4=22"), 2 * 0.022 * 0.006, None),
    "HoleM51": (mm(U51, W1=0.6), 0.006 * (0.012 + 0.01 + 0.008), None),
    "HoleM52": (mm("H0=2 H1=8 H2=2 W0=30 W3=12"), 0.008 * 0.03, None),
    "HoleM53": (mm("H0=20 H1=2 H2=8 H3=2 W1=4 W2=2 W3=18", W4=1.1), 2 * 0.008 * 0.018, None),
    "HoleM54": (mm("H0=8 H1=8.2 R1=50", W0=0.78), 0.0, 0.39 * (0.0582**2 - 0.05**2)),
    "HoleM57": (mm("H1=2 W1=3 H2=6 W2=2 W3=10 W4=15", W0=2.4), 2 * 0.006 * 0.015, None),
    "HoleM58": (mm("W0=30 W1=20 W2=5 H0=12 H1=2 H2=8 R0=3", W3=0.6), 0.008 * 0.02, None),
    "HoleM60": (mm("W1=14 W2=22 W3=4 H0=5 H1=2", W0=2.2), 0.01 * 0.014, 2 * (0.017 * 0.005 + math.pi * 0.0025**2)),
    "HoleM61": (mm("W0=2 W1=8 W2=8 W3=10 H0=20 H1=4 H2=2"), 4 * 0.008 * 0.004, None),
    "HoleM62": (mm("H0=4 H1=2", W0=0.5, W0_is_rad=1.0), 0.25 * (0.078**2 - 0.074**2), None),
    "HoleM63": (mm("W0=20 H0=4 H1=2", top_flat=1.0), 0.004 * 0.02, None),
    "HoleMLSRPM": (LSRPM, (LSRPM["W0"] + 0.002) * (0.075 - 0.05 * math.cos(FOOT)), None),
}


@pytest.mark.parametrize("kind", BURIED)
def test_buried_magnets_lie_in_their_holes(kind):
    sizes, magnets, whole = BURIED[kind]
    hole = HOLES[kind](ROTOR, sizes)
    assert area(hole.magnets) == pytest.approx(magnets, rel=2e-3, abs=1e-12)
    pockets = unite([*hole.magnets, *hole.air])
    assert area(pockets) >= area(hole.magnets) - 1e-9
    assert whole is None or area(pockets) == pytest.approx(whole, rel=PART)
    assert max(math.hypot(x, y) for loop in pockets for x, y, _ in loop) < 0.0795


def test_every_shape_is_tested():
    assert set(FILLED) | set(MORE) | {"SlotM16", "SlotW16", "SlotW60", "SlotW61"} == {*STEPS, *CURVED}
    assert set(HOLES) == set(BURIED)
    assert len(MAGNETS) == 7


def test_a_small_machine_has_the_volumes_of_its_file(tmp_path):
    machine = load_machine(saved(tmp_path, pyleecan()))
    slot = 0.15 * (0.043**2 - 0.031**2)
    mouth = 0.05 * (0.031**2 - 0.03**2)
    copper = machine.part("winding").volume * machine.part("winding").filling[0]
    assert copper == pytest.approx(12 * 40 * math.pi / 4 * 0.001**2 * 0.04, rel=1e-6)
    iron = (math.pi * (0.055**2 - 0.03**2) - 12 * (slot + mouth)) * 0.04
    assert machine.part("stator.core").volume == pytest.approx(iron, rel=1e-6)
    assert machine.part("magnets").volume == pytest.approx(4 * 0.003 * 0.02 * 0.04, rel=1e-6)
    assert machine.features.air_gap == pytest.approx(0.0005)
    mesh = build_mesh(machine, **COARSE)
    assert set(mesh.parts) == {part.name for part in machine.parts}


def test_solids_of_round_slots_are_watertight(tmp_path):
    """End turns of round-bottomed slots do not merely touch the circle around them."""
    slot = {"__class__": "SlotW11", "Zs": 12, **mm("H0=1 H1=1 H2=12 R1=3 W0=2 W1=4 W2=6")}
    machine = load_machine(saved(tmp_path, pyleecan(stator__slot=slot)))
    for check in check_cad(machine, 0.5):
        assert check.watertight, check.part
        assert check.solid_volume == pytest.approx(check.volume, rel=0.02)


def duct(corners, turn=0.0):
    """A duct of every pole, line by line (m), at an angle (rad) of its own."""
    lines = [{"__class__": "Segment", "begin": str(a), "end": str(b)} for a, b in zip(corners, np.roll(corners, -1))]
    return {"__class__": "HoleUD", "Zh": 4, "Alpha0": turn, "surf_list": [{"label": "HoleVoid", "line_list": lines}]}


def test_ducts_may_be_drawn_across_a_hole(tmp_path):
    """With the hole they are one pocket, and what they share counts once."""
    corners = np.exp(-0.2j) * np.array([0.022 - 0.002j, 0.026 - 0.002j, 0.026 + 0.002j, 0.022 + 0.002j])
    draft = import_draft(saved(tmp_path, pyleecan(rotor__axial_vent=[duct(corners, 0.2)])))
    (pocket,) = draft.sections()["outlines"]["pockets"]
    (loop,) = pocket["loops_mm"]
    magnet, beyond = 20 * 3, 4 * 2.5  # mm2; the magnet begins at 24.5 mm
    assert abs(loop_area([(*corner, 0.0) for corner in loop])) == pytest.approx(magnet + beyond, rel=1e-4)


def test_a_crevice_beside_a_magnet_ends_in_a_tip(tmp_path):
    """Narrower there than what a mesh can tell: its walls belong to the air, and contacts to what touches."""
    crevice = duct(np.array([24.5, 24.5 + 8j, 24.44 + 8j, 24.497 + 0.2j]) / 1000)
    mesh = build_mesh(load_machine(saved(tmp_path, pyleecan(rotor__axial_vent=[crevice]))), **COARSE)
    for contact in mesh.contacts.values():
        for name in (contact.a, contact.b):
            assert np.isin(contact.facets, mesh.tets[mesh.region == mesh.parts.index(name)]).all(), name


def test_the_file_written_says_where_each_value_is_from(tmp_path):
    draft = import_draft(saved(tmp_path, pyleecan()), "jacket")
    text = draft.toml()
    assert tomllib.loads(text) == draft.sections()
    lines = [line for line in text.splitlines() if " = " in line and not line.startswith("#")]
    assert all("  # " in line for line in lines)
    assert "outer_diameter_mm = 110.0  # stator.Rext" in text
    assert machine_from(draft.sections(), "small").geometry.housing.kind == "spiral"


def left_of(folder, machine):
    rows = import_draft(saved(folder, machine)).table().documents()
    return {row["key"]: (row["value"], row["source"]) for row in rows if row["kind"] == "not understood"}


def test_lengths_and_radii_that_contradict_are_said_with_both_values(tmp_path):
    """What pyleecan writes where nobody gave a length says nothing."""
    frame = {"__class__": "Frame", "Lfra": 0.03, "Rint": 0.06, "Rext": 0.055}
    machine = pyleecan(rotor__L1=0.042, shaft__Lshaft=0.035) | {"frame": frame}
    left = left_of(tmp_path, machine)
    assert left["rotor.L1"][0] == 0.042
    assert "stator.L1 = 0.04 m" in left["rotor.L1"][1]
    assert left["shaft.Lshaft"][0] == 0.035
    assert "rotor.L1 = 0.042 m" in left["shaft.Lshaft"][1]
    assert "rotor.L1 = 0.042 m" in left["frame.Lfra"][1]
    assert "frame.Rint = 0.06 m" in left["frame.Rext"][1]
    assert "contradicts rotor.L1 = 0.042 m" in left["rotor.hole[0].magnet_0.Lmag"][1]
    unsaid = {"shaft__Lshaft": 0.442, "rotor__hole__0__magnet_0__Lmag": 0.95, "rotor__L1": 0.6, "stator__L1": 0.6}
    machine = pyleecan(**unsaid) | {"frame": {"__class__": "Frame", "Lfra": 0.35, "Rint": 0.2, "Rext": 0.2}}
    assert not left_of(tmp_path, machine).keys() & {"rotor.L1", "shaft.Lshaft", "frame.Lfra", "frame.Rext"}
    assert "rotor.hole[0].magnet_0.Lmag" not in left_of(tmp_path, machine)


def test_a_cage_and_a_wound_rotor(tmp_path):
    slot = {"__class__": "SlotW26", "Zs": 16, "H0": 0.0005, "H1": 0.004, "R1": 0.0015, "R2": 0.001, "W0": 0.001}
    cage = {"slot": slot, "winding": {"conductor": {"__class__": "CondType22", "Sbar": 1.53e-5}}, "hole": []}
    metal = {"name": "Copper1", "HT": {"lambda_x": 370.0, "lambda_z": 1, "Cp": 1}, "struct": {"rho": 8900.0}}
    cage |= {"__class__": "LamSquirrelCage", "Hscr": 0.006, "Lscr": 0.005, "ring_mat": metal}
    machine = pyleecan()
    machine["rotor"] |= cage
    built = load_machine(saved(tmp_path, machine))
    bar = trapeze(0.004, 0.003, 0.002) + ROUND * (0.0015**2 + 0.001**2)
    ring = math.pi * (0.029**2 - 0.023**2) * 0.005
    assert built.part("rotor.cage").volume == pytest.approx(16 * bar * 0.04 + 2 * ring, rel=0.01)
    found, usual = built.material_of("rotor.cage"), material("copper")
    assert (found.k_plane, found.rho) == (370.0, 8900.0)
    assert (found.name, found.k_axial, found.cp) == ("copper", usual.k_axial, usual.cp)  # 1 is what nobody gave
    poles = {"__class__": "SlotW61", "Zs": 4, **mm("H0=3 H1=1 H2=8 H3=0.5 H4=0.5 W0=12 W1=24 W2=16 W3=0")}
    wound = {"slot": poles, "winding": {**machine["stator"]["winding"], "Ntcoil": 8}, "hole": []}
    machine["rotor"] = {**pyleecan()["rotor"], **wound, "__class__": "LamSlotWind"}
    built = load_machine(saved(tmp_path, machine, "wound.json"))
    assert built.part("winding.field").volume == pytest.approx(8 * 0.007 * 0.004 * 0.04, rel=1e-6)
    assert built.part("winding.field").identity.turns


def test_north_and_south_poles_with_holes_of_their_own(tmp_path):
    machine = pyleecan()
    (hole,) = machine["rotor"]["hole"]
    machine["rotor"] |= {"__class__": "LamHoleNS", "hole": None, "hole_north": [hole]}
    machine["rotor"]["hole_south"] = [{**hole, "W0": 0.016}]
    built = load_machine(saved(tmp_path, machine))
    assert built.part("magnets").volume == pytest.approx(2 * 0.003 * (0.02 + 0.016) * 0.04, rel=1e-6)


FAULTS = {
    "another program": ({"__class__": "Simu1"}, "is not a machine"),
    "outer rotor": ({"stator__is_internal": True}, "the stator is inside"),
    "unknown rotor": ({"rotor____class__": "LamSlotMulti"}, "LamSlotMulti' is not read"),
    "unknown slot": ({"stator__slot____class__": "os.system"}, "is not known"),
    "no number": ({"stator__slot__H2": "deep"}, "lacks 'H2'"),
    "slots cut": ({"stator__slot__W2": 0.6}, "cuts its neighbour"),
    "too wide a rotor": ({"rotor__Rext": 0.031}, "the rotor ends at"),
    "no winding": ({"stator__winding": None}, "winding is not there"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_are_one_message_with_their_place(tmp_path, fault):
    changes, words = FAULTS[fault]
    machine = pyleecan()
    for path, value in changes.items():
        if path == "__class__":
            machine[path] = value
        elif path.endswith("____class__"):
            put(machine, [*path.removesuffix("____class__").split("__"), "__class__"], value)
        else:
            put(machine, path.split("__"), value)
    with pytest.raises(InputError, match=words.replace("(", r"\(")):
        load_machine(saved(tmp_path, machine))


def test_a_file_too_large_is_refused(tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_MOST_MACHINE_BYTES", "100")
    with pytest.raises(InputError, match="machine_bytes"):
        import_draft(saved(tmp_path, pyleecan()))


@pytest.mark.skipif(not GIVEN, reason="the public machines are not here")
@pytest.mark.parametrize("path", GIVEN, ids=lambda path: path.stem)
def test_public_machines_mesh_with_their_volumes(path):
    machine = load_machine(path)
    mesh = build_mesh(machine, **COARSE)
    corners = mesh.points[mesh.tets]
    sizes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6.0
    volumes = dict(zip(mesh.parts, np.bincount(mesh.region, sizes, len(mesh.parts))))
    for part in machine.parts:
        assert volumes[part.name] == pytest.approx(part.volume, rel=0.02), part.name
    document, winding = json.loads(path.read_text()), machine.part("winding")
    stator = document["stator"]
    conductor = stator["winding"]["conductor"]
    turns = stator["winding"]["Ntcoil"] * stator["winding"].get("Nlayer", 1)
    copper = stator["slot"]["Zs"] * turns * conductor["Nwppc"] * math.pi / 4 * conductor["Wwire"] ** 2 * stator["L1"]
    assert winding.filling[0] * winding.volume == pytest.approx(copper, rel=0.02)


def test_a_winding_is_of_the_conductor_of_its_file(tmp_path):
    metal = {"__class__": "Material", "name": "Alu", "HT": {"lambda_x": 220.0, "lambda_z": 220.0, "Cp": 900.0}}
    metal["struct"] = {"rho": 2700.0}
    path = saved(tmp_path, pyleecan(stator__winding__conductor__cond_mat=metal))
    entry = import_draft(path).sections()["materials"]["winding.left"]
    assert entry == {"k_conductor": 220.0, "cp_conductor": 900.0, "rho_conductor": 2700.0}
    assert load_machine(path).material_of("winding").mixture.k_conductor == 220.0
