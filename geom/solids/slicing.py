"""Solids from elsewhere, sliced along the axis into prisms; refused where they are not prismatic."""

from __future__ import annotations

import math
from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np

from geom.description.part import Prism
from geom.description.profile import Loop, Profile, Vertex, edges, loop_area
from geom.errors import InputError

if TYPE_CHECKING:
    import cadquery as cq

Piece = tuple[np.ndarray, np.ndarray, float]  # start (2,), end (2,) in m and bulge of one edge of a section
_LEVEL = 1e-4  # mm; caps nearer than this lie in one plane
_JOIN = 1e-6  # m; ends of edges nearer than this are one
_ON_AXIS = 1e-6  # m; an arc whose centre is nearer to the axis is meant to be concentric with the machine
_TILT = 1e-5  # rad; a face tilted by less against the axis is a wall, by less against the plane, a cap
_SHARES = (0.07, 0.31, 0.52, 0.77, 0.94)  # of a face's extent, where its normal is looked at
_VOLUME = 2e-3  # relative difference between a solid and its prisms that chords of free-form walls explain
_CHORDS = 96  # per edge that is neither straight nor a circle


def sliced(solid: cq.Solid, name: str) -> tuple[Prism, ...]:
    """The prisms (m) of a solid (mm), one per connected section between two neighbouring caps.

    Raises InputError, naming the solid, the face and where it lies, if a face neither contains the axis' direction
    nor is normal to it.
    """
    levels = _levels(solid, name)
    prisms = [
        (profile, round(z0 * 1e-3, 9), round(z1 * 1e-3, 9))
        for z0, z1 in pairwise(levels)
        for profile in _section(solid, (z0 + z1) / 2, name)
    ]
    volume, exact = sum(profile.area * (z1 - z0) for profile, z0, z1 in prisms), solid.Volume() * 1e-9
    if abs(volume / exact - 1) > _VOLUME:
        raise InputError(f"its prisms have {volume / exact:.4f} of its volume", name, "a valid, closed solid")
    return tuple(prisms)


def _levels(solid: cq.Solid, name: str) -> list[float]:
    """Axial positions (mm) of all caps; InputError for a face that is neither cap nor wall."""
    levels: list[float] = []
    for face in solid.Faces():
        cosines = np.abs(_normals_z(face))
        if np.sqrt(1 - cosines.min() ** 2) < _TILT:
            levels.append(face.Center().z)
        elif cosines.max() > _TILT:
            box = face.BoundingBox()
            what = f"a {face.geomType().lower()} face from z = {box.zmin:.4g} to {box.zmax:.4g} mm"
            right = "faces must lie along z or normal to it: simplify the solid or leave it out"
            raise InputError(f"{what} is not prismatic along the axis", name, right)
    levels.sort()
    return [z for i, z in enumerate(levels) if i == 0 or z - levels[i - 1] > _LEVEL]


def _normals_z(face: cq.Face) -> np.ndarray:
    """z of the unit normal at a few points of the face."""
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.gp import gp_Pnt, gp_Vec

    adaptor = BRepAdaptor_Surface(face.wrapped)
    u0, u1, v0, v1 = face._uvBounds()
    normals = []
    for i, j in product(_SHARES, _SHARES):
        point, du, dv = gp_Pnt(), gp_Vec(), gp_Vec()
        adaptor.D1(u0 + i * (u1 - u0), v0 + j * (v1 - v0), point, du, dv)
        normal = du.Crossed(dv)
        normals.append(normal.Z() / max(normal.Magnitude(), 1e-300))
    return np.clip(normals, -1.0, 1.0)


def _section(solid: cq.Solid, z: float, name: str) -> list[Profile]:
    """Profiles (m) of the solid at height z (mm)."""
    import cadquery as cq
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Section
    from OCP.gp import gp_Dir, gp_Pln, gp_Pnt

    cut = BRepAlgoAPI_Section(solid.wrapped, gp_Pln(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), False)
    cut.Build()
    pieces = [piece for edge in cq.Shape.cast(cut.Shape()).Edges() for piece in _pieces(edge)]
    loops = _chained(pieces)
    if loops is None:
        raise InputError(f"its section at z = {z:.4g} mm is not closed", name, "a valid, closed solid")
    return _nested(loops)


