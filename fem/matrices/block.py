"""One part of the machine: its own conduction (nothing flows through its skin) and heat capacity."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from fem.matrices import kernels
from fem.matrices.bends import edge_table
from fem.matrices.elements import Elements, HasTensor, Midsides
from geom.arrays import Array as Floats, Ints
from geom.errors import InputError
from geom.meshing.mesh import NamedMesh


@dataclass(frozen=True)
class Block:
    """One part: points (m,) its corners' numbers in the mesh; tets (nt, 4) and volumes (nt,) (m3) in its own numbering.

    elements : what its n unknowns are, the m corners first
    dofs : its slice of the whole;  K : (n, n) conduction (W/K);  M : (n, n) capacity (J/K);  w : (n,) Int N (m3)
    """

    name: str
    points: Ints
    elements: Elements
    volumes: Floats
    dofs: slice
    K: sp.csr_array
    M: sp.csr_array
    w: Floats
    rho_cp: float

    @property
    def n(self) -> int:
        return len(self.elements.xyz)

    @property
    def xyz(self) -> Floats:
        """(n, 3) points of its unknowns (m)."""
        return self.elements.xyz

    @property
    def tets(self) -> Ints:
        return self.elements.tets

    @property
    def volume(self) -> float:
        """m3"""
        return float(self.w.sum())

    @property
    def capacity(self) -> float:
        """J/K"""
        return self.rho_cp * self.volume

    @property
    def bending(self) -> Floats:
        """(n - m, 6) the edges whose middles are unknowns, as of edge_table."""
        m, edges = len(self.points), self.elements.middles
        return edge_table(self.xyz[edges // m], self.xyz[edges % m])

    @cached_property
    def pieces(self) -> Ints:
        """(nt,) number of the connected piece each tetrahedron belongs to (the four coils of one winding)."""
        return sp.csgraph.connected_components(self.K, directed=False)[1][self.tets[:, 0]].astype(np.int64)

    def mass(self, density: Floats) -> sp.csr_array:
        """(n, n) Int density N N' for a density (nt,) per m3."""
        return self.elements.mass(density * self.volumes)


def block_of(
    mesh: NamedMesh, number: int, start: int, conductivity: HasTensor, rho_cp: float, midsides: Midsides = False
) -> Block:
    """Part `number` of a mesh; its unknowns begin at `start`."""
    mine = mesh.region == number
    cells = mesh.tets if mine.all() else mesh.tets[mine]
    if len(cells) == 0:
        raise InputError("no tetrahedron", f"part '{mesh.parts[number]}'", "a part with a volume")
    points, tets = renumbered(cells, len(mesh.points))
    xyz = np.ascontiguousarray(mesh.points[points])
    volumes = kernels.volumes(xyz, tets)
    elements = Elements.on(tets, xyz, midsides)
    dofs = slice(start, start + len(elements.xyz))
    K, M, w = elements.conduction(conductivity), elements.mass(rho_cp * volumes), elements.nodal(volumes)
    return Block(mesh.parts[number], points, elements, volumes, dofs, K, M, w, rho_cp)


def renumbered(cells: Ints, n: int) -> tuple[Ints, Ints]:
    """The point numbers (below n) that cells use, ascending, and the cells in terms of them."""
    mask = np.zeros(n, bool)
    mask[cells] = True
    if mask.all():
        return np.arange(n), np.ascontiguousarray(cells)
    return np.flatnonzero(mask), (np.cumsum(mask) - 1)[cells]
