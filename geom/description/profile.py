"""2-D profiles with exact arcs: the one description that CAD, mesh and hand formulas share."""

import math
from bisect import bisect
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from shapely import Polygon

Vertex = tuple[float, float, float]
Loop = tuple[Vertex, ...]
_CENTRED = 1e-8  # m; an arc whose centre is nearer to the axis than this is concentric with the machine
_THIN = 0.05  # radii of one profile nearer than this share their break points
_RADIUS_GRID = 1e-8  # m; radii are equal when they round to the same multiple
_SAME = 1e-9  # rad; ends of arcs nearer than this are one: in files from elsewhere points that meet differ by 1e-13 m


@dataclass(frozen=True)
class Arc:
    """A circular edge: centre (m), radius (m), start angle and signed sweep (rad, positive anticlockwise)."""

    x: float
    y: float
    radius: float
    start: float
    sweep: float

    @property
    def concentric(self) -> bool:
        return math.hypot(self.x, self.y) < _CENTRED

    def at(self, angle: float) -> tuple[float, float]:
        return self.x + self.radius * math.cos(angle), self.y + self.radius * math.sin(angle)

    def extremes(self) -> Iterator[tuple[float, float]]:
        """Its points furthest left, right, up and down, as far as the arc has them."""
        sign = math.copysign(1.0, self.sweep)
        for quarter in range(4):
            away = (sign * (quarter * math.pi / 2 - self.start)) % (2 * math.pi)
            if away <= abs(self.sweep):
                yield self.at(quarter * math.pi / 2)


@dataclass(frozen=True)
class Profile:
    """A plane region: an outer loop and holes.

    Each loop is a closed ring of vertices (x (m), y (m), bulge); as in DXF, bulge = tan(sweep / 4) of the
    edge that leaves the vertex: 0 is a straight edge, 1 an anticlockwise half circle.
    """

    outer: Loop
    holes: tuple[Loop, ...] = ()

    @property
    def loops(self) -> tuple[Loop, ...]:
        return (self.outer, *self.holes)

    @property
    def area(self) -> float:
        """Exact area (m2), arcs included."""
        return abs(loop_area(self.outer)) - sum(abs(loop_area(hole)) for hole in self.holes)

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Exact x0, y0, x1, y1 (m), arcs included."""
        points = [(x, y) for x, y, _ in self.outer]
        points += [p for _, arc in edges(self.outer) if arc is not None for p in arc.extremes()]
        x, y = zip(*points)
        return min(x), min(y), max(x), max(y)

    def rotated(self, angle: float) -> "Profile":
        """The same profile turned about the axis by `angle` (rad, anticlockwise)."""
        return Profile(_turned(self.outer, angle), tuple(_turned(hole, angle) for hole in self.holes))

    def scaled(self, factor: float) -> "Profile":
        """The same profile in other units."""
        return Profile(_scaled(self.outer, factor), tuple(_scaled(hole, factor) for hole in self.holes))

    def to_polygon(self, grid: "ArcGrid") -> "Polygon":
        """Faceted shapely polygon; profiles faceted on the same grid share their vertices."""
        from shapely import Polygon

        return Polygon(grid.facet(self.outer), [grid.facet(hole) for hole in self.holes])


class ArcGrid:
    """Where concentric arcs are cut into chords, the same for every profile of a machine.

    On each radius the break points are the arc ends of all profiles; each piece between two neighbouring
    breaks is cut evenly into chords of at most 1 / `segments` turn. In a thin ring the circle
    with fewer breaks borrows the other's cuts: cut differently, the ring would gain or lose per cents of its area.
    Chords over a hole that nearly reaches their circle leave it in the material.
    """

    def __init__(self, profiles: Iterable[Profile], segments: int = 72) -> None:
        self.step = 2 * math.pi / segments
        ends: dict[int, set[float]] = defaultdict(set)
        partners: dict[int, set[int]] = defaultdict(set)
        steps: dict[int, float] = {}
        for profile in profiles:
            arcs = _arc_ends(profile)
            for radius, angles in arcs.items():
                ends[radius] |= angles
                if any(len(loop) > 2 for loop in profile.loops):  # a plain ring is cut alike anyway
                    corners = [max(math.hypot(x, y) for x, y, _ in hole) / _RADIUS_GRID for hole in profile.holes]
                    under = max((r for r in corners if r < radius - 1), default=0.0)
                    steps[radius] = min(steps.get(radius, self.step), _fine_step(radius, under, 0.25))
                    partners[radius] |= {other for other in arcs if other != radius and abs(other / radius - 1) < _THIN}
        breaks = {radius: _distinct(angles) for radius, angles in ends.items()}
        self._cuts: dict[int, list[float]] = {}
        for radius in sorted(breaks, key=lambda r: (-len(breaks[r]), r)):
            neighbours = [cut for other in partners[radius] for cut in self._cuts.get(other, ())]
            step = min([steps.get(radius, self.step), *(_fine_step(radius, other) for other in partners[radius])])
            self._cuts[radius] = _divided(self._merged(breaks[radius], neighbours), step)

    def _merged(self, first: Iterable[float], others: Iterable[float]) -> list[float]:
        """All own breaks, and those of others that do not nearly coincide with one already there."""
        around = sorted((b % (2 * math.pi), b) for b in first)
        for angle in sorted(others):
            at = bisect(around, (angle % (2 * math.pi), angle))
            beside = (around[at - 1][1], around[at % len(around)][1])  # of hundreds only the two neighbours may be near
            if min(abs((angle - b + math.pi) % (2 * math.pi) - math.pi) for b in beside) > 0.05 * self.step:
                around.insert(at, (angle % (2 * math.pi), angle))
        return sorted(b for _, b in around)

    def facet(self, loop: Loop) -> list[tuple[float, float]]:
        """Corner points of the faceted loop (m)."""
        points: list[tuple[float, float]] = []
        for (x, y, _), arc in edges(loop):
            points.append((x, y))
            if arc is not None:
                points += [arc.at(angle) for angle in self._inner_angles(arc)]
        return points

    def _inner_angles(self, arc: Arc) -> list[float]:
        if not arc.concentric:
            pieces = max(2, math.ceil(abs(arc.sweep) / self.step - 1e-6))
            return [arc.start + arc.sweep * i / pieces for i in range(1, pieces)]
        sign, cuts = math.copysign(1.0, arc.sweep), self._cuts[_radius_key(arc.radius)]
        away = (sign * (np.array(cuts) - arc.start)) % (2 * math.pi)
        near = np.flatnonzero(away < abs(arc.sweep) + 1e-9)  # of hundreds of cuts only those on the arc are looked at
        offsets = (_wrap(sign * (cuts[k] - arc.start)) for k in near)
        inside = sorted(offset for offset in offsets if 1e-7 < offset < abs(arc.sweep) - 1e-7)
        return [arc.start + sign * offset for offset in inside]


def edges(loop: Loop) -> Iterator[tuple[Vertex, Arc | None]]:
    """Each vertex of the loop with the arc that leaves it (None for a straight edge)."""
    for vertex, following in zip(loop, (*loop[1:], loop[0])):
        yield vertex, arc_between(vertex, following) if vertex[2] else None


def arc_between(a: Vertex, b: Vertex) -> Arc:
    """The arc from a to b with a's bulge."""
    bulge = a[2]
    dx, dy = b[0] - a[0], b[1] - a[1]
    offset = (1 - bulge**2) / (4 * bulge)
    x, y = (a[0] + b[0]) / 2 - offset * dy, (a[1] + b[1]) / 2 + offset * dx
    return Arc(x, y, math.hypot(a[0] - x, a[1] - y), math.atan2(a[1] - y, a[0] - x), 4 * math.atan(bulge))


