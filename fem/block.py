"""One part of the machine: its own conduction (nothing flows through its skin) and heat capacity."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem import kernels
from geom.errors import InputError
from geom.mesh import NamedMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
CHUNK = 200_000  # tetrahedra whose tensors are in memory at a time


class HasTensor(Protocol):
    def tensor(self, x: Floats) -> Floats:
        """(n, 3, 3) conductivity (W/m/K) at points x (n, 3)."""
        ...


@dataclass(frozen=True)
class Block:
    """One part: points (n,) its numbers in the mesh; tets (nt, 4) and volumes (nt,) (m3) in its own numbering.

    dofs : its slice of the whole;  K : (n, n) conduction (W/K);  M : (n, n) capacity (J/K);  w : (n,) Int N (m3)
    conductivity : the tensor field K was made of
    """

    name: str
    points: Ints
    xyz: Floats
    tets: Ints
    volumes: Floats
    dofs: slice
    K: sp.csr_array
    M: sp.csr_array
    w: Floats
    rho_cp: float
    conductivity: HasTensor

    @property
    def volume(self) -> float:
        """m3"""
        return float(self.w.sum())

    @property
    def capacity(self) -> float:
        """J/K"""
        return self.rho_cp * self.volume

    @cached_property
    def pieces(self) -> Ints:
        """(nt,) number of the connected piece each tetrahedron belongs to (the four coils of one winding)."""
        return sp.csgraph.connected_components(self.K, directed=False)[1][self.tets[:, 0]].astype(np.int64)

    def at_centres(self, T: Floats) -> Floats:
        """(nt,) mean over each tetrahedron of T (n,)."""
        return T[self.tets].mean(1)

    def scaled(self, factor: Floats) -> sp.csr_array:
        """(n, n) conduction (W/K) with the conductivity of every tetrahedron times factor (nt,)."""
        return _conduction(self.K, self.xyz, self.tets, self.conductivity, factor)

    def scaled_slope(self, slope: Floats, T: Floats) -> sp.csr_array:
        """(n, n) what `scaled(f(T)) @ T` changes by through f alone, f'(T) = slope (nt,); not symmetric."""
        out = _empty(self.K)
        for some, k in _tensors(self.xyz, self.tets, self.conductivity):
            kernels.conduction_slope(self.xyz, self.tets[some], k, slope[some], T, out.indptr, out.indices, out.data)
        return out

    def mass(self, density: Floats) -> sp.csr_array:
        """(n, n) Int density N N' for a density (nt,) per m3."""
        out = _empty(self.K)
        kernels.mass(self.tets, density * self.volumes, out.indptr, out.indices, out.data)
        return out


def block_of(mesh: NamedMesh, number: int, start: int, conductivity: HasTensor, rho_cp: float) -> Block:
    """Part `number` of a mesh; its unknowns begin at `start`."""
    mine = mesh.region == number
    chosen = mesh.tets if mine.all() else mesh.tets[mine]
    if len(chosen) == 0:
        raise InputError("no tetrahedron", f"part '{mesh.parts[number]}'", "a part with a volume")
    points, tets = renumbered(chosen, len(mesh.points))
    xyz = np.ascontiguousarray(mesh.points[points])
    volumes = kernels.volumes(xyz, tets)
    n = len(points)
    empty = pattern(tets, n)
    K = _conduction(empty, xyz, tets, conductivity, None)
    M = _empty(empty)
    kernels.mass(tets, rho_cp * volumes, M.indptr, M.indices, M.data)
    w = nodal(tets, volumes, n)
    return Block(mesh.parts[number], points, xyz, tets, volumes, slice(start, start + n), K, M, w, rho_cp, conductivity)


def renumbered(cells: Ints, n: int) -> tuple[Ints, Ints]:
    """The point numbers (below n) that cells use, ascending, and the cells in terms of them."""
    used = np.zeros(n, bool)
    used[cells] = True
    if used.all():
        return np.arange(n), np.ascontiguousarray(cells)
    return np.flatnonzero(used), (np.cumsum(used) - 1)[cells]


def nodal(cells: Ints, sizes: Floats, n: int) -> Floats:
    """(n,) Int N for cells (m, k) of given sizes."""
    out = np.zeros(n)
    for corner in cells.T:
        out += np.bincount(corner, sizes, n)
    return out / cells.shape[1]


def pattern(cells: Ints, n: int) -> sp.csr_array:
    """(n, n) zeros wherever two points share a cell."""
    indptr, indices = kernels.pattern(cells, n)
    return sp.csr_array((np.zeros(len(indices)), indices, indptr), (n, n))


def _empty(like: sp.csr_array) -> sp.csr_array:
    return sp.csr_array((np.zeros(like.nnz), like.indices, like.indptr), like.shape)


def _conduction(
    like: sp.csr_array, xyz: Floats, tets: Ints, conductivity: HasTensor, factor: Floats | None
) -> sp.csr_array:
    """Int grad N_i . k grad N_j; gradients are constant, so k at the centre is a second-order rule."""
    out = _empty(like)
    for some, k in _tensors(xyz, tets, conductivity):
        k = k if factor is None else k * factor[some, None, None]
        kernels.conduction(xyz, tets[some], k, out.indptr, out.indices, out.data)
    return out


def _tensors(xyz: Floats, tets: Ints, conductivity: HasTensor):  # type: ignore[no-untyped-def]
    """(slice, tensors at the centres) of some tetrahedra at a time, so that memory stays small."""
    for first in range(0, len(tets), CHUNK):
        some = slice(first, first + CHUNK)
        yield some, np.ascontiguousarray(conductivity.tensor(xyz[tets[some]].mean(1)))
