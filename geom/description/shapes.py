"""Profiles that motors are made of. Lengths in m, angles in rad; a shape lies along +x until rotated."""

import math
from collections.abc import Sequence

from geom.description.profile import Loop, Profile, Vertex


def circle_loop(radius: float, x: float = 0.0, y: float = 0.0) -> Loop:
    return (x + radius, y, 1.0), (x - radius, y, 1.0)


def disc(radius: float, x: float = 0.0, y: float = 0.0) -> Profile:
    return Profile(circle_loop(radius, x, y))


def ring(inner: float, outer: float) -> Profile:
    return Profile(circle_loop(outer), (circle_loop(inner),))


def rectangle(x0: float, x1: float, y0: float, y1: float) -> Profile:
    return Profile(((x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0)))


def polar(radius: float, angle: float, bulge: float = 0.0) -> Vertex:
    return radius * math.cos(angle), radius * math.sin(angle), bulge


def bulge_of(sweep: float) -> float:
    """DXF bulge of an arc of this signed sweep (rad)."""
    return math.tan(sweep / 4)


def sector(inner: float, outer: float, start: float, end: float) -> Profile:
    """Piece of a ring between two angles."""
    bulge = bulge_of(end - start)
    return Profile((polar(inner, start), polar(outer, start, bulge), polar(outer, end), polar(inner, end, -bulge)))


def on_circle(radius: float, y: float) -> float:
    """x of the point of the circle at height y (m)."""
    return math.sqrt(radius**2 - y**2)


def finned_loop(radius: float, width: float, tip: float, angles: Sequence[float]) -> Loop:
    """A circle with one straight-sided rectangular fin out to x = tip at each angle."""
    half = math.asin(width / 2 / radius)
    root = radius * math.cos(half)
    loop: list[Vertex] = []
    for angle, gap in zip(angles, gaps(angles)):
        bulge = bulge_of(gap - 2 * half)
        corners = ((root, -width / 2, 0.0), (tip, -width / 2, 0.0), (tip, width / 2, 0.0), (root, width / 2, bulge))
        loop += [_turn(corner, angle) for corner in corners]
    return tuple(loop)


def slotted_loop(radius: float, width: float, bottom: float, angles: Sequence[float]) -> Loop:
    """A circle with one parallel-sided slot down to the radius `bottom` at each angle."""
    half, inner = math.asin(width / 2 / radius), math.asin(width / 2 / bottom)
    loop: list[Vertex] = []
    for angle, gap in zip(angles, gaps(angles)):
        loop += [polar(radius, angle - half), polar(bottom, angle - inner, bulge_of(2 * inner))]
        loop += [polar(bottom, angle + inner), polar(radius, angle + half, bulge_of(gap - 2 * half))]
    return tuple(loop)


def bar_loop(inner: float, outer: float, width: float) -> Loop:
    """A parallel-sided bar along +x between two radii: what fills a slot."""
    return strip_loop(inner, outer, -width / 2, width / 2)


def strip_loop(inner: float, outer: float, y0: float, y1: float) -> Loop:
    """A parallel-sided bar along +x between two radii, from y0 to y1 (m)."""
    (a0, a1), (b0, b1) = ((math.asin(y0 / r), math.asin(y1 / r)) for r in (inner, outer))
    (p0, p1), (q0, q1) = ((on_circle(r, y0), on_circle(r, y1)) for r in (inner, outer))
    return (p0, y0, 0.0), (q0, y0, bulge_of(b1 - b0)), (q1, y1, 0.0), (p1, y1, -bulge_of(a1 - a0))


def gaps(angles: Sequence[float]) -> list[float]:
    """From each angle to the next, around the circle (rad)."""
    return [b - a for a, b in zip(angles, [*angles[1:], angles[0] + 2 * math.pi])]


def turned(profile: Profile, angles: Sequence[float]) -> list[Profile]:
    return [profile.rotated(angle) for angle in angles]


def evenly(count: int, start: float = 0.0) -> list[float]:
    """`count` angles (rad) around the circle."""
    return [start + 2 * math.pi * i / count for i in range(count)]


def spread(count: int, middle: float, spacing: float) -> list[float]:
    """`count` angles (rad) at the spacing (rad) around the middle; around the whole circle from there if it is 0."""
    if not spacing:
        return evenly(count, middle)
    return [middle + (i - (count - 1) / 2) * spacing for i in range(count)]


def _turn(vertex: Vertex, angle: float) -> Vertex:
    c, s = math.cos(angle), math.sin(angle)
    return c * vertex[0] - s * vertex[1], s * vertex[0] + c * vertex[1], vertex[2]
