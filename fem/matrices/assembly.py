"""Matrices of the whole machine, part by part: the nodes are split wherever two parts touch.

So every part keeps its own conduction (pure Neumann) and capacity matrix, and everything adjustable,
contact and film, enters linearly:

    K = K0 + sum_c g_c K_c + sum_p h_p K_p
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from fem.matrices.bends import Bends
from fem.matrices.block import Block, block_of
from fem.matrices.elements import HasTensor
from fem.matrices.surface import Film, Touch, Trace, touch_of, trace_of
from geom.arrays import Array as Floats, Ints
from geom.errors import InputError
from geom.meshing.mesh import NamedMesh

__all__ = ["Block", "FieldModel", "Film", "HasTensor", "Touch", "Trace", "assemble"]


@dataclass(frozen=True)
class FieldModel:
    """The machine's conduction: blocks by part, contacts and films by name; n unknowns, parts one after the other."""

    blocks: Mapping[str, Block]
    contacts: Mapping[str, Touch]
    films: Mapping[str, Film]

    @property
    def n(self) -> int:
        return sum(b.n for b in self.blocks.values())

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
        return _side_by_side([b.M for b in self.blocks.values()], [1.0] * len(self.blocks))

    def stiffness(
        self, films: Mapping[str, float], contacts: Mapping[str, float], conductivity: Mapping[str, float] | None = None
    ) -> sp.csr_array:
        """(n, n) matrix (W/K) for films h and contacts g (W/m2/K) and factors on the parts' conductivities."""
        factor = conductivity or {}
        parts = [_spread(f.trace.mass, f.trace.dofs, f.trace.dofs, films[p]) for p, f in self.films.items()]
        for name, t in self.contacts.items():
            g, across = contacts[name], _spread(t.cross, t.a.dofs, t.b.dofs, -contacts[name])
            parts += [_spread(side.mass, side.dofs, side.dofs, g) for side in (t.a, t.b)]
            parts += [across, (across[1], across[0], across[2])]
        K = _side_by_side([b.K for b in self.blocks.values()], [factor.get(p, 1.0) for p in self.blocks])
        return sp.csr_array(K + _summed(parts, self.n)) if parts else K

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
        out[block.dofs] = block.elements.nodal(watts)
        return out / out.sum()

    def losses(self, watts: Mapping[str, float]) -> Floats:
        """(n,) load (W) of a loss per part, uniform in each; it sums to exactly what was declared."""
        return sum((q * self.load(part) for part, q in watts.items()), np.zeros(self.n))

    def flux(self, face: str) -> Floats:
        """(n,) load of 1 W through a face, the same flux everywhere on it."""
        return self.face_mean(self.film(face).trace)

    def film(self, face: str) -> Film:
        if face not in self.films:
            raise InputError(f"unknown face '{face}'", "field", f"known: {', '.join(self.films)}")
        return self.films[face]

    def spread(self, local: sp.csr_array, dofs: Ints) -> sp.csr_array:
        """(n, n) matrix that is `local` (m, m) at dofs (m,) and zero elsewhere."""
        return _summed([_spread(local, dofs, dofs, 1.0)], self.n)

    def face_mean(self, trace: Trace) -> Floats:
        """(n,) row that gives the mean temperature of one side of a surface."""
        row = np.zeros(self.n)
        row[trace.dofs] = trace.b / trace.area
        return row

    def block(self, part: str) -> Block:
        if part not in self.blocks:
            raise InputError(f"unknown part '{part}'", "field", f"known: {', '.join(self.blocks)}")
        return self.blocks[part]


def assemble(
    mesh: NamedMesh,
    conductivity: Mapping[str, HasTensor],
    capacity: Mapping[str, float],
    quadratic: Collection[str] = (),
    bends: Bends | None = None,
) -> FieldModel:
    """Matrices of every part, contact and film.

    conductivity : part -> tensor field (W/m/K);  capacity : part -> rho cp (J/m3/K)
    quadratic : parts on quadratic elements;  bends : where others have them, None for nowhere
    """
    for what, table in (("conductivity", conductivity), ("heat capacity", capacity)):
        if missing := [p for p in mesh.parts if p not in table]:
            raise InputError(f"no {what} for {', '.join(missing)}", "assemble", "one value for every part")
    blocks: dict[str, Block] = {}
    start = 0
    for i, part in enumerate(mesh.parts):
        midsides = part in quadratic or (bends is not None and bends.of(part))
        blocks[part] = block_of(mesh, i, start, conductivity[part], capacity[part], midsides)
        start = blocks[part].dofs.stop
    films = {name: Film(trace_of(mesh, blocks[p.part], p.facets), p.fluid) for name, p in mesh.patches.items()}
    contacts = {
        name: touch_of(trace_of(mesh, blocks[c.a], c.facets), trace_of(mesh, blocks[c.b], c.facets))
        for name, c in mesh.contacts.items()
    }
    return FieldModel(blocks, contacts, films)


def _side_by_side(blocks: list[sp.csr_array], factors: list[float]) -> sp.csr_array:
    """Block-diagonal matrix of the parts."""
    start = np.cumsum([0, *(b.shape[0] for b in blocks)])
    filled = np.cumsum([0, *(b.nnz for b in blocks)])
    data = np.concatenate([f * b.data for f, b in zip(factors, blocks, strict=True)])
    indices = np.concatenate([b.indices + s for b, s in zip(blocks, start[:-1].astype(np.int32), strict=True)])
    indptr = np.concatenate(
        [[0], *(b.indptr[1:] + f for b, f in zip(blocks, filled[:-1].astype(np.int32), strict=True))]
    )
    return sp.csr_array((data, indices, indptr.astype(np.int32)), (start[-1], start[-1]))


def _spread(mass: sp.csr_array, rows: Ints, cols: Ints, factor: float) -> tuple[Ints, Ints, Floats]:
    m = mass.tocoo()
    return rows[m.row], cols[m.col], factor * m.data


def _summed(parts: list[tuple[Ints, Ints, Floats]], n: int) -> sp.csr_array:
    row, col, val = (np.concatenate(c) for c in zip(*parts, strict=True))
    return sp.csr_array(sp.coo_array((val, (row, col)), (n, n)))
