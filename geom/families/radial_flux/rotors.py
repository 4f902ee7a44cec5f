"""Rotors: interior magnets, their corners in the plane and how wide they may be; or a die-cast cage."""

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.radial_flux.layout import Layout
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


Corners = list[tuple[float, float]]
_STEPS = 200  # widths tried; the widest is known to half a percent of the pole
_SHAFT, _PITCH = 1.06, 0.98  # shares of shaft radius and half a pole that stay free


def corners(g: Geometry, radius: float, width: float) -> Corners:
    """Of one magnet of the pole at angle 0 (m), of a V the upper one; its outermost corner a bridge below `radius`."""
    thickness, reach = g.rotor.magnet_thickness, radius - g.rotor.bridge
    if g.rotor.magnet_shape == "flat":
        far = shapes.on_circle(reach, width / 2)
        near, half = far - thickness, width / 2
        return [(near, -half), (far, -half), (far, half), (near, half)]
    c, s, start = math.cos(g.rotor.v), math.sin(g.rotor.v), g.rotor.bridge
    # it begins half a bridge above the middle line and rises towards the rotor surface
    x = shapes.on_circle(reach, start / 2 + width * c)
    upper = [(x - width * s, start / 2), (x, start / 2 + width * c)]
    return upper + [(px - thickness * c, py + thickness * s) for px, py in reversed(upper)]


def widest(g: Geometry) -> float:
    """The widest magnet (m) that stays under the surface, off the shaft and in its half of the pole."""
    radius = g.stator.bore_diameter / 2 - g.stator.air_gap
    most = 2 * radius * math.sin(math.pi / g.rotor.poles)
    fits = 0.0
    for step in range(1, _STEPS + 1):
        if not _fits(g, radius, most * step / _STEPS):
            return fits
        fits = most * step / _STEPS
    return fits


def _fits(g: Geometry, radius: float, width: float) -> bool:
    rise = width / 2 if g.rotor.magnet_shape == "flat" else g.rotor.bridge / 2 + width * math.cos(g.rotor.v)
    if rise >= 0.98 * (radius - g.rotor.bridge):
        return False
    points = corners(g, radius, width)
    half = math.pi / g.rotor.poles
    inside = max(math.hypot(x, y) for x, y in points) <= radius - 0.95 * g.rotor.bridge
    inside_pitch = all(abs(math.atan2(y, x)) <= _PITCH * half for x, y in points)
    nearest = min(_to_axis(a, b) for a, b in zip(points, [*points[1:], points[0]], strict=True))
    return inside and inside_pitch and nearest >= _SHAFT * g.shaft.diameter / 2


def _to_axis(a: tuple[float, float], b: tuple[float, float]) -> float:
    dx, dy = b[0] - a[0], b[1] - a[1]
    along = -(a[0] * dx + a[1] * dy) / (dx * dx + dy * dy)
    share = min(max(along, 0.0), 1.0)
    return math.hypot(a[0] + share * dx, a[1] + share * dy)
