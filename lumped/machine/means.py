"""Sensor places that average parts, as declared in [sensors] of a machine file.

[sensors]
"winding.copper" = { mean_of = ["winding", "winding.left", "winding.right"], by = "copper" }   # or by = "mass"
"""

from __future__ import annotations

import numpy as np

from geom.description.machine import Machine
from lumped.model.network import Network, Place
from lumped.schemas.reader import Table, suggestion

COPPER, RESIN = 8930.0, 1350.0  # kg/m3, as in the mixtures of geom.description.materials


def means(machine: Machine, network: Network) -> dict[str, Place]:
    """Name -> place; its mean row is what the sensor sees."""
    section = machine.sections.get("sensors", {})
    return {
        name: _mean(machine, network, name, Table(data, f"{machine.name} [sensors] {name}"))
        for name, data in section.items()
    }


def _mean(machine: Machine, network: Network, name: str, table: Table) -> Place:
    parts = table.words("mean_of")
    by = table.word("by", "mass", ("mass", "copper"))
    table.close()
    for part in parts:
        if part not in [p.name for p in machine.parts]:
            raise table.error(f"no part '{part}'", suggestion(part, [p.name for p in machine.parts]))
    weights = np.array([_amount(machine, part, by) for part in parts])
    if not weights.sum() > 0:
        raise table.error("no copper in these parts", 'by = "mass"')
    weights = weights / weights.sum()
    states = np.array([network.column(part) for part in parts])
    return Place(name, "node", parts[int(np.argmax(weights))], states, np.diag(weights), weights)


def _amount(machine: Machine, part: str, by: str) -> float:
    """kg, or m3 of copper: the length of wire of one cross-section."""
    rho, volume = machine.material_of(part).rho, machine.part(part).volume
    return rho * volume if by == "mass" else max(rho - RESIN, 0.0) / (COPPER - RESIN) * volume