def _pieces(edge: cq.Edge) -> list[Piece]:
    """An edge as arcs and lines (m): a whole circle in two, other curves as chords."""
    kind = edge.geomType()
    if kind == "LINE":
        return [(_xy(edge, 0.0), _xy(edge, 1.0), 0.0)]
    if kind == "CIRCLE":
        closed = bool(edge.IsClosed())
        shares = (0.0, 0.5, 1.0) if closed else (0.0, 1.0)
        return [_arc(edge, a, b) for a, b in pairwise(shares)]
    return [(_xy(edge, i / _CHORDS), _xy(edge, (i + 1) / _CHORDS), 0.0) for i in range(_CHORDS)]


def _xy(edge: cq.Edge, share: float) -> np.ndarray:
    return np.array(edge.positionAt(share).toTuple()[:2]) * 1e-3


def _arc(edge: cq.Edge, a: float, b: float) -> Piece:
    """Part of a circular edge between two shares of its length."""
    start, middle, end = _xy(edge, a), _xy(edge, (a + b) / 2), _xy(edge, b)
    centre, radius = np.array(edge.arcCenter().toTuple()[:2]) * 1e-3, edge.radius() * 1e-3
    if np.hypot(*centre) < _ON_AXIS:
        start, middle, end = (
            np.asarray(point * (round(radius, 9) / math.hypot(*point))) for point in (start, middle, end)
        )
    along, off = end - start, middle - (start + end) / 2
    return start, end, float(2 * (along[1] * off[0] - along[0] * off[1]) / (along @ along))


def _chained(pieces: list[Piece]) -> list[Loop] | None:
    """Closed loops from edges in any order and direction; None if an end meets no other."""
    loops, left = [], list(pieces)
    while left:
        start, end, bulge = left.pop()
        first, loop = start, [_vertex(start, bulge)]
        while np.hypot(*(end - first)) > _JOIN:
            ends = np.array([[piece[0], piece[1]] for piece in left]).reshape(-1, 2) - end
            distance = np.hypot(*ends.T)
            if not left or distance.min() > _JOIN:
                return None
            index, backwards = divmod(int(distance.argmin()), 2)  # of the edge that goes on, or runs the other way
            start, other, bulge = left.pop(index)
            here, end = (other, start) if backwards else (start, other)
            loop.append(_vertex(here, -bulge if backwards else bulge))
        loops.append(tuple(loop))
    return loops


def _vertex(point: np.ndarray, bulge: float) -> Vertex:
    return float(point[0]), float(point[1]), bulge


def _nested(loops: list[Loop]) -> list[Profile]:
    """Outer loops with the holes directly inside them, all anticlockwise."""
    import shapely

    rings = [shapely.Polygon(_outline(loop)) for loop in loops]
    inner = [ring.representative_point() for ring in rings]
    around = [
        [j for j, ring in enumerate(rings) if ring.area > rings[i].area and ring.contains(point)]
        for i, point in enumerate(inner)
    ]
    profiles = []
    for i in range(len(loops)):
        holes = [j for j in range(len(loops)) if i in around[j] and len(around[j]) == len(around[i]) + 1]
        if len(around[i]) % 2 == 0:
            profiles.append(Profile(_anticlockwise(loops[i]), tuple(_anticlockwise(loops[j]) for j in holes)))
    return profiles


def _outline(loop: Loop) -> list[tuple[float, float]]:
    """Corners, and points along each arc."""
    points = []
    for (x, y, _), arc in edges(loop):
        points.append((x, y))
        if arc is not None:
            points += [arc.at(arc.start + arc.sweep * share) for share in np.linspace(0, 1, 65)[1:-1]]
    return points


def _anticlockwise(loop: Loop) -> Loop:
    if loop_area(loop) > 0:
        return loop
    vertices = [(x, y, -before[2]) for (x, y, _), before in zip(loop, (loop[-1], *loop[:-1]))]
    return tuple(reversed(vertices))
