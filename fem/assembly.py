"""Matrices of the whole machine, part by part: the nodes are split wherever two parts touch.

So every part keeps its own conduction (pure Neumann) and capacity matrix, and everything adjustable,
contact and film, enters linearly:

    K = K0 + sum_c g_c K_c + sum_p h_p K_p
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from skfem import MappingAffine, MeshTet

from geom.errors import InputError
from geom.mesh import NamedMesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class HasTensor(Protocol):
    def tensor(self, x: Floats) -> Floats:
        """(n, 3, 3) conductivity (W/m/K) at points x (n, 3)."""
        ...


@dataclass(frozen=True)
class Block:
    """One part: points (n,) its numbers in the mesh; tets (nt, 4) and volumes (nt,) (m3) in its own numbering.

    dofs : its slice of the whole;  K : (n, n) conduction (W/K);  M : (n, n) capacity (J/K);  w : (n,) Int N (m3)
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
        n = len(self.points)
        edges = sp.coo_array((np.ones(self.tets.size), (np.repeat(self.tets[:, 0], 4), self.tets.ravel())), (n, n))
        return sp.csgraph.connected_components(edges, directed=False)[1][self.tets[:, 0]].astype(np.int64)


@dataclass(frozen=True)
class Trace:
    """One side of a surface: dofs (m,) of the whole, mass (m, m) Int N N' (m2), b (m,) Int N (m2)."""

    part: str
    dofs: Ints
    mass: sp.csr_array
    b: Floats

    @property
    def area(self) -> float:
        """m2"""
        return float(self.b.sum())


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


@dataclass(frozen=True)
class FieldModel:
    """The machine's conduction: blocks by part, contacts and films by name; n unknowns, parts one after the other."""

    blocks: Mapping[str, Block]
    contacts: Mapping[str, Touch]
    films: Mapping[str, Film]

    @property
    def n(self) -> int:
        return sum(len(b.points) for b in self.blocks.values())

    @property
    def xyz(self) -> Floats:
        """(n, 3) coordinates of the unknowns (m)."""
        return np.concatenate([b.xyz for b in self.blocks.values()])

    @property
    def fluids(self) -> tuple[str, ...]:
        return tuple(sorted({f.fluid for f in self.films.values()}))

    @cached_property
    def M(self) -> sp.csr_array:
        """(n, n) capacity matrix (J/K)."""
        return sp.csr_array(sp.block_diag([b.M for b in self.blocks.values()], format="csr"))

    def stiffness(
        self, films: Mapping[str, float], contacts: Mapping[str, float], conductivity: Mapping[str, float] | None = None
    ) -> sp.csr_array:
        """(n, n) matrix (W/K) for films h and contacts g (W/m2/K) and factors on the parts' conductivities."""
        factor = conductivity or {}
        K = sp.coo_array(sp.block_diag([factor.get(p, 1.0) * b.K for p, b in self.blocks.items()], format="coo"))
        parts = [(K.row, K.col, K.data)]
        parts += [_spread(f.trace.mass, f.trace.dofs, f.trace.dofs, films[p]) for p, f in self.films.items()]
        for name, t in self.contacts.items():
            for i, j, sign in ((t.a, t.a, 1), (t.b, t.b, 1), (t.a, t.b, -1), (t.b, t.a, -1)):
                parts.append(_spread(t.a.mass, i.dofs, j.dofs, sign * contacts[name]))
        row, col, val = (np.concatenate(c) for c in zip(*parts, strict=True))
        return sp.csr_array(sp.coo_array((val, (row, col)), (self.n, self.n)))

    def mean(self, part: str) -> Floats:
        """(n,) row that gives the mean temperature of a part."""
        block = self.block(part)
        row = np.zeros(self.n)
        row[block.dofs] = block.w / block.volume
        return row

    def load(self, part: str, density: Callable[[Floats], Floats] | Floats | None = None) -> Floats:
        """(n,) load of exactly 1 W in a part, spread like `density` (per tetrahedron, or of its centre)."""
        block = self.block(part)
        q = np.ones(len(block.tets)) if density is None else density
        q = np.asarray(q(block.xyz[block.tets].mean(1)) if callable(q) else q, float)
        watts = q * block.volumes
        if not watts.sum() > 0:
            raise InputError("a loss zone without volume", f"part '{part}'", "a density above 0 somewhere in the part")
        out = np.zeros(self.n)
        out[block.dofs] = np.bincount(block.tets.ravel(), np.repeat(watts / 4, 4), len(block.points))
        return out / out.sum()

    def face_mean(self, trace: Trace) -> Floats:
        """(n,) row that gives the mean temperature of one side of a surface."""
        row = np.zeros(self.n)
        row[trace.dofs] = trace.b / trace.area
        return row

    def block(self, part: str) -> Block:
        if part not in self.blocks:
            raise InputError(f"unknown part '{part}'", "field", f"known: {', '.join(self.blocks)}")
        return self.blocks[part]


