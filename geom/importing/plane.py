"""Shapes in the plane as complex numbers: x along the middle of a slot or pole, bulges where an edge is an arc."""

import cmath
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from geom.description.outlines import NOTHING
from geom.description.profile import ArcGrid, Loop, Profile, Vertex

Point = tuple[complex, float]  # m, and the bulge of the edge that leaves it
Sizes = Mapping[str, float]  # m or rad, by the letters of the program's own drawings
_SAME = 1e-9  # m; points nearer than this are one
_FACETS = 120  # chords of a full turn where two shapes become one


@dataclass(frozen=True)
class Place:
    """Where a shape is drawn: radius of the surface (m), +1 outwards or -1 inwards of it, half the pitch (rad)."""

    radius: float
    way: int
    half: float

    def on_surface(self, width: float) -> complex:
        """The point of the surface half this width (m) above the middle."""
        return self.radius * cmath.exp(1j * math.asin(width / 2 / self.radius))

    def from_tooth(self, point: complex) -> complex:
        """A point as drawn from the middle of the next tooth, above it, as seen from the middle of the slot."""
        return point.conjugate() * cmath.exp(1j * self.half)

    def beside_tooth(self, x: float, width: float) -> complex:
        """The point at this abscissa (m) on the flank of a tooth of this width (m)."""
        return x + 1j * (x * math.sin(self.half) - width / 2) / math.cos(self.half)


@dataclass(frozen=True)
class Slot:
    """Half an outline above the middle, from the surface to the bottom, and what fills it.

    bottom : bulge of the edge across the middle, from below;  first : of the corners, where the filling begins
    round_lid : it ends there in a circle around the axis, else in a straight line;  filling : loops of its own, if any
    """

    half: Sequence[Point]
    bottom: float
    first: int
    round_lid: bool = False
    filling: tuple[Loop, ...] = ()

    @property
    def path(self) -> Loop:
        """From the surface below the middle to the surface above it."""
        return _whole(self.half, self.bottom)

    @property
    def filled(self) -> tuple[Loop, ...]:
        """Closed loops of what lies in it."""
        if self.filling:
            return self.filling
        part = self.half[self.first :]
        lid = arc(part[0][0], part[0][0].conjugate()) if self.round_lid else 0.0
        path = _whole(part, self.bottom)
        return (loop_through([(complex(x, y), b) for x, y, b in path[:-1]] + [(complex(*path[-1][:2]), lid)]),)


def _whole(half: Sequence[Point], bottom: float) -> Loop:
    below = [(z.conjugate(), -b) for z, b in half[:-1]] + [(half[-1][0].conjugate(), bottom)]
    above = [(half[-1][0], -half[-2][1] if len(half) > 1 else 0.0)]
    above += [(half[k][0], -half[k - 1][1] if k else 0.0) for k in range(len(half) - 2, -1, -1)]
    return tuple(vertices(below + above))


def vertices(points: Sequence[Point]) -> list[Vertex]:
    """Without edges that have no length."""
    corners = [p for p, q in pairwise(points) if abs(p[0] - q[0]) > _SAME] + [points[-1]]
    return [(z.real, z.imag, b) for z, b in corners]


def loop_through(points: Sequence[Point | complex]) -> Loop:
    """A closed loop of points, where an edge is an arc with its bulge."""
    pairs = [p if isinstance(p, tuple) else (p, 0.0) for p in points]
    out = vertices(pairs)
    return tuple(out[:-1] if len(out) > 1 and math.dist(out[-1][:2], out[0][:2]) < _SAME else out)


def arc(a: complex, b: complex, centre: complex = 0.0) -> float:
    """Bulge of the shorter arc from a to b around a centre."""
    return math.tan(cmath.phase((b - centre) / (a - centre)) / 4) if abs(a - b) > _SAME else 0.0


def mirror(loop: Loop) -> Loop:
    """On the other side of the middle, anticlockwise again."""
    back = list(reversed(loop))
    return tuple((x, -y, following[2]) for (x, y, _), following in zip(back, [*back[1:], back[0]]))


def rotate(loop: Loop, angle: float) -> Loop:
    return Profile(loop).rotated(angle).outer


def crossing(a: complex, b: complex, c: complex, d: complex) -> complex:
    """Where the line through a and b meets the one through c and d."""
    r, s = b - a, d - c
    return a + r * ((c - a).conjugate() * s).imag / (r.conjugate() * s).imag


def on_circle(a: complex, b: complex, radius: float) -> list[complex]:
    """Where the line through a and b meets a circle around the axis, [] where it does not."""
    way = (b - a) / abs(b - a)
    along = -(a.conjugate() * way).real
    rest = radius**2 - abs(a + along * way) ** 2
    return [] if rest < 0 else [a + (along + sign * math.sqrt(rest)) * way for sign in (1, -1)]


def unite(loops: Sequence[Loop]) -> list[Loop]:
    """Loops that touch as one; a loop that stands alone keeps its arcs."""
    import shapely

    loops = [loop for loop in loops if Profile(loop).area > NOTHING]
    grid = ArcGrid([Profile(loop) for loop in loops], _FACETS)
    shapes = [shapely.Polygon(grid.facet(loop)).buffer(0) for loop in loops]
    close = [[j for j, other in enumerate(shapes) if shape.distance(other) < 1e-7] for shape in shapes]
    alone = [loop for loop, near in zip(loops, close) if len(near) == 1]
    near = [shape for shape, others in zip(shapes, close) if len(others) > 1]
    union = shapely.union_all(near, grid_size=1e-9).simplify(1e-8)
    pieces = [piece for piece in shapely.get_parts(union) if not piece.is_empty]
    return [*alone, *(tuple((x, y, 0.0) for x, y in piece.exterior.coords[:-1]) for piece in pieces)]
