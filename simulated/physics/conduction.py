"""Heat conduction on a named mesh: linear tetrahedra, every part with nodes of its own, contacts node to node."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from geom.meshing.mesh import NamedMesh, Patch

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class Solid:
    """What a part is made of.

    k : conductivity across and along the axis (W/m/K) at 20 degC
    rho_c : heat capacity (J/m3/K)
    slope : relative change of the conductivity (1/K)
    turns : (z0, z1) m beyond which a coil's wire runs around its pole, along x or y, instead of along the axis
    """

    k: tuple[float, float]
    rho_c: float
    slope: float = 0.0
    turns: tuple[float, float] | None = None

    def at(self, centres: Array) -> Array:
        """Conductivity (n, 3) along x, y and z at points (n, 3) m."""
        across, along = self.k
        k = np.tile([across, across, along], (len(centres), 1))
        if self.turns:
            x, y, z = np.abs(centres[:, 0]), np.abs(centres[:, 1]), centres[:, 2]
            around = (z < self.turns[0]) | (z > self.turns[1])
            k[around & (x >= y)] = across, along, across
            k[around & (x < y)] = along, across, across
        return k


@dataclass(frozen=True)
class Face:
    """A named outer surface: its nodes, the area each stands for (m2), and the fluid that washes it."""

    part: str
    fluid: str
    nodes: Index
    areas: Array


@dataclass(frozen=True)
class Body:
    """The machine as the solver sees it.

    points (n, 3) m, volume (n,) m3, capacity (n,) J/K and part (n,) belong to the split nodes
    tets (m, 4) split node numbers; region (m,) part of each tetrahedron
    stiffness : (n, n) W/K at 20 degC, block by part; coupling : (n, n) W/K of all contacts
    """

    parts: tuple[str, ...]
    points: Array
    volume: Array
    capacity: Array
    part: Index
    tets: Index
    region: Index
    stiffness: sparse.csr_matrix
    coupling: sparse.csr_matrix
    slope: Array
    faces: Mapping[str, Face]

    def nodes(self, part: str) -> Index:
        return np.flatnonzero(self.part == self.parts.index(part))

    def conduction(self, T: Array) -> sparse.csr_matrix:
        """Conduction and contacts (W/K), each part's conductivity taken at its mean temperature (degC)."""
        scale = 1 + self.slope * (self.part_means(T) - 20.0)
        return sparse.diags(scale[self.part]) @ self.stiffness + self.coupling

    def part_means(self, T: Array) -> Array:
        count = len(self.parts)
        return np.bincount(self.part, self.volume * T, count) / np.bincount(self.part, self.volume, count)


def build(
    mesh: NamedMesh,
    solids: Mapping[str, Solid],
    contacts: Mapping[str, float],
    copies: Mapping[str, int] | None = None,
    joints: Mapping[str, tuple[Patch, Patch]] | None = None,
) -> Body:
    """Split the nodes, assemble.

    contacts : name of contact or joint -> conductance (W/m2/K)
    copies : how often the meshed piece of a part counts, 1 unless given
    joints : pairs of patches that exchange heat through their mean temperatures (one turns), over the first one's area
    """
    split = _Split(mesh, copies or {})
    gradients, volume = _gradients(mesh.points[mesh.tets])
    volume = volume * split.copies[mesh.region]
    nodal = np.repeat(volume / 4, 4)
    rho_c = np.array([solids[p].rho_c for p in mesh.parts])
    k = np.empty((len(mesh.tets), 3))
    for number, part in enumerate(mesh.parts):
        own = mesh.region == number
        k[own] = solids[part].at(mesh.points[mesh.tets[own]].mean(axis=1))
    flat = split.tets.ravel()
    return Body(
        mesh.parts,
        mesh.points[split.origin],
        np.bincount(flat, nodal, split.size),
        np.bincount(flat, nodal * np.repeat(rho_c[mesh.region], 4), split.size),
        split.part,
        split.tets,
        mesh.region,
        _stiffness(split, gradients, volume, k),
        _coupling(split, mesh, contacts) + _joined(split, mesh, contacts, joints or {}),
        np.array([solids[p].slope for p in mesh.parts]),
        {name: Face(p.part, p.fluid, *_face(split, mesh, p.part, p.facets)) for name, p in mesh.patches.items()},
    )


