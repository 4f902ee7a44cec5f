"""Laminations, slots and winding of the stator."""

from __future__ import annotations

import math
from typing import Any

from geom import shapes
from geom.families.radial_flux.layout import Layout, half_angle
from geom.part import Part, extrude
from geom.profile import Loop, Profile


def stator(g: Any, at: Layout) -> tuple[Part, ...]:
    n = g.stator.slots
    angles = shapes.evenly(n)
    gap = g.stator.liner_gap
    whole = slot_loop(at.slot0, at.slot1, n, g.stator.tooth)
    lined = slot_loop(at.slot0 + gap, at.slot1 - gap, n, g.stator.tooth + 2 * gap)
    wire = Profile(slot_loop(at.wire0, at.wire1, n, at.wire_tooth))
    wires = shapes.turned(wire, angles)
    liners = shapes.turned(Profile(lined, (wire.outer,)), angles)
    fillings = shapes.turned(Profile(whole, (lined,)), angles) if gap else []
    ends = shapes.ring(at.wire0, at.wire1)
    core = Profile(shapes.circle_loop(at.core), (_bore(g, at, angles),))
    return (
        Part("stator.core", "electrical-steel", ((core, at.core0, at.core1),), "laminated"),
        *([Part("slot.gap", "gap-resin", extrude(fillings, at.core0, at.core1))] if gap else []),
        Part("slot.liner", "slot-liner", extrude(liners, at.core0, at.core1)),
        Part("winding", "winding", extrude(wires, at.core0, at.core1), "wound"),
        Part("winding.left", "end-winding", (*extrude(wires, at.coil0, at.core0), (ends, at.ring0, at.coil0))),
        Part("winding.right", "end-winding", (*extrude(wires, at.core1, at.coil1), (ends, at.coil1, at.ring1))),
    )


def slot_loop(inner: float, outer: float, slots: int, tooth: float) -> Loop:
    """The space along +x between two parallel-sided teeth and two radii (m)."""
    a, b = half_angle(inner, slots, tooth), half_angle(outer, slots, tooth)
    far = shapes.bulge_of(2 * b)
    return (shapes.polar(inner, -a), shapes.polar(outer, -b, far), shapes.polar(outer, b),
            shapes.polar(inner, a, -shapes.bulge_of(2 * a)))  # fmt: skip


def _bore(g: Any, at: Layout, angles: list[float]) -> Loop:
    """The bore with all slots and their openings."""
    n, half = g.stator.slots, g.stator.opening / 2
    mouth, throat = math.asin(half / at.bore), math.asin(half / at.slot0)
    inner, outer = (half_angle(r, n, g.stator.tooth) for r in (at.slot0, at.slot1))
    lip, bottom = shapes.bulge_of(inner - throat), shapes.bulge_of(2 * outer)
    loop = []
    for angle, pitch in zip(angles, shapes.gaps(angles)):
        loop += [
            shapes.polar(at.bore, angle - mouth),
            shapes.polar(at.slot0, angle - throat, -lip),
            shapes.polar(at.slot0, angle - inner),
            shapes.polar(at.slot1, angle - outer, bottom),
            shapes.polar(at.slot1, angle + outer),
            shapes.polar(at.slot0, angle + inner, -lip),
            shapes.polar(at.slot0, angle + throat),
            shapes.polar(at.bore, angle + mouth, shapes.bulge_of(pitch - 2 * mouth)),
        ]
    return tuple(loop)
