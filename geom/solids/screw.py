"""Helical channels as exact solids: cylinders, helicoids and planes, joined edge by edge.

A helix has no finite spline. A polynomial of degree `_DEGREE` over a quarter turn is off by less than 1e-13 of the
radius (Chebyshev's bound), far below the 1e-7 mm that CAD files resolve.
"""

import math
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from OCP.Geom import Geom_BezierCurve, Geom_BezierSurface, Geom_CylindricalSurface, Geom_Plane
from OCP.Geom2d import Geom2d_BSplineCurve
from OCP.gp import gp_Pnt, gp_Pnt2d
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array1OfPnt2d, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from scipy.special import binom

from geom.arrays import Array
from geom.description.part import Helix
from geom.solids.brep import Boundary, axes, line, line_2d

if TYPE_CHECKING:
    import cadquery as cq

mm = 1e3
_DEGREE = 11  # of the polynomials of a face: interpolated, a cosine over a quarter turn is off by 6e-14
_SPAN = math.pi / 2  # rad; of one face, at most


def channel(helix: Helix) -> "cq.Solid":
    """The channel (mm): a rectangle in a plane through the axis, moved as on a screw, cut by radii and end planes."""
    make = Boundary()
    cuts = [_Cut(helix, angle, make) for angle in _angles(helix)]
    spans = [_Span(here, following, make) for here, following in pairwise(cuts)]
    ends = [cuts[0].end(outward=True), cuts[-1].end(outward=False)]
    return make.solid([make.shell([*ends, *(face for span in spans for face in span.faces())])])


def _angles(helix: Helix) -> list[float]:
    """Where it is cut, from its start (rad): where an edge meets an end plane, and between."""
    end, slant = 2 * math.pi * helix.turns, 2 * math.pi * (helix.width - helix.blunt) / helix.pitch
    bends = sorted({0.0, slant, end - slant, end})
    return [
        0.0,
        *(
            a + (b - a) * i / n
            for a, b in pairwise(bends)
            for n in [math.ceil((b - a) / _SPAN)]
            for i in range(1, n + 1)
        ),
    ]


class _Cut:
    """The rectangle in a half plane through the axis; corners, "up" and "out" by side: 0 inner or lower, 1 the other.

    rotation : from the channel's start (rad);  z : lower and upper edge (mm)
    up : upright edges at either radius;  out : radial edges, lower and upper
    """

    def __init__(self, helix: Helix, rotation: float, make: Boundary) -> None:
        self.make, self.rotation, self.angle = make, rotation, helix.angle + rotation
        low = helix.bottom + helix.blunt - helix.width + helix.pitch * rotation / (2 * math.pi)
        self.z = (mm * max(helix.bottom, low), mm * min(helix.top, low + helix.width))
        self.radii = (mm * helix.inner, mm * helix.outer)
        self.corner = {(side, edge): make.vertex(self._at(side, edge)) for side in (0, 1) for edge in (0, 1)}
        self.up = [self._edge((side, 0), (side, 1)) for side in (0, 1)]
        self.out = [self._edge((0, edge), (1, edge)) for edge in (0, 1)]

    def end(self, outward: bool) -> Any:
        """The rectangle as a face; its normal points back along the channel."""
        sin, cos = math.sin(self.angle), math.cos(self.angle)
        plane = Geom_Plane(axes(self._at(0, 0), (sin, -cos, 0.0), (cos, sin, 0.0)))
        loop = [(self.out[0], True), (self.up[1], True), (self.out[1], False), (self.up[0], False)]
        return self.make.face(plane, [loop], outward)

    def _at(self, side: int, edge: int) -> tuple[float, float, float]:
        return self.radii[side] * math.cos(self.angle), self.radii[side] * math.sin(self.angle), self.z[edge]

    def _edge(self, start: tuple[int, int], end: tuple[int, int]) -> Any:
        return self.make.edge(*line(self._at(*start), self._at(*end)), self.corner[start], self.corner[end])


