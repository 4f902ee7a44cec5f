"""A sleeve around a rotor: the resistance of a cylindrical shell; magnets, machine file and refusals."""

import math

import numpy as np
import pytest
from foreign_machines import motor_cad, saved

from fem.matrices.assembly import assemble
from fem.matrices.material import isotropic
from fem.solvers.solve import Solver, only_fixed, steady
from geom import build_mesh, import_draft, load_machine
from geom.machine_file import machine_from
from lumped.build.pipeline import build
from lumped.condensation.reduction import Recipe
from lumped.integration.steady import steady as rest
from lumped.machine.motor import rated_inputs

WALL = 1e9  # W/m2/K: stands for a wall of known temperature
COARSE = Recipe(tolerance=0.02, shifts=(), random_points=0)
BAND = {"Banding_Thickness": 1.5, "Banding_-_Rotor": 0.02, "Magnet_Banding_Loss_@Ref_Speed": 5}
MORE = "".join(f"{key}={value}\n" for key, value in BAND.items())


def sleeved(**rotor):
    geometry = {"stator": {"slots": 9}, "rotor": {"sleeve_mm": 4.0, "core_diameter_mm": 150.0, **rotor}}
    return machine_from({"machine": {"family": "cross-section"}, "geometry": geometry}, "sleeve.toml")


def heat_through(segments, k):
    """Heat (W) from the room under the sleeve, at 100 degC, to the air gap at 0, and what passes its ends: none."""
    machine = sleeved()
    field = assemble(
        build_mesh(machine, size_m=0.05, segments=segments),
        {part.name: isotropic(k) for part in machine.parts},
        {part.name: 1.0 for part in machine.parts},
    )
    films = {name: WALL if name in ("rotor.sleeve.gap", "rotor.sleeve.air.inside") else 0.0 for name in field.films}
    others = {name: 1.0 for name in field.films if not name.startswith("rotor.sleeve")}  # else nothing holds the rest
    fluids = dict.fromkeys({film.fluid for film in field.films.values()}, 0.0) | {"air.inside": 100.0}
    found = steady(
        Solver(field), {**films, **others}, dict.fromkeys(field.contacts, 1.0), np.zeros(field.n), only_fixed(**fluids)
    )
    trace = field.films["rotor.sleeve.gap"].trace
    return WALL * float(trace.b @ found.T[trace.dofs])


@pytest.mark.parametrize("k", [0.7, 50.0])
def test_it_conducts_as_a_cylindrical_shell(k):
    """Q = 2 pi k L dT / ln(r2 / r1); chords come nearer to the circle at second order."""
    outer = 174.0 / 2 - 1.0  # bore and gap of the default machine, mm
    exact = 2 * math.pi * k * 0.150 * 100.0 / math.log(outer / (outer - 4.0))
    coarse, fine = (heat_through(n, k) / exact - 1 for n in (48, 96))
    assert abs(fine) < 1e-3
    assert abs(fine) < 0.5 * abs(coarse)


def test_a_banding_over_surface_magnets_is_read(tmp_path):
    machine = load_machine(saved(tmp_path, motor_cad(MORE), "small.mot"))
    sleeve, gap = machine.part("rotor.sleeve"), 29.0
    assert sleeve.volume == pytest.approx(math.pi * (gap**2 - 27.5**2) * 40e-9, rel=1e-9)
    angle = math.radians(150) / 2
    assert machine.part("magnets").volume == pytest.approx(4 * angle / 2 * (27.5**2 - 23.5**2) * 40e-9, rel=1e-6)
    assert machine.sections["contacts"]["magnets|rotor.sleeve"] == {"gap_mm": 0.02}
    assert machine.sections["losses"]["magnet-banding-iron-loss"]["at"] == "rotor.sleeve"
    mesh = build_mesh(machine, size_m=0.05, segments=48)
    assert "magnets|rotor.sleeve" in set(mesh.contacts)
    assert "air.inside" in {fluid.name for fluid in machine.fluids}  # between the magnets, under the sleeve


def test_no_air_lies_under_a_sleeve_that_all_touches():
    """Magnets flush in their notches leave none; the notches alone do."""
    half, low, top = 10.0, 77.0, math.sqrt(82.0**2 - 10.0**2)  # mm; the sleeve begins at 82
    path = [[top, -half], [low, -half], [low, half], [top, half]]
    bulge = math.tan(math.asin(half / 82.0) / 2)
    flush = [[top, -half, bulge], [top, half], [low, half], [low, -half]]
    notches, magnets = ([{"copies": 4, "loops_mm": [loop]}] for loop in (path, flush))
    geometry = {"stator": {"slots": 9}, "rotor": {"sleeve_mm": 4.0}}
    for outlines, air in (({}, False), ({"notches": notches}, True), ({"notches": notches, "magnets": magnets}, False)):
        machine = machine_from(
            {"machine": {"family": "cross-section"}, "geometry": geometry, "outlines": outlines}, "sleeve.toml"
        )
        mesh = build_mesh(machine, size_m=0.05, segments=48)
        assert ("air.inside" in {fluid.name for fluid in machine.fluids}) == air
        assert ("rotor.sleeve.air.inside" in mesh.patches) == air


def test_in_the_network_a_sleeve_of_titanium_leaves_magnets_cooler(tmp_path):
    """The network has it as a part that turns, with its contact and its film. Some heat of the magnets leaves through
    it, and none may cost more than all of it would in the shell over the magnets' arc."""
    draft, hot = import_draft(saved(tmp_path, motor_cad(MORE), "small.mot")), {}
    for name in ("carbon-fibre", "titanium"):
        sections = draft.sections()
        sections["materials"]["rotor.sleeve"] = name
        sections["losses"] = {"magnets": {"kind": "magnet", "at": "magnets", "P_W": 100.0}}
        machine = machine_from(sections, "small")
        network = build(machine, 0.1, 36, COARSE).network
        names = {link.name for link in network.links}
        assert {"contact:magnets|rotor.sleeve", "film:rotor.sleeve.gap", "film:rotor.sleeve.air.inside"} <= names
        assert network.identities["rotor.sleeve"].turns
        around = {"ambient": 25.0, "coolant": 30.0}
        found = rest(network, rated_inputs(machine), around, rows=[network.places["magnets"].mean])
        hot[name] = found.y[0]
    resistance = [math.log(29.0 / 27.5) / (2 * math.pi * k * 0.040 * 150 / 180) for k in (0.7, 6.7)]
    assert 0.5 < hot["carbon-fibre"] - hot["titanium"] < 100.0 * (resistance[0] - resistance[1])
