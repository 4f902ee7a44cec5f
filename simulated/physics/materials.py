"""What the parts are made of in truth: geom's table, moved by draws; contact conductances by kind of joint."""

import csv
from collections.abc import Iterable
from fnmatch import fnmatch
from pathlib import Path

from geom.description.machine import Machine
from simulated.physics.conduction import Solid
from simulated.physics.draws import Draws

# Relative change of the conductivity per K: copper and steel conduct worse when hot, resins better.
SLOPES = {"steel": -4e-4, "electrical-steel": -4e-4, "aluminium-cast": 2e-4, "commutator": -2e-4, "bearing": 0.0}
RESIN = 8e-4


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
    return {name: draws.around(f"contact.{name}", nominal_contact("series-dc", name), 0.30) for name in names}


def nominal_contact(machine: str, name: str) -> float:
    """W/m2/K of the first pattern in contacts.csv that fits."""
    with Path(__file__).with_name("contacts.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["machine"] == machine]
    return next(float(row["W_m2K"]) for row in rows if fnmatch(name, row["contact"]))
