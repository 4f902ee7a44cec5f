"""Triangles of the plane partition: borders divided once, then each face on its own.

Netgen was measured first: it refines isotropically into 0.3 mm liners and needs ten times the points.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray

from geom.arrays import Array, Ints
from geom.limits import MESH_POINTS
from geom.meshing.blocks import Column
from geom.meshing.delaunay import interior_points, nudged, triangulate_face
from geom.meshing.partition import GRID, half_edges

_SLENDER = 15.0  # perimeter^2 / (4 area) beyond which a face is a layer: one element across is enough


@dataclass(frozen=True)
class Triangulation:
    """points : (n_point, 2) (m); triangles : for each column (n_triangle, 3) point numbers, anticlockwise.

    Columns over one another may be cut differently; beside one another they share the points of their border.
    """

    points: Array
    triangles: tuple[Ints, ...]


def triangulate(
    columns: Sequence[Column], size: float, across: float = 2, finer: Mapping[int, int] | None = None
) -> Triangulation:
    """Mesh the base of every column with triangles of about `size` (m) or smaller.

    across : wanted number of elements over the width of a compact face, such as the winding in a slot
    finer : label of a part -> how often the size in its columns is halved
    """
    faces = np.array([column.face for column in columns], dtype=object)
    halved = [max((finer or {}).get(label, 0) for label in column.labels) for column in columns]
    sizes = _sizes(faces, size, across) * 0.5 ** np.array(halved)
    least = np.sum(shapely.area(faces) / sizes**2 + 0.5 * shapely.length(faces) / sizes)  # points of its triangles
    MESH_POINTS.check(least, "mesh", "would have at least")
    corners, (start, end, owner) = half_edges(faces)
    edges, which = np.unique(np.sort(np.column_stack([start, end]), axis=1), axis=0, return_inverse=True)
    limit = np.full(len(edges), np.inf)
    np.minimum.at(limit, which, sizes[owner])
    points, inner = _divided(corners, edges, limit)
    blocks = []
    for index, rings in enumerate(_borders(faces, corners, edges, inner)):
        triangles, points = _mesh_face(points, faces[index], rings, sizes[index])
        blocks.append(triangles)
    return Triangulation(points, tuple(blocks))


def _sizes(faces: NDArray[np.object_], size: float, across: float) -> Array:
    area, perimeter = shapely.area(faces), shapely.length(faces)
    width = 1.3 * 2 * area / perimeter
    return np.where(perimeter**2 / (4 * area) < _SLENDER, np.minimum(size, width / across), size)


def _divided(points: Array, edges: Ints, size: Array) -> tuple[Array, list[Ints]]:
    """All points after dividing each edge evenly, and the new point numbers along each edge."""
    start, end = points[edges[:, 0]], points[edges[:, 1]]
    pieces = np.maximum(1, np.ceil(np.linalg.norm(end - start, axis=1) / size - 0.2)).astype(int)
    first = len(points) + np.concatenate([[0], np.cumsum(pieces - 1)])
    inner = [np.arange(a, b) for a, b in pairwise(first)]
    share = np.concatenate([np.arange(1, n) / n for n in pieces])
    owner = np.repeat(np.arange(len(edges)), pieces - 1)
    return np.vstack([points, start[owner] + share[:, None] * (end - start)[owner]]), inner


def _borders(faces: NDArray[np.object_], points: Array, edges: Ints, inner: list[Ints]) -> Iterable[list[Ints]]:
    """For each face its rings as point numbers, division points included."""
    number = {key: i for i, key in enumerate(map(tuple, np.round(points / GRID).astype(np.int64).tolist()))}
    along = {(a, b): inner[i] for i, (a, b) in enumerate(edges.tolist())}
    for face in faces:
        rings = []
        for ring in shapely.get_rings(face):
            keys = np.round(shapely.get_coordinates(ring) / GRID).astype(np.int64).tolist()
            corners = [number[x, y] for x, y in keys]
            steps = [[a, *(along[a, b] if a < b else along[b, a][::-1])] for a, b in pairwise(corners)]
            rings.append(np.concatenate(steps).astype(np.int64))
        yield rings


def _mesh_face(points: Array, face: shapely.Polygon, rings: list[Ints], size: float) -> tuple[Ints, Array]:
    """Triangles of one face in global point numbers, and the points with those inside the face added."""
    corners, interior = np.unique(np.concatenate(rings)), interior_points(face, size)
    outline = [nudged(points[ring]) for ring in rings]
    local = np.vstack([points[corners], interior])
    for ring, positions in zip(rings, outline):
        local[np.searchsorted(corners, ring)] = positions
    border = np.vstack([np.column_stack([ring, np.roll(ring, -1)]) for ring in rings])
    polygon = shapely.Polygon(outline[0], outline[1:])
    triangles = triangulate_face(local, np.searchsorted(corners, border), polygon)
    number = np.concatenate([corners, len(points) + np.arange(len(interior))])
    return number[triangles], np.vstack([points, interior])
