"""What a part's temperature is made of: the elements on its tetrahedra. Values are temperatures at points."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.matrices import kernels

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHUNK = 200_000  # tetrahedra whose tensors are in memory at a time


class HasTensor(Protocol):
    def tensor(self, x: Floats) -> Floats:
        """(n, 3, 3) conductivity (W/m/K) at points x (n, 3)."""
        ...


class Elements(Protocol):
    """tets (nt, 4) corners and xyz (n, 3) points (m) of the unknowns, corners first."""

    @property
    def tets(self) -> Ints: ...

    @property
    def xyz(self) -> Floats: ...

    def conduction(self, conductivity: HasTensor, factor: Floats | None = None) -> sp.csr_array:
        """(n, n) Int grad N_i . k grad N_j (W/K), times factor (nt,); k at the centre of each tetrahedron."""
        ...

    def conduction_slope(self, conductivity: HasTensor, slope: Floats, T: Floats) -> sp.csr_array:
        """(n, n) what `conduction(k, f) @ T` changes by through f alone, f'(T) = slope (nt,); not symmetric."""
        ...

    def mass(self, amount: Floats) -> sp.csr_array:
        """(n, n) Int q N_i N_j for an amount q V (nt,) in every tetrahedron."""
        ...

    def nodal(self, amount: Floats) -> Floats:
        """(n,) Int q N_i for an amount q V (nt,) in every tetrahedron."""
        ...

    def means(self, T: Floats) -> Floats:
        """(nt,) mean over every tetrahedron of T (n,)."""
        ...

    def row(self, tet: int, corner: Floats) -> tuple[Ints, Floats]:
        """Unknowns and their weights at a point of a tetrahedron with barycentric coordinates `corner` (4,)."""
        ...

    def facets(self, corners: Ints) -> Ints:
        """(nf, 3 or 6) unknowns on facets given by their corners (nf, 3), corners first."""
        ...


def tensors(xyz: Floats, tets: Ints, conductivity: HasTensor, some: int = CHUNK) -> Iterator[tuple[slice, Floats]]:
    """Slices of the tetrahedra with the tensors (., 3, 3) at their centres, so that memory stays small."""
    for first in range(0, len(tets), some):
        chunk = slice(first, first + some)
        yield chunk, np.ascontiguousarray(conductivity.tensor(xyz[tets[chunk]].mean(1)))


def pattern(cells: Ints, n: int) -> sp.csr_array:
    """(n, n) zeros wherever two points share a cell."""
    indptr, indices = kernels.pattern(cells, n)
    return sp.csr_array((np.zeros(len(indices)), indices, indptr), (n, n))


def nodal(cells: Ints, sizes: Floats, n: int) -> Floats:
    """(n,) Int N of linear cells (m, k) of given sizes."""
    out = np.zeros(n)
    for corner in cells.T:
        out += np.bincount(corner, sizes, n)
    return out / cells.shape[1]


def _empty(like: sp.csr_array) -> sp.csr_array:
    return sp.csr_array((np.zeros(like.nnz), like.indices, like.indptr), like.shape)


@dataclass(frozen=True)
class Linear:
    """One unknown per corner."""

    tets: Ints
    xyz: Floats

    @cached_property
    def _pattern(self) -> sp.csr_array:
        return pattern(self.tets, len(self.xyz))

    def conduction(self, conductivity: HasTensor, factor: Floats | None = None) -> sp.csr_array:
        out = _empty(self._pattern)
        for some, k in tensors(self.xyz, self.tets, conductivity):
            k = k if factor is None else k * factor[some, None, None]
            kernels.conduction(self.xyz, self.tets[some], k, out.indptr, out.indices, out.data)
        return out

    def conduction_slope(self, conductivity: HasTensor, slope: Floats, T: Floats) -> sp.csr_array:
        out = _empty(self._pattern)
        for some, k in tensors(self.xyz, self.tets, conductivity):
            kernels.conduction_slope(self.xyz, self.tets[some], k, slope[some], T, out.indptr, out.indices, out.data)
        return out

    def mass(self, amount: Floats) -> sp.csr_array:
        out = _empty(self._pattern)
        kernels.mass(self.tets, amount, out.indptr, out.indices, out.data)
        return out

    def nodal(self, amount: Floats) -> Floats:
        return nodal(self.tets, amount, len(self.xyz))

    def means(self, T: Floats) -> Floats:
        return np.asarray(T[self.tets].mean(1))

    def row(self, tet: int, corner: Floats) -> tuple[Ints, Floats]:
        return self.tets[tet], corner

    def facets(self, corners: Ints) -> Ints:
        return corners
