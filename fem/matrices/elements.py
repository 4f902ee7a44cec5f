"""What a part's temperature is made of: linear or quadratic functions on its tetrahedra. Values are temperatures.

Quadratic ones are for parts in which heat arises in a poor conductor. With k elements across a heated layer, linear
ones leave out about 1 / k^2 of the rise from its skin to its mean: a winding with two elements across a slot stays 4 to
5 % too cold. Quadratic ones bend with the parabola.

Where the temperature hardly bends along an edge, its middle needs no unknown either: it is the mean of the ends.

In layers of prisms every upright side is a rectangle, cut by a diagonal. The middle of the diagonal needs no unknown:
on a rectangle the eight others span all parabolas (the serendipity element), and three unknowns in eight are saved.
Source: Zienkiewicz and Taylor 2000, "The finite element method", volume 1, 8.6.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from fem.matrices import kernels
from geom.arrays import Array as Floats, Ints

# Of every edge, of none, or of which of those from a to b (n, 3).
Midsides = bool | Callable[[Floats, Floats], NDArray[np.bool_]]
EDGES = np.array([[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
RIM = np.array([[0, 1], [0, 2], [1, 2]])  # edges of a facet
ALIKE = 1e-6  # of an edge's length: nearer points of the plane, or levels, are the same
CHUNK = 200_000  # tetrahedra whose tensors are in memory at a time


class HasTensor(Protocol):
    def tensor(self, x: Floats) -> Floats:
        """(n, 3, 3) conductivity (W/m/K) at points x (n, 3)."""
        ...


@dataclass(frozen=True)
class Elements:
    """One unknown per corner; of quadratic ones also one at the middle of every edge that bends and is not an upright
    diagonal.

    tets (nt, 4) corners;  cells (nt, 4 or 10) : nodes of each, corners first;  xyz (n, 3) : points of the unknowns (m)
    edges (n_edges,) : number of each edge among pairs of corners, ascending; none where linear
    nodes (n_nodes, n) : temperatures of the corners and of all middles from the unknowns
    """

    tets: Ints
    cells: Ints
    xyz: Floats
    edges: Ints
    nodes: sp.csr_array

    @classmethod
    def on(cls, tets: Ints, corners: Floats, midsides: Midsides) -> "Elements":
        """corners (m, 3) m;  midsides : which edges have an unknown in their middle"""
        m = len(corners)
        linear = cls(tets, tets, corners, np.empty(0, np.int64), sp.eye_array(m, format="csr"))
        if midsides is False:
            return linear
        edges, which = np.unique(_keys(tets[:, EDGES], m), return_inverse=True)
        diagonal, rectangle = _upright_diagonals(edges, corners)
        other = np.delete(np.arange(len(edges)), diagonal)
        a, b = edges[other] // m, edges[other] % m
        bends = np.ones(len(other), bool) if midsides is True else midsides(corners[a], corners[b])
        if not bends.any():
            return linear
        unknown = np.concatenate([np.arange(m), np.full(len(edges), -1)])
        unknown[m + other] = m + np.arange(len(other))
        plain = np.flatnonzero(unknown >= 0)
        row = np.concatenate([plain, np.repeat(m + diagonal, 8)])
        column = unknown[np.concatenate([plain, rectangle.ravel()])]
        value = np.concatenate([np.ones(len(plain)), np.tile(np.repeat([-0.25, 0.5], 4), len(diagonal))])
        nodes = sp.csr_array((value, (row, column)), shape=(len(unknown), m + len(other)))
        middles = (corners[a] + corners[b])[bends] / 2
        cells = np.hstack([tets, m + which.reshape(-1, 6)])
        return cls(tets, cells, np.vstack([corners, middles]), edges, sp.csr_array(nodes @ _straight(a, b, bends, m)))

    @property
    def middles(self) -> Ints:
        """(n - m,) those of the edges whose middles are unknowns."""
        m = self.nodes.shape[0] - len(self.edges)
        return np.asarray(self.edges[np.flatnonzero(np.diff(self.nodes.indptr)[m:] == 1)])

    @property
    def degree(self) -> int:
        """Of the temperature in a tetrahedron."""
        return 1 if self.cells.shape[1] == 4 else 2

    def conduction(self, conductivity: HasTensor) -> sp.csr_array:
        """(n, n) Int grad N_i . k grad N_j (W/K); k at the centre of each tetrahedron."""
        out = self._empty()
        for first in range(0, len(self.tets), CHUNK):  # so that memory stays small
            some = slice(first, first + CHUNK)
            k = np.ascontiguousarray(conductivity.tensor(self.xyz[self.tets[some]].mean(1)))
            local = self.xyz, self.tets[some], self.cells[some], k, _reference(self.degree)[0]
            kernels.conduction(*local, out.indptr, out.indices, out.data)
        return self._of_unknowns(out)

    def mass(self, amount: Floats) -> sp.csr_array:
        """(n, n) Int q N_i N_j for an amount q V (nt,) in every tetrahedron."""
        out = self._empty()
        kernels.mass(self.cells, amount, _reference(self.degree)[1], out.indptr, out.indices, out.data)
        return self._of_unknowns(out)

    def nodal(self, amount: Floats) -> Floats:
        """(n,) Int q N_i for an amount q V (nt,) in every tetrahedron."""
        out = np.zeros(self.nodes.shape[0])
        for unknowns, share in zip(self.cells.T, MEANS[self.degree], strict=True):
            out += np.bincount(unknowns, share * amount, len(out))
        return np.asarray(self.nodes.T @ out)

    def row(self, tet: int, corner: Floats) -> tuple[Ints, Floats]:
        """Unknowns and their weights at a point of a tetrahedron with barycentric coordinates `corner` (4,)."""
        weights = sp.csr_array(hats(corner[:, None], self.degree).T @ self.nodes[self.cells[tet]])
        return weights.indices, weights.data

    def facets(self, corners: Ints) -> Ints:
        """(nf, 3 or 6) nodes on facets given by their corners (nf, 3), corners first."""
        if self.degree == 1:
            return corners
        m = self.nodes.shape[0] - len(self.edges)
        return np.hstack([corners, m + np.searchsorted(self.edges, _keys(corners[:, RIM], m)).reshape(-1, 3)])

    @cached_property
    def _pattern(self) -> sp.csr_array:
        return pattern(self.cells, self.nodes.shape[0])

    def _empty(self) -> sp.csr_array:
        like = self._pattern
        return sp.csr_array((np.zeros(like.nnz), like.indices, like.indptr), like.shape)

    def _of_unknowns(self, A: sp.csr_array) -> sp.csr_array:
        """(n, n) from a matrix (n_nodes, n_nodes)."""
        return A if self.nodes.shape[0] == len(self.xyz) else sp.csr_array(self.nodes.T @ A @ self.nodes)


MEANS = {1: np.full(4, 0.25), 2: np.repeat([-1 / 20, 1 / 5], [4, 6])}  # of each function over a tetrahedron


def pattern(cells: Ints, n: int) -> sp.csr_array:
    """(n, n) zeros wherever two points share a cell."""
    starts = np.arange(0, cells.size + 1, cells.shape[1], dtype=np.int32)
    touches = sp.csr_array((np.ones(cells.size, bool), cells.ravel().astype(np.int32), starts), (len(cells), n))
    near = touches.T @ touches
    near.sort_indices()
    return sp.csr_array((np.zeros(near.nnz), near.indices, near.indptr), (n, n))


def _keys(edges: Ints, m: int) -> Ints:
    """One number per edge (..., 2), whichever way round."""
    return (edges.min(-1) * m + edges.max(-1)).ravel()


def _upright_diagonals(edges: Ints, corners: Floats) -> tuple[Ints, Ints]:
    """Edges (k,), by their places in `edges`, that cut a rectangle of upright and level edges; and (k, 8) its corners
    and the middles of its sides, as nodes."""
    m = len(corners)
    a, b = edges // m, edges % m
    low, high = np.where(corners[a, 2] <= corners[b, 2], (a, b), (b, a))
    step = corners[high] - corners[low]
    flat, rise = np.abs(step[:, :2]).max(axis=1), step[:, 2]
    near = ALIKE * np.maximum(flat, rise)
    above, below = np.full(m, -1), np.full(m, -1)
    upright = flat <= near
    above[low[upright]], below[high[upright]] = high[upright], low[upright]
    diagonal = np.flatnonzero(~upright & (rise > near) & (above[low] >= 0) & (below[high] >= 0))
    p, q = low[diagonal], high[diagonal]
    ring = np.column_stack([p, below[q], q, above[p]])
    sides = _keys(np.stack([ring, np.roll(ring, -1, axis=1)], axis=-1), m).reshape(-1, 4)
    places = np.minimum(np.searchsorted(edges, sides), len(edges) - 1)
    slant = np.abs(corners[ring[:, [0, 2]], 2] - corners[ring[:, [1, 3]], 2]).max(axis=1, initial=0.0)
    square = (edges[places] == sides).all(axis=1) & (slant <= near[diagonal])
    return diagonal[square], np.hstack([ring, m + places])[square]


def _straight(a: Ints, b: Ints, bends: NDArray[np.bool_], m: int) -> sp.csr_array:
    """(m + n, n_unknowns) corners and middles of n edges from a to b: where they do not bend, the mean of the ends."""
    middle, other = np.flatnonzero(bends), np.flatnonzero(~bends)
    row = np.concatenate([np.arange(m), m + middle, m + np.repeat(other, 2)])
    column = np.concatenate([np.arange(m + len(middle)), np.column_stack([a, b])[other].ravel()])
    value = np.concatenate([np.ones(m + len(middle)), np.full(2 * len(other), 0.5)])
    return sp.csr_array((value, (row, column)), shape=(m + len(a), m + len(middle)))


def hats(corner: Floats, degree: int = 2) -> Floats:
    """(k, q) functions of a degree on a triangle or tetrahedron at barycentric coordinates (3 or 4, q)."""
    if degree == 1:
        return corner
    a, b = (EDGES if len(corner) == 4 else RIM).T
    return np.concatenate([corner * (2 * corner - 1), 4 * corner[a] * corner[b]])


@cache
def _reference(degree: int) -> tuple[Floats, Floats]:
    """Of a volume of 1: (16, k * k) conduction from grad_a . k grad_b of the four corners, (k, k) mass."""
    points, weight = get_quadrature(RefTet, 2 * degree)
    corner, w = np.vstack([1 - points.sum(0), points]), weight / weight.sum()
    # (4 or 10, 4, q) derivatives of the functions by the barycentric coordinates (4, q)
    corners = np.arange(4)
    out = np.zeros((4 if degree == 1 else 10, 4, corner.shape[1]))
    out[corners, corners] = 1.0 if degree == 1 else 4 * corner - 1
    if degree == 2:
        (a, b), middle = EDGES.T, 4 + np.arange(6)
        out[middle, a], out[middle, b] = 4 * corner[b], 4 * corner[a]
    N, dN = hats(corner, degree), out
    conduction = np.einsum("iaq,jbq,q->abij", dN, dN, w).reshape(16, -1)
    return conduction, np.einsum("iq,jq,q->ij", N, N, w)