class _Span:
    """The channel from one cut to the next: two cylinders, and two helicoids (or end planes)."""

    def __init__(self, here: _Cut, following: _Cut, make: Boundary) -> None:
        self.here, self.next, self.make = here, following, make
        self.sweep = following.rotation - here.rotation
        self.along = {corner: self._edge(*corner) for corner in here.corner}

    def faces(self) -> list[Any]:
        return [self._cylinder(0), self._cylinder(1), self._helicoid(0), self._helicoid(1)]

    def _cylinder(self, side: int) -> Any:
        """u: angle from the first cut; v: height above its lower edge."""
        z, angle = self.here.z[0], self.here.angle
        frame = axes((0.0, 0.0, z), (0.0, 0.0, 1.0), (math.cos(angle), math.sin(angle), 0.0))
        surface = Geom_CylindricalSurface(frame, self.here.radii[side])
        low, high = (self.along[side, edge] for edge in (0, 1))
        for edge, curve in enumerate((low, high)):
            ends = ((0.0, self.here.z[edge] - z), (self.sweep, self.next.z[edge] - z))
            self.make.lay(curve, _straight_2d(*ends), surface)
        for cut, rotation in ((self.here, 0.0), (self.next, self.sweep)):
            self.make.lay(cut.up[side], line_2d(rotation, cut.z[0] - z, 0.0, 1.0), surface)
        loop = [(low, True), (self.next.up[side], True), (high, False), (self.here.up[side], False)]
        return self.make.face(surface, [loop], outward=bool(side))

    def _helicoid(self, edge: int) -> Any:
        """u: along, 0 to 1; v: out, 0 to 1; the normal points down."""
        rows = [self._poles(side, edge) for side in (0, 1)]
        poles = TColgp_Array2OfPnt(1, _DEGREE + 1, 1, 2)
        for j, row in enumerate(rows):
            for i, pole in enumerate(row.tolist()):
                poles.SetValue(i + 1, j + 1, gp_Pnt(*pole))
        surface = Geom_BezierSurface(poles)
        inner, outer = (self.along[side, edge] for side in (0, 1))
        for v, curve in enumerate((inner, outer)):
            self.make.lay(curve, line_2d(0.0, float(v), 1.0, 0.0), surface)
        wide = self.here.radii[1] - self.here.radii[0]
        for u, cut in enumerate((self.here, self.next)):
            self.make.lay(cut.out[edge], _straight_2d((float(u), 0.0), (float(u), 1.0), wide), surface)
        loop = [(inner, True), (self.next.out[edge], True), (outer, False), (self.here.out[edge], False)]
        return self.make.face(surface, [loop], outward=not edge)

    def _edge(self, side: int, edge: int) -> Any:
        poles = TColgp_Array1OfPnt(1, _DEGREE + 1)
        for i, pole in enumerate(self._poles(side, edge).tolist()):
            poles.SetValue(i + 1, gp_Pnt(*pole))
        ends = self.here.corner[side, edge], self.next.corner[side, edge]
        return self.make.edge(Geom_BezierCurve(poles), 0.0, 1.0, *ends)

    def _poles(self, side: int, edge: int) -> Array:
        """(n, 3) of the helix (mm) at a radius: x and y interpolated at Chebyshev's points, z is straight."""
        places, inverse = _collocation()
        angle = self.here.angle + self.sweep * places
        x, y = (self.here.radii[side] * inverse @ f(angle) for f in (np.cos, np.sin))
        return np.column_stack([x, y, np.linspace(self.here.z[edge], self.next.z[edge], _DEGREE + 1)])


@cache
def _collocation() -> tuple[Array, Array]:
    """Places of interpolation (0 to 1), ends included, and what turns values there into poles."""
    k = np.arange(_DEGREE + 1)
    places = (1 - np.cos(math.pi * k / _DEGREE)) / 2
    bernstein = binom(_DEGREE, k) * places[:, None] ** k * (1 - places[:, None]) ** (_DEGREE - k)
    return places, np.linalg.inv(bernstein)


def _straight_2d(start: tuple[float, float], end: tuple[float, float], last: float = 1.0) -> Any:
    """A straight line in the parameters of a surface, run through while its own goes from 0 to `last`."""
    poles, knots, times = TColgp_Array1OfPnt2d(1, 2), TColStd_Array1OfReal(1, 2), TColStd_Array1OfInteger(1, 2)
    for i, (point, knot) in enumerate(((start, 0.0), (end, last))):
        poles.SetValue(i + 1, gp_Pnt2d(*point))
        knots.SetValue(i + 1, knot)
        times.SetValue(i + 1, 2)
    return Geom2d_BSplineCurve(poles, knots, times, 1)
