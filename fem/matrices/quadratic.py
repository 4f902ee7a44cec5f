"""Quadratic tetrahedra, for parts in which heat arises in a poor conductor.

With k elements across a heated layer, linear tetrahedra leave out about 1 / k^2 of the rise from its skin to its mean:
a winding with two elements across a slot stays 4 to 5 % too cold. Quadratic ones bend with the parabola.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from fem.matrices import kernels
from fem.matrices.elements import HasTensor, pattern, tensors

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
RIM = np.array([[0, 1], [0, 2], [1, 2]])  # edges of a facet
MEAN = np.repeat([-1 / 20, 1 / 5], [4, 6])  # of a quadratic function over a tetrahedron
FEW = 20_000  # tetrahedra whose matrices are in memory at a time


@dataclass(frozen=True)
class Quadratic:
    """One unknown per corner, and one at the middle of every edge.

    cells (nt, 10) : corners and middles;  edges (n_edges,) : number of each edge among pairs of corners, ascending
    """

    tets: Ints
    cells: Ints
    xyz: Floats
    edges: Ints

    @classmethod
    def on(cls, tets: Ints, corners: Floats) -> Quadratic:
        """corners (m, 3) m"""
        m = len(corners)
        edges, which = np.unique(_keys(tets[:, EDGES], m), return_inverse=True)
        middles = (corners[edges // m] + corners[edges % m]) / 2
        return cls(tets, np.hstack([tets, m + which.reshape(-1, 6)]), np.vstack([corners, middles]), edges)

    def conduction(self, conductivity: HasTensor, factor: Floats | None = None) -> sp.csr_array:
        share = np.ones(len(self.tets)) if factor is None else factor
        return self._summed(share[some, None, None] * k for some, k in self._conducting(conductivity))

    def conduction_slope(self, conductivity: HasTensor, slope: Floats, T: Floats) -> sp.csr_array:
        return self._summed(
            (k @ (slope[some, None] * T[self.cells[some]])[:, :, None]) * MEAN
            for some, k in self._conducting(conductivity)
        )

    def mass(self, amount: Floats) -> sp.csr_array:
        parts = range(0, len(self.tets), FEW)
        return self._summed(amount[i : i + FEW, None, None] * _reference()[1] for i in parts)

    def nodal(self, amount: Floats) -> Floats:
        return np.bincount(self.cells.ravel(), np.outer(amount, MEAN).ravel(), len(self.xyz)).astype(float)

    def means(self, T: Floats) -> Floats:
        return np.asarray(T[self.cells] @ MEAN)

    def row(self, tet: int, corner: Floats) -> tuple[Ints, Floats]:
        return self.cells[tet], hats(corner[:, None])[:, 0]

    def facets(self, corners: Ints) -> Ints:
        m = len(self.xyz) - len(self.edges)
        return np.hstack([corners, m + np.searchsorted(self.edges, _keys(corners[:, RIM], m)).reshape(-1, 3)])

    def _conducting(self, conductivity: HasTensor) -> Iterator[tuple[slice, Floats]]:
        """Slices and the matrices (., 10, 10) of their tetrahedra."""
        for some, k in tensors(self.xyz, self.tets, conductivity, FEW):
            grad, volume = _gradients(self.xyz[self.tets[some]])
            along = (volume[:, None, None] * (grad @ k @ grad.transpose(0, 2, 1))).reshape(-1, 16)
            yield some, (along @ _reference()[0]).reshape(-1, 10, 10)

    def _summed(self, local: Iterator[Floats]) -> sp.csr_array:
        """(n, n) of element matrices (., 10, 10), given in slices of the tetrahedra."""
        out, first = pattern(self.cells, len(self.xyz)), 0
        for some in local:
            kernels.spread(self.cells[first : first + len(some)], some, out.indptr, out.indices, out.data)
            first += len(some)
        return out


def _keys(edges: Ints, m: int) -> Ints:
    """One number per edge (..., 2), whichever way round."""
    return (edges.min(-1) * m + edges.max(-1)).ravel()


def _gradients(corners: Floats) -> tuple[Floats, Floats]:
    """(nt, 4, 3) gradients of the barycentric coordinates (1/m) and volumes (nt,) m3 of tetrahedra (nt, 4, 3)."""
    edges = corners[:, 1:] - corners[:, :1]
    inner = np.linalg.inv(edges).transpose(0, 2, 1)
    return np.concatenate([-inner.sum(1, keepdims=True), inner], axis=1), np.abs(np.linalg.det(edges)) / 6


def hats(corner: Floats, degree: int = 2) -> Floats:
    """(k, q) functions of a degree on a triangle or tetrahedron at barycentric coordinates (3 or 4, q)."""
    if degree == 1:
        return corner
    a, b = (EDGES if len(corner) == 4 else RIM).T
    return np.concatenate([corner * (2 * corner - 1), 4 * corner[a] * corner[b]])


def _slopes(corner: Floats) -> Floats:
    """(10, 4, q) derivatives of the quadratic functions by the barycentric coordinates (4, q)."""
    (a, b), corners, middle = EDGES.T, np.arange(4), 4 + np.arange(6)
    out = np.zeros((10, 4, corner.shape[1]))
    out[corners, corners] = 4 * corner - 1
    out[middle, a], out[middle, b] = 4 * corner[b], 4 * corner[a]
    return out


@cache
def _reference() -> tuple[Floats, Floats]:
    """Of a volume of 1: (16, 100) conduction from grad_a . k grad_b, (10, 10) mass."""
    points, weight = get_quadrature(RefTet, 4)
    corner, w = np.vstack([1 - points.sum(0), points]), weight / weight.sum()
    N, dN = hats(corner), _slopes(corner)
    return np.einsum("iaq,jbq,q->abij", dN, dN, w).reshape(16, 100), np.einsum("iq,jq,q->ij", N, N, w)
