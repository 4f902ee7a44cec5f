"""From the states of a condensed network back to the field: pictures, hot spots, and the value at any point."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Ints
from geom.errors import InputError
from lumped.model.network import Array, Row

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

    from fem.matrices.elements import Elements

SNAP_M = 3e-3  # a thermocouple this far outside its part is taken to sit on the surface


@dataclass(frozen=True)
class PartShape:
    """One part: points (m,) its corners' numbers in the mesh, V (n, k) fields of its states on all its unknowns.

    elements : of fem, the corners' unknowns first;  weights (n,) : row of the part's mean temperature
    """

    points: Ints
    elements: "Elements"
    V: Array
    weights: Array
    states: Ints

    @property
    def xyz(self) -> Array:
        """(n, 3) points of the unknowns (m)."""
        return np.asarray(self.elements.xyz)

    @property
    def tets(self) -> Ints:
        """(nt, 4) corners, in the part's own numbers."""
        return np.asarray(self.elements.tets)

    @cached_property
    def tree(self) -> "cKDTree":
        from scipy.spatial import cKDTree

        return cKDTree(self.xyz[self.tets].mean(1))


@dataclass(frozen=True)
class Shapes:
    """Recovery of all parts, in the field's order."""

    parts: Mapping[str, PartShape] = field(repr=False)

    def row(self, part: str, xyz: Array) -> Row:
        """Temperature at a point (m) of a part as a row over the states; InputError if the point is not in the part."""
        shape = self._part(part)
        nodes, weights = locate(shape, np.asarray(xyz, float), part)
        return Row(shape.states, weights @ shape.V[nodes])

    def field(self, x: Array) -> Array:
        """(n,) temperature at every unknown of every part, parts one after the other."""
        return np.concatenate([shape.V @ x[shape.states] for shape in self.parts.values()])

    def of_part(self, part: str, x: Array) -> Array:
        """(m,) temperature (degC) at a part's corners of tetrahedra, its points in the mesh."""
        shape = self._part(part)
        return np.asarray(shape.V[: len(shape.points)] @ x[shape.states])

    def hot_spot(self, part: str, x: Array) -> tuple[float, Array]:
        """Largest temperature (degC) of a part and where it is (m)."""
        shape = self._part(part)
        T = shape.V @ x[shape.states]
        k = int(np.argmax(T))
        return float(T[k]), shape.xyz[k]

    def _part(self, name: str) -> PartShape:
        if name not in self.parts:
            raise InputError(f"unknown part '{name}'", "recovery", f"known: {', '.join(self.parts)}")
        return self.parts[name]


def locate(shape: PartShape, xyz: Array, part: str) -> tuple[Ints, Array]:
    """Unknowns and their weights at a point, or at a point of the part within 3 mm."""
    near = np.atleast_1d(shape.tree.query(xyz, k=min(200, len(shape.tets)))[1])
    corners = shape.xyz[shape.tets[near]]
    edges = np.moveaxis(corners[:, 1:] - corners[:, :1], 1, 2)
    inner = np.linalg.solve(edges, (xyz - corners[:, 0])[:, :, None])[:, :, 0]
    weights = np.column_stack([1 - inner.sum(1), inner])
    best = int(np.argmax(weights.min(1)))
    if weights[best].min() > -1e-6:
        return shape.elements.row(near[best], np.clip(weights[best], 0.0, 1.0))
    distance = np.linalg.norm(shape.xyz - xyz, axis=1)
    k = int(np.argmin(distance))
    # Long thin elements hide from the search by centres: take the best of all before giving up.
    if distance[k] > SNAP_M:
        return _anywhere(shape, xyz, part, distance[k], shape.xyz[k])
    return np.array([k]), np.ones(1)


def _anywhere(shape: PartShape, xyz: Array, part: str, distance: float, nearest: Array) -> tuple[Ints, Array]:
    """In the element whose nearest mix of corners is closest: a surface that was measured ends beside the mesh."""
    corners = shape.xyz[shape.tets]
    near = np.flatnonzero(((corners.min(1) <= xyz + SNAP_M) & (corners.max(1) >= xyz - SNAP_M)).all(1))
    if near.size:
        first, edges = corners[near, 0], np.moveaxis(corners[near, 1:] - corners[near, :1], 1, 2)
        inner = np.linalg.solve(edges, (xyz - first)[:, :, None])[:, :, 0]
        weights = np.clip(np.column_stack([1 - inner.sum(1), inner]), 0.0, 1.0)
        weights /= weights.sum(axis=1, keepdims=True)
        away = np.linalg.norm(np.einsum("ij,ijk->ik", weights, corners[near]) - xyz, axis=1)
        best = int(np.argmin(away))
        if away[best] <= SNAP_M:
            return shape.elements.row(int(near[best]), weights[best])
    spot, mm = np.round(1e3 * xyz, 1), np.round(1e3 * nearest, 1)
    right = f"nearest point of the part: {mm.tolist()} mm, {1e3 * distance:.1f} mm away"
    raise InputError(f"the point {spot.tolist()} mm is not in part '{part}'", "sensor", right)
