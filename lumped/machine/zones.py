"""Loss zones of a motor: teeth and back of a slotted core, halves of a slot, shoe and body of a pole, field coils."""

from functools import partial

import numpy as np

from geom.description.machine import Machine
from geom.description.part import Part
from lumped.condensation.condensed import Zone
from lumped.machine.shapes import laminated, radius, wound
from lumped.model.network import Array

MANY = 6  # prisms: a winding with this many bars lies in slots


def motor_zones(machine: Machine) -> dict[str, Zone]:
    """Zone -> where; "PART.WORD", as [losses] of a machine file may name them."""
    # Salient poles: the shoe lies at the air gap
    out: dict[str, Zone] = {}
    for name, shoe in machine.features.shoes.items():
        out |= _split(name, _reach(machine.part(name))[0] + shoe, "shoe", "body")
    return {**_slots(machine), **out, **_coils(machine)}


def _slots(machine: Machine) -> dict[str, Zone]:
    bars = machine.features.bars
    reach = [] if bars is None else [_reach(machine.part(layer)) for layer in bars.layers]
    out = _teeth(machine, min(r[0] for r in reach), max(r[1] for r in reach)) if reach else {}
    for winding in machine.parts:
        straight = len({(z0, z1) for _, z0, z1 in winding.prisms}) == 1
        if wound(machine, winding.name) and len(winding.prisms) >= MANY and straight:
            low, high = _reach(winding)
            out |= _split(winding.name, (low + high) / 2, "inner", "outer") | _teeth(machine, low, high)
    return out


def _teeth(machine: Machine, low: float, high: float) -> dict[str, Zone]:
    """Teeth and back of the core whose slots hold what lies between two radii (m)."""
    out: dict[str, Zone] = {}
    for core in machine.parts:
        near, far = _reach(core)
        if laminated(machine, core.name) and near < high and low < far:
            teeth_outside = far - high < low - near
            words = ("back", "teeth") if teeth_outside else ("teeth", "back")
            out |= _split(core.name, low if teeth_outside else high, *words)
    return out


def _coils(machine: Machine) -> dict[str, Zone]:
    """One coil per pole."""
    axes = [(name, np.array(coils.axes)) for name, coils in machine.features.coils.items()]
    return {f"{name}.{k + 1}": Zone(name, partial(_nearest, at, k)) for name, at in axes for k in range(len(at))}


def _nearest(axes: Array, k: int, x: Array) -> Array:
    off = np.abs(np.angle(np.exp(1j * (np.arctan2(x[:, 1], x[:, 0])[:, None] - axes))))
    return (np.argmin(off, axis=1) == k).astype(float)


def _split(part: str, at: float, inner: str, outer: str) -> dict[str, Zone]:
    """Two zones of a part, below and above a radius (m)."""
    return {
        f"{part}.{inner}": Zone(part, lambda x: (np.hypot(x[:, 0], x[:, 1]) < at).astype(float)),
        f"{part}.{outer}": Zone(part, lambda x: (np.hypot(x[:, 0], x[:, 1]) >= at).astype(float)),
    }


def _reach(part: Part) -> tuple[float, float]:
    """Least and largest distance of a part's corners from the axis (m)."""
    corners = [np.hypot(x, y) for profile, _, _ in part.prisms for loop in profile.loops for x, y, _ in loop]
    return float(min(corners)), max(radius(profile.outer) for profile, _, _ in part.prisms)
