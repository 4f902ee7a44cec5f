"""What readings of a field of quadratic elements would lose if the temperature did not bend along an edge.

What a straight line leaves out, of the temperature and of a watt's influence on a reading, times the matrix: the first
order of the difference, edge by edge. Nothing is solved again.

Source: Becker and Rannacher 2001, "An optimal control approach to a posteriori error estimation", Acta Numerica 10.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from fem.matrices.assembly import FieldModel
from geom.arrays import Array as Floats


def linear_losses(field: FieldModel, K: sp.csr_array, T: Floats, influence: Floats) -> Floats:
    """(n, k) K that each reading loses by a straight line along the edge an unknown is the middle of; 0 at corners.

    K (n, n) W/K;  T (n,) K;  influence (n, k) K/W of a watt anywhere
    """
    return np.asarray(_bend(field, T[:, None]) * (K @ _bend(field, influence)))


def _bend(field: FieldModel, T: Floats) -> Floats:
    """(n, k) of T (n, k): at the middle of every edge above the mean of its ends, 0 at corners."""
    out = np.zeros_like(T)
    for block in field.blocks.values():
        corners, edges, mine = len(block.points), block.elements.middles, T[block.dofs]
        out[block.dofs][corners:] = mine[corners:] - (mine[edges // corners] + mine[edges % corners]) / 2
    return out