def assemble(mesh: NamedMesh, conductivity: Mapping[str, HasTensor], capacity: Mapping[str, float]) -> FieldModel:
    """Matrices of every part, contact and film.

    conductivity : part -> tensor field (W/m/K);  capacity : part -> rho cp (J/m3/K)
    """
    for what, given in (("conductivity", conductivity), ("heat capacity", capacity)):
        if missing := [p for p in mesh.parts if p not in given]:
            raise InputError(f"no {what} for {', '.join(missing)}", "assemble", "one value for every part")
    blocks: dict[str, Block] = {}
    start = 0
    for i, part in enumerate(mesh.parts):
        blocks[part] = _block(mesh, i, start, conductivity[part], capacity[part])
        start = blocks[part].dofs.stop
    films = {name: Film(_trace(mesh, blocks[p.part], p.facets), p.fluid) for name, p in mesh.patches.items()}
    contacts = {
        name: Touch(_trace(mesh, blocks[c.a], c.facets), _trace(mesh, blocks[c.b], c.facets))
        for name, c in mesh.contacts.items()
    }
    return FieldModel(blocks, contacts, films)


def _block(mesh: NamedMesh, number: int, start: int, conductivity: HasTensor, rho_cp: float) -> Block:
    chosen = mesh.tets[mesh.region == number]
    if len(chosen) == 0:
        raise InputError("no tetrahedron", f"part '{mesh.parts[number]}'", "a part with a volume")
    points, tets = np.unique(chosen, return_inverse=True)
    tets = tets.reshape(-1, 4)
    xyz = mesh.points[points]
    map_ = MappingAffine(MeshTet(np.ascontiguousarray(xyz.T), np.ascontiguousarray(tets.T)))
    volumes = np.abs(map_.detA) / 6
    n = len(points)
    w: Floats = np.bincount(tets.ravel(), np.repeat(volumes / 4, 4), n).astype(float)
    K = _accumulate(_stiffness(map_.invA, volumes, conductivity.tensor(xyz[tets].mean(1))), tets, n)
    M = _accumulate(rho_cp / 20 * volumes[:, None, None] * (1 + np.eye(4)), tets, n)
    return Block(mesh.parts[number], points, xyz, tets, volumes, slice(start, start + n), K, M, w, rho_cp)


def _stiffness(inverse: Floats, volumes: Floats, k: Floats) -> Floats:
    """(nt, 4, 4) Int grad N_i . k grad N_j; gradients are constant, so k at the centre is a second-order rule."""
    inner = np.moveaxis(inverse, 2, 0)
    grad = np.concatenate([-inner.sum(1, keepdims=True), inner], 1)
    return grad @ (k * volumes[:, None, None]) @ grad.transpose(0, 2, 1)


def _accumulate(local: Floats, cells: Ints, n: int) -> sp.csr_array:
    k = cells.shape[1]
    rows, cols = np.repeat(cells, k, axis=1).ravel(), np.tile(cells, k).ravel()
    return sp.csr_array(sp.coo_array((local.ravel(), (rows, cols)), (n, n)))


def _trace(mesh: NamedMesh, block: Block, facets: Ints) -> Trace:
    points, local = np.unique(facets, return_inverse=True)
    local = local.reshape(-1, 3)
    position = np.searchsorted(block.points, points)
    if not np.array_equal(block.points[np.minimum(position, len(block.points) - 1)], points):
        raise InputError(
            "a facet has points outside its part", f"part '{block.name}'", "facets of the part's own tetrahedra"
        )
    edge = mesh.points[facets[:, 1:]] - mesh.points[facets[:, :1]]
    areas = np.linalg.norm(np.cross(edge[:, 0], edge[:, 1]), axis=1) / 2
    mass = _accumulate(areas[:, None, None] / 12 * (1 + np.eye(3)), local, len(points))
    b: Floats = np.bincount(local.ravel(), np.repeat(areas / 3, 3), len(points)).astype(float)
    return Trace(block.name, block.dofs.start + position, mass, b)


def _spread(mass: sp.csr_array, rows: Ints, cols: Ints, factor: float) -> tuple[Ints, Ints, Floats]:
    m = mass.tocoo()
    return rows[m.row], cols[m.col], factor * m.data
