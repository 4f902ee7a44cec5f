"""Constrained Delaunay triangulation of one face with given boundary points."""

import numpy as np
import shapely
from scipy.spatial import Delaunay

from geom.arrays import Array, Ints

_STRAIGHT = 1e-4  # rad; a border that turns by less goes straight on
_FLAT = 1e-15  # of a point's distance from the axis: what rounding leaves of three points in a line
_NUDGE = 1e-6  # of the length of a straight border: far below any tolerance, far above rounding


def interior_points(face: shapely.Polygon, size: float) -> Array:
    """A triangular grid of points (n, 2) inside the face, aligned with its longer side and centred in it.

    size : distance between points (m); none lies nearer to the border than 0.45 size
    """
    room = shapely.buffer(face, -0.45 * size)
    if room.is_empty:
        return np.empty((0, 2))
    centre = shapely.get_coordinates(shapely.maximum_inscribed_circle(face, tolerance=0.02 * size))[0]
    corners = shapely.get_coordinates(shapely.minimum_rotated_rectangle(face))
    sides = np.diff(corners[:3], axis=0)
    along = max(sides, key=np.linalg.norm)
    along = along / np.linalg.norm(along)
    reach = np.linalg.norm(corners[2] - corners[0])
    n = int(reach / size) + 2
    i, j = np.meshgrid(np.arange(-n, n + 1), np.arange(-n, n + 1))
    rows = np.column_stack([(i + 0.5 * (j % 2)).ravel() * size, (j * np.sqrt(0.75)).ravel() * size])
    grid = centre + rows @ np.array([along, [-along[1], along[0]]])
    return grid[shapely.contains_xy(room, grid)]


def nudged(ring: Array) -> Array:
    """The ring (n, 2), face on its left, with points on straight stretches moved a hair into the face.

    Three points exactly in a line come out of a Delaunay triangulation as a triangle now and then. On a
    slightly concave border they do so only outside the face.
    """
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    turn = np.abs(_cross(before, after)) / (np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1))
    corners = np.flatnonzero(turn > _STRAIGHT)
    points = ring.copy()
    for a, b in zip(corners, [*corners[1:], corners[0] + len(ring)]):
        between = np.arange(a + 1, b) % len(ring)
        along = ring[b % len(ring)] - ring[a]
        share = (ring[between] - ring[a]) @ along / (along @ along)
        points[between] += (_NUDGE * 4 * share * (1 - share))[:, None] * np.array([-along[1], along[0]])
    return points


def triangulate_face(points: Array, border: Ints, face: shapely.Polygon) -> Ints:
    """Triangles (n, 3), anticlockwise, of the face whose border edges (m, 2) all appear.

    points : (n, 2) corners first, interior points after, no three on the border in a line.
    Falls back to the border points alone if rounding spoils the Delaunay triangulation.
    """
    triangles = _oriented(points, Delaunay(points * 1e3).simplices.astype(np.int64))
    for a, b in _missing(triangles, border):
        triangles = _force_edge(points, triangles, int(a), int(b))
    triangles = triangles[shapely.contains_xy(face, points[triangles].mean(axis=1))]
    doubled = _doubled_area(points, triangles)
    complete = abs(doubled.sum() / 2 / face.area - 1) < 1e-9
    flat = doubled.min() < _FLAT * np.abs(points).max() * face.area**0.5
    if complete and not flat and not len(_missing(triangles, border)):
        return triangles
    # Constrained Delaunay triangles between border points only (GEOS, robust)
    corners = shapely.get_coordinates(shapely.get_parts(shapely.constrained_delaunay_triangles(face)))
    tree = shapely.STRtree(shapely.points(points))
    number = tree.nearest(shapely.points(corners)).reshape(-1, 4)[:, :3]
    return _oriented(points, number)


def _oriented(points: Array, triangles: Ints) -> Ints:
    flip = _doubled_area(points, triangles) < 0
    triangles[flip] = triangles[flip][:, ::-1]
    return triangles


def _doubled_area(points: Array, triangles: Ints) -> Array:
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return _cross(b - a, c - a)


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _missing(triangles: Ints, border: Ints) -> Ints:
    sides = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    scale = max(int(sides.max()), int(border.max())) + 1
    have = np.sort(sides, axis=1) @ [scale, 1]
    return border[~np.isin(np.sort(border, axis=1) @ [scale, 1], have)]


def _force_edge(points: Array, triangles: Ints, a: int, b: int) -> Ints:
    """Retriangulate the triangles that the segment a-b crosses (Anglada 1997)."""
    start, end = points[a], points[b]
    sides = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    u, v = points[sides[:, 0]], points[sides[:, 1]]
    opposite = _cross(end - start, u - start) * _cross(end - start, v - start) < 0
    across = _cross(v - u, start - u) * _cross(v - u, end - u) < 0
    crossing = opposite & across & ~np.isin(sides, [a, b]).any(axis=1)
    crossed = np.unique(np.flatnonzero(crossing) // 3)
    if not len(crossed):
        return triangles
    edges = sides[crossing]
    side = _cross(end - start, points[edges] - start)
    where = side[:, 0] / (side[:, 0] - side[:, 1])
    hit = points[edges[:, 0]] + where[:, None] * (points[edges[:, 1]] - points[edges[:, 0]])
    order = np.argsort((hit - start) @ (end - start), kind="stable")
    edges, side = edges[order], side[order]
    left = _chain(edges[side > 0])
    right = _chain(edges[side < 0])
    new = [*_fill(points, left, a, b), *_fill(points, right[::-1], b, a)]
    return np.vstack([np.delete(triangles, crossed, axis=0), np.array(new, dtype=np.int64)])


def _chain(corners: Ints) -> list[int]:
    return [int(c) for c, before in zip(corners, [-1, *corners[:-1]]) if c != before]


def _fill(points: Array, chain: list[int], a: int, b: int) -> list[tuple[int, int, int]]:
    """Delaunay triangles of the pseudo-polygon left of a-b whose other corners are `chain`, from a to b."""
    if not chain:
        return []
    best = 0
    for i in range(1, len(chain)):
        if _in_circle(points, a, b, chain[best], chain[i]):
            best = i
    c = chain[best]
    return [*_fill(points, chain[:best], a, c), *_fill(points, chain[best + 1 :], c, b), (a, b, c)]


def _in_circle(points: Array, a: int, b: int, c: int, d: int) -> bool:
    rows = points[[a, b, c]] - points[d]
    return bool(np.linalg.det(np.column_stack([rows, (rows**2).sum(axis=1)])) > 0)
