"""Triangles of the plane partition: borders divided once, then each face on its own.

Netgen was measured first: it refines isotropically into 0.3 mm liners and needs ten times the points.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from geom.delaunay import interior_points, triangulate_face
from geom.partition import AMBIENT, GRID, Partition, half_edges

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
_SLENDER = 15.0  # perimeter^2 / (4 area) beyond which a face is a layer: one element across is enough


@dataclass(frozen=True)
class Triangulation:
    """Triangles of every face that is solid somewhere along the axis.

    points : (n_point, 2) (m); triangles : (n_triangle, 3) anticlockwise
    labels : (n_triangle, n_slab) what fills the prism over each triangle, as in Partition.labels
    sides : (n_edge, 2) point numbers, lower first
    left, right : (n_edge, n_slab) labels on either side
    """

    points: Floats
    triangles: Ints
    labels: Ints
    sides: Ints
    left: Ints
    right: Ints


def triangulate(cut: Partition, size: float, across: int = 2) -> Triangulation:
    """Mesh the partition with triangles of about `size` (m) or smaller.

    across : wanted number of elements over the width of a compact face, such as the winding in a slot
    """
    faces, labels = _dissolved(cut)
    sizes = _sizes(faces, size, across)
    keys, edges, left, right = half_edges(faces)
    limit = np.append(sizes, np.inf)
    points, inner = _divided(keys, edges, np.minimum(limit[left], limit[right]))
    blocks, owners = [], []
    for index, (face, border) in enumerate(zip(faces, _borders(faces, keys, edges, inner))):
        triangles, points = _mesh_face(points, face, border, sizes[index])
        blocks.append(triangles)
        owners.append(np.full(len(triangles), index))
    return _with_sides(cut, points, np.concatenate(blocks), labels[np.concatenate(owners)])


def _dissolved(cut: Partition) -> tuple[NDArray[np.object_], Ints]:
    """Faces with something solid above them, those with the same fill at every level merged."""
    columns, which = np.unique(cut.labels, axis=0, return_inverse=True)
    is_solid = np.array([part.solid for part in cut.parts] + [False])
    faces, labels = [], []
    for index in np.flatnonzero(is_solid[columns].any(axis=1)):
        pieces = shapely.get_parts(shapely.coverage_union_all(cut.faces[which == index]))
        faces += list(shapely.orient_polygons(pieces))
        labels += [columns[index]] * len(pieces)
    return np.array(faces, dtype=object), np.array(labels)


def _sizes(faces: NDArray[np.object_], size: float, across: int) -> Floats:
    area, perimeter = shapely.area(faces), shapely.length(faces)
    width = 1.3 * 2 * area / perimeter
    return np.where(perimeter**2 / (4 * area) < _SLENDER, np.minimum(size, width / across), size)


def _divided(points: Floats, edges: Ints, size: Floats) -> tuple[Floats, list[Ints]]:
    """All points after dividing each edge evenly, and the new point numbers along each edge."""
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    pieces = np.maximum(1, np.ceil(np.linalg.norm(end - start, axis=1) / size - 0.2)).astype(int)
    first = len(points) + np.concatenate([[0], np.cumsum(pieces - 1)])
    inner = [np.arange(a, b) for a, b in zip(first, first[1:])]
    share = np.concatenate([np.arange(1, n) / n for n in pieces])
    owner = np.repeat(np.arange(len(edges)), pieces - 1)
    return np.vstack([points, start[owner] + share[:, None] * (end - start)[owner]]), inner


def _borders(faces: NDArray[np.object_], points: Floats, edges: Ints, inner: list[Ints]) -> Iterable[list[Ints]]:
    """For each face its rings as point numbers, division points included."""
    number = {key: i for i, key in enumerate(map(tuple, np.round(points / GRID).astype(np.int64).tolist()))}
    along = {(a, b): inner[i] for i, (a, b) in enumerate(edges.tolist())}
    for face in faces:
        rings = []
        for ring in shapely.get_rings(face):
            corners = [number[key] for key in map(tuple, np.round(shapely.get_coordinates(ring) / GRID).astype(np.int64).tolist())]
            steps = [[a, *(along[a, b] if a < b else along[b, a][::-1])] for a, b in zip(corners, corners[1:])]
            rings.append(np.concatenate(steps).astype(np.int64))
        yield rings


def _mesh_face(points: Floats, face: shapely.Polygon, rings: list[Ints], size: float) -> tuple[Ints, Floats]:
    """Triangles of one face in global point numbers, and the points with those inside the face added."""
    corners, added = np.unique(np.concatenate(rings)), interior_points(face, size)
    local = np.vstack([points[corners], added])
    border = np.vstack([np.column_stack([ring, np.roll(ring, -1)]) for ring in rings])
    outline = shapely.Polygon(points[rings[0]], [points[ring] for ring in rings[1:]])
    triangles = triangulate_face(local, np.searchsorted(corners, border), outline)
    number = np.concatenate([corners, len(points) + np.arange(len(added))])
    return number[triangles], np.vstack([points, added])


def _with_sides(cut: Partition, points: Floats, triangles: Ints, labels: Ints) -> Triangulation:
    start, end = triangles.ravel(), triangles[:, [1, 2, 0]].ravel()
    owner = np.repeat(np.arange(len(triangles)), 3)
    ends = np.sort(np.column_stack([start, end]), axis=1)
    key, which = np.unique(ends @ [len(points), 1], return_inverse=True)
    sides = np.column_stack([key // len(points), key % len(points)])
    beside = np.full((2, len(sides)), -1)
    beside[np.where(start < end, 0, 1), which] = owner
    left, right = (np.where((b >= 0)[:, None], labels[b], AMBIENT) for b in beside)
    for sign, b, found in ((1, beside[0], left), (-1, beside[1], right)):
        found[b < 0] = _labels_beside(cut, points[sides[b < 0]], sign)
    return Triangulation(points, triangles, labels, sides, left, right)


def _labels_beside(cut: Partition, ends: Floats, sign: int) -> Ints:
    """Labels of the faces just left (sign 1) or right (-1) of each segment (n, 2, 2)."""
    along = ends[:, 1] - ends[:, 0]
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    points = shapely.points(ends.mean(axis=1) + sign * 2e-6 * normal)
    labels = np.full((len(points), cut.labels.shape[1]), AMBIENT)
    index, face = shapely.STRtree(cut.faces).query(points, predicate="intersects")
    labels[index] = cut.labels[face]
    return labels