class _Split:
    """Numbers the pairs (part, mesh point): a point on an interface becomes one node of each part."""

    def __init__(self, mesh: NamedMesh, copies: Mapping[str, int]) -> None:
        self.parts, self.stride = mesh.parts, len(mesh.points)
        self.copies = np.array([copies.get(part, 1) for part in mesh.parts])
        keys = mesh.region[:, None].astype(np.int64) * self.stride + mesh.tets
        self.keys, inverse = np.unique(keys, return_inverse=True)
        self.tets = inverse.reshape(keys.shape)
        self.part, self.origin = self.keys // self.stride, self.keys % self.stride
        self.size = len(self.keys)

    def nodes(self, part: str, points: Index) -> Index:
        return np.searchsorted(self.keys, self.parts.index(part) * self.stride + points)

    def thirds(self, part: str, points: Array, facets: Index) -> Array:
        """(3 n,) a third of each triangle's area (m2), once per corner, all copies of the part together."""
        a, b, c = (points[facets[:, i]] for i in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        return np.repeat(area * self.copies[self.parts.index(part)] / 3, 3)


def _gradients(corners: Array) -> tuple[Array, Array]:
    """Gradients (m, 4, 3) of the four hat functions in every tetrahedron, and its volume (m,)."""
    edges = corners[:, 1:] - corners[:, :1]
    inverse = np.linalg.inv(edges)
    gradients = np.concatenate([-inverse.sum(axis=2)[:, :, None], inverse], axis=2).transpose(0, 2, 1)
    return gradients, np.abs(np.linalg.det(edges)) / 6


def _stiffness(split: _Split, gradients: Array, volume: Array, k: Array) -> sparse.csr_matrix:
    local = np.einsum("mid,md,mjd->mij", gradients, k * volume[:, None], gradients)
    rows = np.repeat(split.tets, 4, axis=1).ravel()
    cols = np.tile(split.tets, (1, 4)).ravel()
    return sparse.coo_matrix((local.ravel(), (rows, cols)), shape=(split.size, split.size)).tocsr()


def _coupling(split: _Split, mesh: NamedMesh, contacts: Mapping[str, float]) -> sparse.csr_matrix:
    rows, cols, vals = [], [], []
    for name, contact in mesh.contacts.items():
        a, b = (split.nodes(part, contact.facets.ravel()) for part in (contact.a, contact.b))
        g = contacts[name] * split.thirds(contact.a, mesh.points, contact.facets)
        rows += [a, b, a, b]
        cols += [a, b, b, a]
        vals += [g, g, -g, -g]
    shape = (split.size, split.size)
    if not rows:
        return sparse.csr_matrix(shape)
    return sparse.coo_matrix((np.concatenate(vals), (np.concatenate(rows), np.concatenate(cols))), shape=shape).tocsr()


def _joined(
    split: _Split, mesh: NamedMesh, contacts: Mapping[str, float], joints: Mapping[str, tuple[Patch, Patch]]
) -> sparse.csr_matrix:
    """G (mean of one face - mean of the other), written as the rank-one matrix G w w'."""
    total = sparse.csr_matrix((split.size, split.size))
    for name, patches in joints.items():
        (one, areas), (other, others) = (_face(split, mesh, p.part, p.facets) for p in patches)
        w = np.concatenate([areas / areas.sum(), -others / others.sum()])
        nodes = np.concatenate([one, other])
        block = contacts[name] * areas.sum() * np.outer(w, w)
        places = np.repeat(nodes, len(nodes)), np.tile(nodes, len(nodes))
        total = total + sparse.coo_matrix((block.ravel(), places), shape=total.shape)
    return total.tocsr()


def _face(split: _Split, mesh: NamedMesh, part: str, facets: Index) -> tuple[Index, Array]:
    nodes, inverse = np.unique(split.nodes(part, facets.ravel()), return_inverse=True)
    return nodes, np.bincount(inverse, split.thirds(part, mesh.points, facets))
