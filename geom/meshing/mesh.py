"""The named tetrahedral mesh: what `geom` hands to `fem`, and nothing else."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

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
