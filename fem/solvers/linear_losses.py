"""What readings of a field of quadratic elements would lose by linear ones in one part or another.

What linear elements cannot follow, of the temperature and of a watt's influence on a reading, times the matrix: the
first order of the difference, part by part. Nothing is solved again.

Source: Becker and Rannacher 2001, "An optimal control approach to a posteriori error estimation", Acta Numerica 10.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from fem.matrices.assembly import FieldModel
from geom.arrays import Array as Floats
from geom.arrays import Ints

Bools = NDArray[np.bool_]


def linear_losses(field: FieldModel, K: sp.csr_array, T: Floats, influence: Floats) -> dict[str, Floats]:
    """Part -> (2, k) K that each reading loses: by edges in the plane, and by those along the axis.

    K (n, n) W/K;  T (n,) K;  influence (n, k) K/W of a watt anywhere
    """
    bend, pull = _bend(field, T[:, None])[:, 0], K @ _bend(field, influence)
    lost, level = bend[:, None] * pull, _level(field)
    return {
        part: np.stack([lost[k[level[k]]].sum(axis=0), lost[k[~level[k]]].sum(axis=0)])
        for part, k in _bound(field).items()
    }


def _bound(field: FieldModel) -> dict[str, Ints]:
    """Part -> unknowns that linear elements in it bind: its own, and those of its neighbours where they touch."""
    out = {part: [np.arange(block.dofs.start, block.dofs.stop)] for part, block in field.blocks.items()}
    for touch in field.contacts.values():
        out[touch.a.part].append(touch.b.dofs)
        out[touch.b.part].append(touch.a.dofs)
    return {part: np.unique(np.concatenate(unknowns)) for part, unknowns in out.items()}


def _level(field: FieldModel) -> Bools:
    """(n,) whether an unknown is the middle of an edge that lies in the plane."""
    out = np.zeros(field.n, bool)
    for block in field.blocks.values():
        corners, edges, z = len(block.points), block.elements.middles, block.xyz[:, 2]
        a, b = edges // corners, edges % corners
        along = np.linalg.norm(block.xyz[a] - block.xyz[b], axis=1)
        out[block.dofs][corners:] = np.abs(z[a] - z[b]) < 0.5 * along
    return out


def _bend(field: FieldModel, T: Floats) -> Floats:
    """(n, k) of T (n, k): at the middle of every edge above the mean of its ends, 0 at corners."""
    out = np.zeros_like(T)
    for block in field.blocks.values():
        corners, edges, mine = len(block.points), block.elements.middles, T[block.dofs]
        out[block.dofs][corners:] = mine[corners:] - (mine[edges // corners] + mine[edges % corners]) / 2
    return out
