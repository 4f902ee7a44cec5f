"""Conductivity across a bundle of wires: by formula where it holds, by a unit-cell solution where it does not.

The formula (Hashin and Shtrikman) is good to 0.7 % up to a fill of 60 %, and 10 % low at 80 %, where round wires almost
touch (hexagonal packing; a square one, which leaves less room between neighbours, is 8 % and worse). Flat wires have a
cell of their own (`flat_cell`), for any fill.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree
from skfem import Basis, BilinearForm, ElementQuad2, ElementTriP2, MeshQuad, MeshTri, MeshTri2, condense, solve
from skfem.helpers import dot, grad

from fem.matrices.material import Conductivity, wound
from geom.arrays import Array as Floats
from geom.description.materials import Mixture, winding_conductivity
from geom.errors import InputError

FORMULA_UP_TO = 0.65  # of copper and enamel (Simpson, Wrobel, Mellor 2013); denser wires by their unit cell


@dataclass(frozen=True)
class Packing:
    """A lattice of wires: each sits in the middle of a regular polygon that tiles the plane."""

    name: str
    sides: int

    @property
    def area(self) -> float:
        """Of the polygon whose inscribed circle has radius 1."""
        return self.sides * float(np.tan(np.pi / self.sides))

    @property
    def largest_fill(self) -> float:
        """Share of the plane when wires touch."""
        return np.pi / self.area


HEXAGONAL = Packing("hexagonal", 6)
SQUARE = Packing("square", 4)


def bundle(
    fill: float,
    k_conductor: float,
    k_resin: float,
    enamel: float = 0.0,
    k_enamel: float = 0.2,
    packing: Packing = HEXAGONAL,
) -> Conductivity:
    """Conductivity of wires along z in resin, across and along (W/m/K).

    fill : share of copper;  enamel : share of wire insulation, both of the cross-section. Up to 65 % of copper and
    enamel by the formula, resin and enamel mixed by volume (Simpson, Wrobel, Mellor 2013); above, by the unit cell.
    """
    rest = 1 - fill
    filler = (enamel * k_enamel + (rest - enamel) * k_resin) / rest
    across, along = winding_conductivity(fill, k_conductor, filler)
    if fill + enamel > FORMULA_UP_TO:
        across = unit_cell([(fill, k_conductor), (enamel, k_enamel)], k_resin, packing)
    return wound(along, across)


@cache
def homogenised(winding: Mixture) -> Conductivity:
    """Conductivity of a winding, wires along z: up to 65 % of conductor by the formula, above by its unit cell.

    Of a layer of single bars that of its copper, every way.
    """
    fill, k, between = winding.fill, winding.k_conductor, winding.k_between
    if winding.shape == "bar":
        across = along = fill * k + (1 - fill) * between
    elif winding.shape == "flat" and fill > FORMULA_UP_TO:
        across, along = flat_cell(fill, k, between), fill * k + (1 - fill) * between
    else:
        straight = bundle(fill, k, between)
        across, along = straight.k_r, straight.k_z
    return wound(winding.along * along + (1 - winding.along) * across, across)


def flat_cell(fill: float, k_conductor: float, k_resin: float, cells: int = 12) -> float:
    """Conductivity (W/m/K) across square conductors in square order, the same resin all round; fill below 1.

    A quarter of one cell carries all: opposite sides at given temperatures, the others insulated by symmetry.
    cells : elements across the conductor's half and across the resin's, finer towards the corner
    """
    if not 0 < fill < 1:
        raise InputError(f"a fill of {fill:.3g}", "flat wires", "above 0 and below 1")
    edge, towards = np.sqrt(fill), np.linspace(0.0, 1.0, cells + 1) ** 2
    x = np.concatenate([edge * (1 - towards[::-1]), edge + (1 - edge) * towards[1:]])
    mesh = MeshQuad.init_tensor(x, x)
    inside = np.flatnonzero((mesh.p[:, mesh.t].mean(1) < edge).all(0))
    rest = np.setdiff1d(np.arange(mesh.nelements), inside)
    K = sum(
        k * _laplace.assemble(Basis(mesh, ElementQuad2(), elements=elements))
        for k, elements in ((k_conductor, inside), (k_resin, rest))
    )
    basis = Basis(mesh, ElementQuad2())
    cold, hot = (basis.get_dofs(lambda p, at=at: np.abs(p[0] - at) < 1e-12).all() for at in (0.0, 1.0))
    fixed = np.zeros(basis.N)
    fixed[hot] = 1.0
    T = solve(*condense(K, np.zeros(basis.N), x=fixed, D=np.concatenate([cold, hot])))
    return float(T @ (K @ T))


def unit_cell(
    rings: Sequence[tuple[float, float]], k_resin: float, packing: Packing = HEXAGONAL, around: int = 16, out: int = 8
) -> float:
    """Conductivity (W/m/K) of a periodic array of round wires, by quadratic curved finite elements on one cell.

    rings : (share of the cell, conductivity W/m/K) from the axis outwards, e.g. copper then enamel
    around : elements along a side of the polygon;  out : elements across the resin
    """
    shares = np.cumsum([share for share, _ in rings])
    if not 0 < shares[-1] < packing.largest_fill:
        raise InputError(f"a fill of {shares[-1]:.3g}", f"{packing.name} packing", f"below {packing.largest_fill:.3f}")
    present = [(share, k) for share, k in rings if share > 0]
    radii = np.sqrt(np.cumsum([share for share, _ in present]) * packing.area / np.pi)
    mesh, ring = _mesh(radii, packing.sides, around, out)
    basis = Basis(mesh, ElementTriP2(), intorder=4)
    K = sum(
        k * _laplace.assemble(Basis(mesh, ElementTriP2(), elements=np.flatnonzero(ring == i), intorder=4))
        for i, k in enumerate([*(k for _, k in present), k_resin])
    )
    P = _periodic(basis.doflocs, packing.sides)
    x = basis.doflocs[0]
    free = P[:, 1:]
    T = x + free @ spsolve(sp.csc_array(free.T @ K @ free), -free.T @ (K @ x))
    return float(T @ (K @ T)) / packing.area


@BilinearForm
def _laplace(u, v, w):  # type: ignore[no-untyped-def]
    return dot(grad(u), grad(v))


def _mesh(radii: Floats, sides: int, around: int, out: int) -> tuple[MeshTri2, NDArray[np.int64]]:
    """Curved triangles of the polygon with inscribed circle 1 about a wire with layers, and each one's ring."""
    theta = 2 * np.pi * np.arange(sides * around) / (sides * around)
    edge = 1 / np.cos((theta + np.pi / sides) % (2 * np.pi / sides) - np.pi / sides)
    inner = [radii[0] * s for s in (0.35, 0.7)]
    levels = [*(np.full(len(theta), r) for r in (*inner, *radii))]
    levels += [radii[-1] + (edge - radii[-1]) * s for s in np.arange(1, out + 1) / out]
    points = np.column_stack([np.zeros(2), *(r * np.stack([np.cos(theta), np.sin(theta)]) for r in levels)])
    j, n = np.arange(len(theta)), len(theta)
    nxt = (j + 1) % n
    cells = [np.stack([np.zeros(n, int), 1 + j, 1 + nxt])]
    for k in range(len(levels) - 1):
        a, b = 1 + k * n, 1 + (k + 1) * n
        cells += [np.stack([a + j, b + j, b + nxt]), np.stack([a + j, b + nxt, a + nxt])]
    ring = np.repeat([0, 0, 0, *range(1, len(radii)), *[len(radii)] * out], [n] + [2 * n] * (len(levels) - 1))
    mesh = MeshTri(points, np.column_stack(cells))
    curved = MeshTri2.from_mesh(mesh)
    ends = np.hypot(*mesh.p[:, mesh.facets])
    follow = (np.abs(ends[0] - ends[1]) < 1e-12) & (ends[0] < radii[-1] + 1e-12)
    middle = curved.doflocs[:, mesh.nvertices :]
    middle[:, follow] *= (ends[0] / np.hypot(*middle))[follow]
    return curved, ring


def _periodic(x: Floats, sides: int) -> sp.csr_array:
    """(n, m) map from independent values to all: points (2, n) a lattice vector apart share one."""
    tree, n = cKDTree(x.T), x.shape[1]
    pairs = []
    for k in range(sides // 2):
        shift = 2 * np.array([np.cos(2 * np.pi * k / sides), np.sin(2 * np.pi * k / sides)])
        far, near = tree.query(x.T + shift)
        pairs.append(np.stack([np.flatnonzero(far < 1e-9), near[far < 1e-9]]))
    i, j = np.concatenate(pairs, 1)
    count, label = sp.csgraph.connected_components(sp.coo_array((np.ones(len(i)), (i, j)), (n, n)), directed=False)
    return sp.csr_array((np.ones(n), (np.arange(n), label)), (n, count))
