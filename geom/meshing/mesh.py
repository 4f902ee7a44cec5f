"""The named tetrahedral mesh: what `geom` hands to `fem`, and nothing else."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from geom.arrays import Array, Ints
from geom.description.roles import Identity


@dataclass(frozen=True)
class Patch:
    """Where a part touches a fluid: a named piece of outer surface.

    part, fluid : their names
    facets : (n, 3) point numbers of the triangles
    """

    part: str
    fluid: str
    facets: Ints


@dataclass(frozen=True)
class Contact:
    """Where two parts touch: `facets` (n, 3) are shared by a tetrahedron of each."""

    a: str
    b: str
    facets: Ints


@dataclass(frozen=True)
class NamedMesh:
    """A conformal tetrahedral mesh in which every region and every face has a name.

    points : (n_points, 3) coordinates (m); z is the machine's axis
    tets : (n_tets, 4) point numbers, positively oriented
    region : (n_tets,) index into `parts`
    parts : names of the solid parts
    patches : name of face -> Patch, e.g. "flange.right.outer"
    contacts : "a|b" (names in alphabetical order) -> Contact
    identities : what the parts are, where it is declared
    """

    points: Array
    tets: Ints
    region: Ints
    parts: tuple[str, ...]
    patches: Mapping[str, Patch] = field(default_factory=dict)
    contacts: Mapping[str, Contact] = field(default_factory=dict)
    identities: Mapping[str, Identity] = field(default_factory=dict)

    def __repr__(self) -> str:
        return f"<NamedMesh of {', '.join(self.parts)}: {len(self.points)} points, {len(self.tets)} tetrahedra>"


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
