"""Rotors: interior magnets, or a die-cast cage."""

from __future__ import annotations

import math
from typing import Any

from geom import shapes
from geom.families.radial_flux.layout import Layout
from geom.part import Part, extrude
from geom.profile import Profile
from geom.roles import Role


def shaft(g: Any, at: Layout) -> Part:
    return Part(
        "shaft", "steel", ((shapes.disc(g.shaft.diameter / 2), 0.0, at.length + g.shaft.extension),), role=Role.SHAFT
    )


def magnet_rotor(g: Any, at: Layout) -> tuple[Part, ...]:
    magnets = shapes_of_magnets(g, at)
    holes = (shapes.circle_loop(g.shaft.diameter / 2), *(magnet.outer for magnet in magnets))
    core = Profile(shapes.circle_loop(at.rotor), holes)
    return (
        Part("rotor.core", "electrical-steel", ((core, at.core0, at.core1),), role=Role.ROTOR),
        Part("magnets", "magnet-ndfeb", extrude(magnets, at.core0, at.core1), role=Role.MAGNET),
    )


def shapes_of_magnets(g: Any, at: Layout) -> list[Profile]:
    """All magnets in the plane."""
    return [magnet for angle in shapes.evenly(g.rotor.poles) for magnet in shapes.turned_list(_pole(g, at), angle)]


def _pole(g: Any, at: Layout) -> list[Profile]:
    """Magnets of the pole at angle 0, their outermost corners a bridge below the surface."""
    width, thickness, reach = g.rotor.magnet_width, g.rotor.magnet_thickness, at.rotor - g.rotor.bridge
    if g.rotor.magnet_shape == "flat":
        far = shapes.on_circle(reach, width / 2)
        return [shapes.rectangle(far - thickness, far, -width / 2, width / 2)]
    tilt, start = g.rotor.v, g.rotor.bridge
    c, s = math.cos(tilt), math.sin(tilt)
    # the upper magnet begins half a bridge above the middle line and rises towards the rotor surface
    y = start / 2 + width * c
    x = shapes.on_circle(reach, y)
    corner = (x - width * s, start / 2)
    along, across = (width * s, width * c), (-thickness * c, thickness * s)
    upper = [corner, (corner[0] + along[0], corner[1] + along[1])]
    upper += [(px + across[0], py + across[1]) for px, py in reversed(upper)]
    return [
        Profile(tuple((px, py, 0.0) for px, py in upper)),
        Profile(tuple((px, -py, 0.0) for px, py in reversed(upper))),
    ]


def cage_rotor(g: Any, at: Layout) -> tuple[Part, ...]:
    angles, bottom = shapes.evenly(g.rotor.bars), at.rotor - g.rotor.bar_depth
    core = Profile(
        shapes.slotted_loop(at.rotor, g.rotor.bar_width, bottom, angles), (shapes.circle_loop(g.shaft.diameter / 2),)
    )
    bars = shapes.turned(Profile(shapes.bar_loop(bottom, at.rotor, g.rotor.bar_width)), angles)
    ring = shapes.ring(bottom, at.rotor)
    rings = ((ring, at.core0 - g.rotor.ring, at.core0), (ring, at.core1, at.core1 + g.rotor.ring))
    return (
        Part("rotor.core", "electrical-steel", ((core, at.core0, at.core1),), role=Role.ROTOR),
        Part("rotor.cage", "aluminium-cast", (*extrude(bars, at.core0, at.core1), *rings), role=Role.CAGE),
    )
