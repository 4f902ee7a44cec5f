"""Nested dissection by planes: an elimination order for meshes whose nodes have coordinates.

Source: George 1973, "Nested dissection of a regular finite element mesh"; of several cutting directions the
one with the smallest separator is kept, and thinned to the fewest nodes that do.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numba
import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import maximum_bipartite_matching

from geom.arrays import Array as Floats, Ints

DIRECTIONS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, -1, 0]]).T / 1.0
BALANCE = 0.35  # the smaller half holds at least this share
LEAF = 96  # unknowns of a part that is cut no further; chosen, only time hangs on it


class Graph(NamedTuple):
    """Neighbours of node i: indices[indptr[i]:indptr[i + 1]]."""

    indptr: Ints
    indices: Ints


@dataclass(frozen=True)
class Tree:
    """Elimination tree in postorder. order (n,): unknowns as eliminated; node i owns order[start[i]:start[i + 1]].

    children : of every node;  a leaf has none
    """

    order: Ints
    start: Ints
    children: tuple[tuple[int, ...], ...]


def dissect(A: sp.csr_array, xyz: Floats, leaf: int = LEAF) -> Tree:
    """Order the unknowns of a symmetric sparse matrix A (n, n) that sit at xyz (n, 3)."""
    owned: list[Ints] = []
    children: list[tuple[int, ...]] = []

    def visit(nodes: Ints, graph: Graph) -> int:
        if len(nodes) <= leaf:
            return keep(nodes, ())
        left, right, middle = _split(graph, xyz[nodes] @ DIRECTIONS)
        below = tuple(visit(nodes[s], Graph(*_among(*graph, s))) for s in (left, right) if len(s))
        return keep(nodes[middle], below)

    def keep(nodes: Ints, below: tuple[int, ...]) -> int:
        owned.append(nodes)
        children.append(below)
        return len(owned) - 1

    visit(np.arange(A.shape[0]), Graph(A.indptr, A.indices))
    start = np.concatenate([[0], np.cumsum([len(o) for o in owned])])
    return Tree(np.concatenate(owned), start, tuple(children))


def _split(graph: Graph, along: Floats) -> tuple[Ints, Ints, Ints]:
    """Two halves and what separates them (local numbers), by the best of the directions `along` (n, k)."""
    low = min((_below(s) for s in along.T), key=lambda low: _thickness(graph.indptr, graph.indices, low))
    middle = np.zeros(len(low), bool)
    for side in _least_cover(*_crossing(graph.indptr, graph.indices, low)):
        middle[side] = True
    return np.flatnonzero(low & ~middle), np.flatnonzero(~low & ~middle), np.flatnonzero(middle)


@numba.njit(cache=True)
def _thickness(indptr, indices, low):  # type: ignore[no-untyped-def]
    """How many nodes that side has an edge to the other from which has fewer."""
    met, below = np.zeros(len(low), np.bool_), 0
    for i in range(len(low)):
        if low[i]:
            crosses = False
            for p in range(indptr[i], indptr[i + 1]):
                if not low[indices[p]]:
                    met[indices[p]] = crosses = True
            below += crosses
    return min(below, np.sum(met))


@numba.njit(cache=True)
def _crossing(indptr, indices, low):  # type: ignore[no-untyped-def]
    """Ends of every edge from low to another node."""
    lows, highs = [], []
    for i in range(len(low)):
        if low[i]:
            for p in range(indptr[i], indptr[i + 1]):
                if not low[indices[p]]:
                    lows.append(i)
                    highs.append(indices[p])
    return np.array(lows, np.int64), np.array(highs, np.int64)


@numba.njit(cache=True)
def _among(indptr, indices, nodes):  # type: ignore[no-untyped-def]
    """The graph of some of the nodes, in their numbers."""
    local, start, count = np.full(len(indptr) - 1, -1, np.int32), np.zeros(len(nodes) + 1, np.int32), 0
    for k in range(len(nodes)):
        local[nodes[k]] = k
        count += indptr[nodes[k] + 1] - indptr[nodes[k]]
    out, count = np.empty(count, np.int32), 0
    for k in range(len(nodes)):
        for p in range(indptr[nodes[k]], indptr[nodes[k] + 1]):
            if local[indices[p]] >= 0:
                out[count] = local[indices[p]]
                count += 1
        start[k + 1] = count
    return start, out[:count].copy()


def _least_cover(low: Ints, high: Ints) -> tuple[Ints, Ints]:
    """The fewest ends, of either side, that meet every edge low[i]-high[i]: the thinnest separator along a cut.

    Koenig 1931: as many as a largest matching has edges. They are the low ends that no alternating path from an
    unmatched low end reaches, and the high ends that one does.
    """
    lows, i = np.unique(low, return_inverse=True)
    highs, j = np.unique(high, return_inverse=True)
    edges = sp.csr_array((np.ones(len(i), np.int8), (i, j)), shape=(len(lows), len(highs)))
    match = maximum_bipartite_matching(edges, perm_type="column")  # of every low end; -1: none
    partner = np.full(len(highs), -1)
    partner[match[match >= 0]] = np.flatnonzero(match >= 0)
    below, above, front = match < 0, np.zeros(len(highs), bool), np.flatnonzero(match < 0)
    while len(front):
        fresh = np.zeros(len(highs), bool)
        fresh[edges[front].indices] = True
        fresh &= ~above
        above |= fresh
        front = partner[fresh]  # all matched: a path that ended here would make the matching larger
        below[front] = True
    return lows[~below], highs[above]


def _below(s: Floats) -> NDArray[np.bool_]:
    """Cut at the widest gap of the sorted coordinate within the balanced middle, so grid planes stay whole."""
    order = np.argsort(s, kind="stable")
    first, last = int(BALANCE * len(s)), int((1 - BALANCE) * len(s))
    gap = np.diff(s[order[first : last + 1]])
    centre = 1 - np.abs(np.linspace(-1, 1, len(gap)))
    k = first + 1 + int(np.argmax(gap * (0.2 + centre))) if len(gap) and gap.max() > 1e-9 else len(s) // 2
    low = np.zeros(len(s), bool)
    low[order[:k]] = True
    return low
