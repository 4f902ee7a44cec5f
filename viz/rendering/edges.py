"""The lines that make a surface readable: sharp edges, and the edges of every part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from viz.rendering.cut import Surface

Index = NDArray[np.int64]


def feature_edges(surface: Surface, angle: float = 35.0) -> Index:
    """(n, 2) point numbers of edges with one triangle, or whose two triangles meet at over `angle` degrees."""
    a, b, c = surface.points[surface.triangles].transpose(1, 0, 2)
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    edges = np.sort(surface.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    face = np.repeat(np.arange(len(surface.triangles)), 3)
    order = np.lexsort(edges.T)
    edges, face = edges[order], face[order]
    first = np.flatnonzero(np.concatenate([[True], (edges[1:] != edges[:-1]).any(axis=1)]))
    count = np.diff(np.append(first, len(edges)))
    two = first[count == 2]
    sharp = (normal[face[two]] * normal[face[two + 1]]).sum(axis=1) < np.cos(np.deg2rad(angle))
    return edges[np.sort(np.concatenate([first[count == 1], two[sharp]]))]


def outline_strips(surface: Surface, angle: float = 35.0) -> NDArray[np.float64]:
    """(n, 2, 3) m: start and end of every feature edge."""
    return surface.points[feature_edges(surface, angle)]
