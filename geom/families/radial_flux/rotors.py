"""Rotors: interior magnets, or a die-cast cage."""

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.radial_flux.layout import Layout
from geom.families.radial_flux.magnets import corners
from geom.families.shaft_fan import WHEEL


def shaft(g: Geometry, at: Layout) -> Part:
    """From the fan's wheel to the end of the extension."""
    span = (1 - WHEEL[0]) * at.cowl0, at.length + g.shaft.extension
    return Part("shaft", "steel", ((shapes.disc(g.shaft.diameter / 2), *span),), role=Role.SHAFT)


def magnet_rotor(g: Geometry, at: Layout) -> tuple[Part, ...]:
    magnets = shapes_of_magnets(g, at)
    holes = (shapes.circle_loop(g.shaft.diameter / 2), *(magnet.outer for magnet in magnets))
    core = Profile(shapes.circle_loop(at.rotor), holes)
    return (
        Part("rotor.core", "electrical-steel", ((core, at.core0, at.core1),), role=Role.ROTOR),
        Part("magnets", "magnet-ndfeb", extrude(magnets, at.core0, at.core1), role=Role.MAGNET),
    )


def shapes_of_magnets(g: Geometry, at: Layout) -> list[Profile]:
    """All magnets in the plane."""
    return [magnet.rotated(angle) for angle in shapes.evenly(g.rotor.poles) for magnet in _pole(g, at)]


def _pole(g: Geometry, at: Layout) -> list[Profile]:
    """Magnets of the pole at angle 0, their outermost corners a bridge below the surface."""
    points = corners(g, at.rotor, g.rotor.magnet_width)
    one = Profile(tuple((x, y, 0.0) for x, y in points))
    return [one] if g.rotor.magnet_shape == "flat" else [one, Profile(tuple((x, -y, 0.0) for x, y in reversed(points)))]


def cage_rotor(g: Geometry, at: Layout) -> tuple[Part, ...]:
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
