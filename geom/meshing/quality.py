"""How good the elements of a mesh are, part by part."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from geom.meshing.mesh import NamedMesh


def mesh_quality(mesh: NamedMesh) -> dict[str, float]:
    """Smallest mean ratio of each part's elements: 12 (3 V)^(2/3) / sum of squared edges, 1 for a regular tetrahedron.

    Source: Liu and Joe 1994. Thin insulation in long elements is meant to be flat and says so here.
    """
    corners = mesh.points[mesh.tets]
    a, b, c, d = np.moveaxis(corners, 1, 0)
    volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
    edges = sum(((corners[:, i] - corners[:, j]) ** 2).sum(axis=1) for i, j in combinations(range(4), 2))
    ratio = 12 * np.cbrt(3 * volume) ** 2 / edges
    worst = np.full(len(mesh.parts), np.inf)
    np.minimum.at(worst, mesh.region, ratio)
    return dict(zip(mesh.parts, worst.tolist()))
