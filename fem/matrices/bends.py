"""Where the temperature of a part bends: which edges of its tetrahedra are worth a middle of their own.

What is found on one mesh serves on another: an edge does as the nearest one did there, edges in the plane and others
apart. So it needs no more than points.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from fem.matrices.elements import Midsides
from geom.arrays import Array as Floats

Bools = NDArray[np.bool_]


def edge_table(a: Floats, b: Floats) -> Floats:
    """(n, 6) of edges from a to b (n, 3): middle (m), whether it lies in the plane, and there twice its angle as a
    vector of the edge's length (m); 0 along the axis."""
    step = b - a
    length = np.linalg.norm(step, axis=1)
    level = np.abs(step[:, 2]) < 0.5 * length
    angle = 2.0 * np.arctan2(step[:, 1], step[:, 0])
    return np.column_stack([(a + b) / 2, level, level * length * np.cos(angle), level * length * np.sin(angle)])


@dataclass(frozen=True, eq=False)
class Bends:
    """parts : part -> (n, 7) the edges of one mesh, as of edge_table, and whether they bend

    Equal where their content is; a part that is missing has linear elements.
    """

    parts: Mapping[str, Floats]

    @classmethod
    def everywhere(cls, parts: list[str]) -> "Bends":
        """Every edge of these parts."""
        return cls({part: np.array([[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]) for part in parts})

    def of(self, part: str) -> Midsides:
        """What Elements.on asks."""
        return partial(self._of_edges, part) if part in self.parts else False

    def _of_edges(self, part: str, a: Floats, b: Floats) -> Bools:
        table, edges = self.parts[part], edge_table(a, b)
        out = np.zeros(len(a), bool)
        for kind in (0.0, 1.0):
            here = table[table[:, 3] == kind] if (table[:, 3] == kind).any() else table
            those = edges[:, 3] == kind
            scale = np.linalg.norm(here[:, 4:6], axis=1).mean()
            places = [_place(each, scale) for each in (here, edges[those])]
            out[those] = here[cKDTree(places[0]).query(places[1])[1], 6] > 0.0
        return out

    @cached_property
    def digest(self) -> str:
        """Of the content."""
        out = hashlib.sha256()
        for part, edges in sorted(self.parts.items()):
            out.update(part.encode() + np.ascontiguousarray(edges).tobytes())
        return out.hexdigest()[:20]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Bends) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def __repr__(self) -> str:
        return f"Bends({self.digest})"


def _place(edges: Floats, scale: float) -> Floats:
    """(n, 5) where edges are, and their angles as far apart as edges are long (m)."""
    length = np.maximum(np.linalg.norm(edges[:, 4:6], axis=1), 1e-12)[:, None]
    return np.hstack([edges[:, :3], scale * edges[:, 4:6] / length])
