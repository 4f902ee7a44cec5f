"""Surfaces: one side of a face, what washes it, and the two sides of a contact."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTri

from fem.matrices import kernels
from fem.matrices.block import Block, renumbered
from fem.matrices.elements import RIM, hats, pattern
from geom.arrays import Array as Floats, Ints
from geom.errors import InputError
from geom.meshing.mesh import NamedMesh


@dataclass(frozen=True)
class Trace:
    """One side of a surface: dofs (m,) of the whole, mass (m, m) Int N N' (m2), b (m,) Int N (m2).

    facets : (nf, 3) nodes in the surface's own numbering, (nf, 6) with middles on quadratic elements;  areas : (nf,) m2
    nodes : (n_nodes, m) their temperatures from those of the unknowns
    """

    part: str
    dofs: Ints
    mass: sp.csr_array
    b: Floats
    facets: Ints
    areas: Floats
    nodes: sp.csr_array

    @property
    def area(self) -> float:
        """m2"""
        return float(self.b.sum())

    @property
    def degree(self) -> int:
        """Of the temperature on a facet."""
        return 1 if self.facets.shape[1] == 3 else 2

    def integrate(self, T: Floats, f, order: int):  # type: ignore[no-untyped-def]
        """(m,) Int f(T) N for T (m,) on the surface; exact where f is a polynomial of degree order - 1."""
        N, weight = _rule(order, self.degree)
        values = f((self.nodes @ T)[self.facets] @ N) * (2 * weight) * self.areas[:, None]
        out = np.bincount(self.facets.ravel(), (values @ N.T).ravel(), self.nodes.shape[0])
        return np.asarray(self.nodes.T @ out)

    def weighted(self, T: Floats, f, order: int) -> sp.csr_array:  # type: ignore[no-untyped-def]
        """(m, m) Int f(T) N N' for T (m,) on the surface; exact where f is a polynomial of degree order - 2."""
        N, weight = _rule(order, self.degree)
        values = f((self.nodes @ T)[self.facets] @ N) * (2 * weight) * self.areas[:, None]
        local, k = np.einsum("fq,iq,jq->fij", values, N, N), len(N)
        rows, cols = np.repeat(self.facets, k, axis=1).ravel(), np.tile(self.facets, k).ravel()
        out = sp.csr_array(sp.coo_array((local.ravel(), (rows, cols)), (self.nodes.shape[0],) * 2))
        return sp.csr_array(self.nodes.T @ out @ self.nodes)


@dataclass(frozen=True)
class Film:
    """A face washed by a fluid."""

    trace: Trace
    fluid: str


@dataclass(frozen=True)
class Touch:
    """A contact: the two traces have matching corners;  cross : (m_a, m_b) Int N_a N_b' (m2)."""

    a: Trace
    b: Trace
    cross: sp.csr_array

    @property
    def area(self) -> float:
        """m2"""
        return self.a.area


def touch_of(a: Trace, b: Trace) -> Touch:
    """Two sides of the same facets; beside a quadratic one, a linear one is the mean of its ends midway on an edge."""
    if a.degree == b.degree:
        return Touch(a, b, sp.csr_array(a.nodes.T @ _mass(a.facets, a.areas) @ b.nodes))
    if a.degree > b.degree:
        return Touch(a, b, sp.csr_array(a.nodes.T @ _mass(a.facets, a.areas) @ _straight(a)))
    return Touch(a, b, sp.csr_array(_straight(b).T @ _mass(b.facets, b.areas) @ b.nodes))


def _straight(trace: Trace) -> sp.csr_array:
    """(n_nodes, corners) : the nodes of a quadratic trace where the temperature is linear in every facet."""
    corners = np.unique(trace.facets[:, :3])
    middles, first = np.unique(trace.facets[:, 3:], return_index=True)
    ends = trace.facets[:, RIM].reshape(-1, 2)[first]
    row = np.concatenate([corners, np.repeat(middles, 2)])
    col = np.concatenate([corners, ends.ravel()])
    value = np.concatenate([np.ones(len(corners)), np.full(2 * len(middles), 0.5)])
    return sp.csr_array(sp.coo_array((value, (row, col)), (len(corners) + len(middles), len(corners))))


def trace_of(mesh: NamedMesh, block: Block, facets: Ints) -> Trace:
    """The side of `facets` (nf, 3) that belongs to a part."""
    points = np.minimum(np.searchsorted(block.points, facets), len(block.points) - 1)
    if not np.array_equal(block.points[points], facets):
        raise InputError(
            "a facet has points outside its part", f"part '{block.name}'", "facets of the part's own tetrahedra"
        )
    edge = mesh.points[facets[:, 1:]] - mesh.points[facets[:, :1]]
    areas = np.linalg.norm(np.cross(edge[:, 0], edge[:, 1]), axis=1) / 2
    mine, local = renumbered(block.elements.facets(points), block.elements.nodes.shape[0])
    nodes = sp.csr_array(block.elements.nodes[mine])
    unknowns, column = np.unique(nodes.indices, return_inverse=True)
    nodes = sp.csr_array((nodes.data, column, nodes.indptr), (len(mine), len(unknowns)))
    mass = sp.csr_array(nodes.T @ _mass(local, areas) @ nodes)
    b = np.asarray(mass.sum(axis=0)).ravel()
    return Trace(block.name, block.dofs.start + unknowns, mass, b, local, areas, nodes)


def _mass(facets: Ints, areas: Floats) -> sp.csr_array:
    """(n_nodes, n_nodes) Int N N' (m2)"""
    out = pattern(facets, facets.max() + 1)
    kernels.mass(facets, areas, _reference(1 if facets.shape[1] == 3 else 2), out.indptr, out.indices, out.data)
    return out


@cache
def _reference(degree: int) -> Floats:
    """Mass matrix of a facet of area 1."""
    N, weight = _rule(4, degree)
    return (2 * weight * N) @ N.T


def _rule(order: int, degree: int) -> tuple[Floats, Floats]:
    """Functions (3 or 6, q) at the points of a triangle's quadrature rule, and its weights (q,), sum 1/2."""
    (x, y), weight = get_quadrature(RefTri, order * degree)
    return hats(np.stack([1 - x - y, x, y]), degree), weight
