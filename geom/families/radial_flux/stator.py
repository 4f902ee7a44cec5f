"""Laminations, slots and winding of the stator."""

import math
from itertools import pairwise

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, extrude
from geom.description.profile import Loop, Profile
from geom.description.roles import Role
from geom.families.radial_flux.hairpin import hairpin, layer_height
from geom.families.radial_flux.layout import Layout


def stator(g: Geometry, at: Layout) -> tuple[Part, ...]:
    w, angles, gap = g.winding, shapes.evenly(g.stator.slots), g.stator.liner_gap
    whole = slot_loop(at, at.slot0, at.slot1, 0.0)
    lined = slot_loop(at, at.slot0 + gap, at.slot1 - gap, gap)
    wire = Profile(slot_loop(at, at.wire0, at.wire1, at.lining))
    wires = shapes.turned(wire, angles)
    liners = shapes.turned(Profile(lined, (wire.outer,)), angles)
    fillings = shapes.turned(Profile(whole, (lined,)), angles) if gap else []
    half = g.stator.opening / 2
    mouth, throat = math.asin(half / at.bore), math.asin(half / at.slot0)
    inner, outer = (at.half_angle(r) for r in (at.slot0, at.slot1))
    lip, bottom = shapes.bulge_of(inner - throat), shapes.bulge_of(2 * outer)
    loop, polar = [], shapes.polar
    for angle, pitch in zip(angles, shapes.gaps(angles)):
        loop += [polar(at.bore, angle - mouth), polar(at.slot0, angle - throat, -lip)]
        loop += [polar(at.slot0, angle - inner), polar(at.slot1, angle - outer, bottom)]
        loop += [polar(at.slot1, angle + outer), polar(at.slot0, angle + inner, -lip)]
        loop += [polar(at.slot0, angle + throat), polar(at.bore, angle + mouth, shapes.bulge_of(pitch - 2 * mouth))]
    core = Profile(shapes.circle_loop(at.core), (tuple(loop),))
    return (
        Part("stator.core", "electrical-steel", ((core, at.core0, at.core1),), role=Role.IRON),
        *([Part("slot.gap", "gap-resin", extrude(fillings, at.core0, at.core1), role=Role.INSULATION)] if gap else []),
        Part("slot.liner", "slot-liner", extrude(liners, at.core0, at.core1), role=Role.INSULATION),
        *_wedges(g, at, angles),
        *(_layers if w.kind == "hairpin" else _bundles)(g, at, angles, wires),
    )


def _layers(g: Geometry, at: Layout, angles: list[float], wires: list[Profile]) -> list[Part]:
    edges = [at.wire1 - k * layer_height(g) for k in range(g.winding.layers + 1)]
    return hairpin(g, at, angles, wires, [Profile(slot_loop(at, a, b, at.lining)) for b, a in pairwise(edges)])


def _bundles(g: Geometry, at: Layout, angles: list[float], wires: list[Profile]) -> list[Part]:
    w, ends, loose = g.winding, _ends(g, at, angles), (g.winding.end_fill, g.winding.end_impregnation)
    left = (*extrude(wires, at.coil0, at.core0), *extrude(ends, at.ring0, at.coil0))
    right = (*extrude(wires, at.core1, at.coil1), *extrude(ends, at.coil1, at.ring1))
    return [
        Part("winding", "winding", extrude(wires, at.core0, at.core1), (w.fill, w.impregnation), role=Role.WINDING),
        Part("winding.left", "end-winding", left, loose, role=Role.WINDING),
        Part("winding.right", "end-winding", right, loose, role=Role.WINDING),
    ]


def _ends(g: Geometry, at: Layout, angles: list[float]) -> list[Profile]:
    """Overhang in the plane: a ring, or for coils around single teeth an arch from slot to slot at each tooth."""
    if g.winding.kind == "distributed":
        return [shapes.ring(at.wire0, at.wire1)]
    half_opening = math.asin(g.stator.opening / 2 / at.wire0)
    pitch = 2 * math.pi / g.stator.slots
    return [shapes.sector(at.wire0, at.wire1, angle + half_opening, angle + pitch - half_opening) for angle in angles]


def _wedges(g: Geometry, at: Layout, angles: list[float]) -> tuple[Part, ...]:
    """What closes the slots, in the openings between the tooth tips."""
    if not g.stator.wedge:
        return ()
    bar = Profile(shapes.bar_loop(at.slot0 - g.stator.wedge, at.slot0, g.stator.opening))
    return (
        Part("slot.wedge", "insulation", extrude(shapes.turned(bar, angles), at.core0, at.core1), role=Role.INSULATION),
    )


def slot_loop(at: Layout, inner: float, outer: float, lining: float) -> Loop:
    """The slot along +x between two radii (m), narrower by the lining (m) on either side."""
    a, b = at.half_angle(inner, lining), at.half_angle(outer, lining)
    near, far = -shapes.bulge_of(2 * a), shapes.bulge_of(2 * b)
    polar = shapes.polar
    return polar(inner, -a), polar(outer, -b, far), polar(outer, b), polar(inner, a, near)
