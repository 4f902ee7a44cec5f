"""Measures of a named mesh."""

import numpy as np


def tet_volumes(mesh):
    a, b, c, d = (mesh.points[mesh.tets[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def area(mesh, facets):
    a, b, c = (mesh.points[facets[:, i]] for i in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def keys(mesh, facets):
    """One whole number per triangle, whatever the order of its corners."""
    return np.sort(facets, axis=1) @ np.array([len(mesh.points) ** 2, len(mesh.points), 1])


def facets_of_tets(mesh):
    """Keys of all tetrahedra's facets and the region each belongs to."""
    corners = ([0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3])
    return np.concatenate([keys(mesh, mesh.tets[:, c]) for c in corners]), np.tile(mesh.region, 4)