def loop_area(loop: Loop) -> float:
    """Signed area (m2), positive anticlockwise: the shoelace sum plus one circular segment per arc."""
    area = 0.0
    for (vertex, arc), following in zip(edges(loop), (*loop[1:], loop[0])):
        area += (vertex[0] * following[1] - following[0] * vertex[1]) / 2
        if arc is not None:
            area += arc.radius**2 * (arc.sweep - math.sin(arc.sweep)) / 2
    return area


def loop_length(loop: Loop) -> float:
    """Length of a closed loop (m), arcs included."""
    pieces = zip(edges(loop), (*loop[1:], loop[0]))
    return sum(math.dist(v[:2], w[:2]) if arc is None else arc.radius * abs(arc.sweep) for (v, arc), w in pieces)


def _arc_ends(profile: Profile) -> dict[int, set[float]]:
    """Angles (rad) at which concentric arcs of the profile begin or end, by radius key."""
    ends: dict[int, set[float]] = defaultdict(set)
    for loop in profile.loops:
        for _, arc in edges(loop):
            if arc is not None and arc.concentric:
                ends[_radius_key(arc.radius)].update((_wrap(arc.start), _wrap(arc.start + arc.sweep)))
    return ends


def _distinct(angles: Iterable[float]) -> list[float]:
    """Angles (rad) in order, of those that are one the first."""
    out: list[float] = []
    for angle in sorted(angles):
        if not out or (angle - out[-1] > _SAME and out[0] + 2 * math.pi - angle > _SAME):
            out.append(angle)
    return out


def _divided(breaks: list[float], step: float) -> list[float]:
    """Angles that cut every piece between neighbouring breaks evenly into steps (rad) or less."""
    cuts: list[float] = []
    for here, following in zip(breaks, [*breaks[1:], breaks[0] + 2 * math.pi]):
        pieces = max(1, math.ceil((following - here) / step - 1e-6))
        cuts += [here + (following - here) * i / pieces for i in range(pieces)]
    return cuts


def _fine_step(radius: float, other: float, share: float = 0.1) -> float:
    """Step (rad) at which a chord's height over its arc is a share of the layer between two radii."""
    return 2 * math.sqrt(2 * share * abs(other - radius) / radius)


def _turned(loop: Loop, angle: float) -> Loop:
    c, s = math.cos(angle), math.sin(angle)
    return tuple((c * x - s * y, s * x + c * y, bulge) for x, y, bulge in loop)


def _scaled(loop: Loop, factor: float) -> Loop:
    return tuple((x * factor, y * factor, bulge) for x, y, bulge in loop)


def _wrap(angle: float) -> float:
    """Into [0, 2 pi), with angles within rounding of a full turn sent to 0."""
    wrapped = round(angle % (2 * math.pi), 12)
    return 0.0 if wrapped >= round(2 * math.pi, 12) else wrapped


def _radius_key(radius: float) -> int:
    return round(radius / _RADIUS_GRID)
