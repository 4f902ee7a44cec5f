"""Border lines of many polygons, cut where they meet and cleaned of rounding.

Corners that should lie on another line miss it by a rounding error when the shape is turned. Snap rounding
then leaves edges and slivers of 0.1 um, which no mesh survives; they are merged here.
"""

import numpy as np
import shapely
from numpy.typing import NDArray

from geom.arrays import Array, Ints
from geom.groups import near_groups

GRID = 1e-7  # m; coordinates are snapped to this
NEAR = 2e-6  # m; points and lines nearer than this are one, far below any tolerance of a motor


def noded(lines: list[shapely.Geometry]) -> NDArray[np.object_]:
    """Segments that tile the union of the lines and meet only at their ends."""
    xy, line = shapely.get_coordinates(shapely.get_parts(shapely.union_all(lines, grid_size=GRID)), return_index=True)
    keys, number = np.unique(np.round(xy / GRID).astype(np.int64), axis=0, return_inverse=True)
    follows = line[1:] == line[:-1]
    points, edges = keys * GRID, np.column_stack([number[:-1][follows], number[1:][follows]])
    # For each point the number of the point that stands for all those near it.
    group = near_groups(points, NEAR)
    edges = _distinct(np.unique(group, return_index=True)[1][group][edges])
    edges = _distinct(_split(points, edges))
    return shapely.linestrings(points[edges])


def _distinct(edges: Ints) -> Ints:
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    return edges[edges[:, 0] != edges[:, 1]]


def _split(points: Array, edges: Ints) -> Ints:
    """Edges cut at every point that lies on them to within NEAR."""
    vertices = np.unique(edges)
    tree = shapely.STRtree(shapely.linestrings(points[edges]))
    which, edge = tree.query(shapely.points(points[vertices]), predicate="dwithin", distance=NEAR)
    point = vertices[which]
    inner = (edges[edge] != point[:, None]).all(axis=1)
    point, edge = point[inner], edge[inner]
    start, along = points[edges[:, 0]], points[edges[:, 1]] - points[edges[:, 0]]
    share = np.einsum("ij,ij->i", points[point] - start[edge], along[edge])
    order = np.lexsort((share, edge))
    point, edge = point[order], edge[order]
    pieces = [edges[np.setdiff1d(np.arange(len(edges)), edge)]]
    for index in np.unique(edge):
        chain = np.concatenate([edges[index, :1], point[edge == index], edges[index, 1:]])
        pieces.append(np.column_stack([chain[:-1], chain[1:]]))
    return np.vstack(pieces)
