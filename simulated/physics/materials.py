"""What the parts are made of in truth: geom's table, moved by draws; contact conductances by kind of joint."""

from __future__ import annotations

from collections.abc import Iterable
from fnmatch import fnmatch

from geom.description.machine import Machine
from simulated.physics.conduction import Solid
from simulated.physics.draws import Draws

# Relative change of the conductivity per K: copper and steel conduct worse when hot, resins better.
SLOPES = {"steel": -4e-4, "electrical-steel": -4e-4, "aluminium-cast": 2e-4, "commutator": -2e-4, "bearing": 0.0}
RESIN = 8e-4

CONTACTS = (
    ("housing|yoke", 870.0),
    ("flange.*|housing", 2000.0),
    ("flange.*|yoke", 2000.0),
    ("poles|yoke", 2000.0),
    ("field.insulation|*", 400.0),
    ("winding.field|yoke", 200.0),
    ("poles|winding.field", 200.0),
    ("rotor.core|slot.liner", 400.0),
    ("slot.liner|winding.armature", 400.0),
    ("rotor.core|shaft", 4000.0),
    ("commutator|shaft", 500.0),
    ("commutator|winding.armature.right", 3000.0),
    ("winding.armature|winding.armature.*", 50_000.0),
    ("rotor.core|winding.armature*", 200.0),
    ("slot.liner|winding.armature.*", 200.0),
    ("bearing.*|shaft", 150.0),
    ("bearing.*|flange.*", 1500.0),
    ("feet|housing", 3000.0),
    ("base|feet", 500.0),
    ("*", 1000.0),
)


def solids(machine: Machine, draws: Draws) -> dict[str, Solid]:
    common = draws.around("capacity.machine", 1.0, 0.04)
    return {part.name: _solid(machine, part.name, common, draws) for part in machine.parts}


def _solid(machine: Machine, part: str, common: float, draws: Draws) -> Solid:
    found = machine.material_of(part)
    factor = draws.around(f"conductivity.{part}", 1.0, 0.10)
    capacity = common * draws.around(f"capacity.{part}", 1.0, 0.03)
    k = (factor * found.k_plane, factor * found.k_axial)
    turns = machine.part("poles").span if part == "winding.field" else None
    return Solid(k, capacity * found.rho * found.cp, SLOPES.get(found.name, RESIN), turns)


def contacts(names: Iterable[str], draws: Draws) -> dict[str, float]:
    """Conductance of every contact (W/m2/K)."""
    return {name: draws.around(f"contact.{name}", nominal_contact(name), 0.30) for name in names}


def nominal_contact(name: str) -> float:
    return next(value for pattern, value in CONTACTS if fnmatch(name, pattern))
