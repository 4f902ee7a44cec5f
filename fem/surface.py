"""Surfaces: one side of a face, what washes it, and the two sides of a contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fem import kernels
from fem.block import Block, nodal, pattern, renumbered
from geom.errors import InputError
from geom.mesh import NamedMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Trace:
    """One side of a surface: dofs (m,) of the whole, mass (m, m) Int N N' (m2), b (m,) Int N (m2).

    facets : (nf, 3) in the surface's own numbering;  areas : (nf,) m2
    """

    part: str
    dofs: Ints
    mass: sp.csr_array
    b: Floats
    facets: Ints
    areas: Floats

    @property
    def area(self) -> float:
        """m2"""
        return float(self.b.sum())

    def integrate(self, T: Floats, f, order: int):  # type: ignore[no-untyped-def]
        """(m,) Int f(T) N for T (m,) on the surface; exact where f is a polynomial of degree order - 1."""
        N, weight = _rule(order)
        values = f(T[self.facets] @ N) * (2 * weight) * self.areas[:, None]
        return np.bincount(self.facets.ravel(), (values @ N.T).ravel(), len(self.dofs))

    def weighted(self, T: Floats, f, order: int) -> sp.csr_array:  # type: ignore[no-untyped-def]
        """(m, m) Int f(T) N N' for T (m,) on the surface; exact where f is a polynomial of degree order - 2."""
        N, weight = _rule(order)
        values = f(T[self.facets] @ N) * (2 * weight) * self.areas[:, None]
        local = np.einsum("fq,iq,jq->fij", values, N, N)
        rows, cols = np.repeat(self.facets, 3, axis=1).ravel(), np.tile(self.facets, 3).ravel()
        return sp.csr_array(sp.coo_array((local.ravel(), (rows, cols)), self.mass.shape))


@dataclass(frozen=True)
class Film:
    """A face washed by a fluid."""

    trace: Trace
    fluid: str


@dataclass(frozen=True)
class Touch:
    """A contact: the two traces have matching nodes."""

    a: Trace
    b: Trace

    @property
    def area(self) -> float:
        """m2"""
        return self.a.area


def trace_of(mesh: NamedMesh, block: Block, facets: Ints) -> Trace:
    """The side of `facets` (nf, 3) that belongs to a part."""
    points, local = renumbered(facets, len(mesh.points))
    position = np.searchsorted(block.points, points)
    if not np.array_equal(block.points[np.minimum(position, len(block.points) - 1)], points):
        raise InputError(
            "a facet has points outside its part", f"part '{block.name}'", "facets of the part's own tetrahedra"
        )
    edge = mesh.points[facets[:, 1:]] - mesh.points[facets[:, :1]]
    areas = np.linalg.norm(np.cross(edge[:, 0], edge[:, 1]), axis=1) / 2
    mass = pattern(local, len(points))
    kernels.mass(local, areas, mass.indptr, mass.indices, mass.data)
    return Trace(block.name, block.dofs.start + position, mass, nodal(local, areas, len(points)), local, areas)


def _rule(order: int) -> tuple[Floats, Floats]:
    """Hat functions (3, q) at the points of a triangle's quadrature rule, and its weights (q,), sum 1/2."""
    (x, y), weight = get_quadrature(RefTri, order)
    return np.stack([1 - x - y, x, y]), weight
