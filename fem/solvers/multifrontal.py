"""Multifrontal Cholesky: a direct solver for many right-hand sides from dense BLAS alone, without any licence attached.

Source: Duff and Reid 1983; Liu 1992, "The multifrontal method for sparse matrix solution".
"""

from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack

from fem.solvers.dissection import Tree, dissect
from geom.arrays import Array as Floats, Ints
from geom.errors import InputError


@dataclass(frozen=True)
class Symbolic:
    """The pattern of the factor: tree, and the later unknowns (as eliminated) that each node's front reaches."""

    tree: Tree
    reach: tuple[Ints, ...]

    @property
    def size(self) -> int:
        """Numbers stored in the factor."""
        widths = np.diff(self.tree.start)
        return int(sum(o * (o + len(r)) for o, r in zip(widths, self.reach, strict=True)))

    @property
    def room(self) -> int:
        """Numbers that factorising takes: the factor, and the updates that stand at once."""
        return self.size + int(self.fronts[1].sum())

    @cached_property
    def fronts(self) -> tuple[Ints, Ints]:
        """Where the update of every node begins on one of two stacks, and their heights: the lower one is of nodes
        whose distance to the root is even. Postorder keeps a node's children on top of the other stack."""
        depth = np.zeros(len(self.reach), np.int64)
        for i in range(len(depth) - 1, -1, -1):
            depth[[*self.tree.children[i]]] = depth[i] + 1
        begin, top, heights = np.zeros_like(depth), [0, 0], np.zeros(2, np.int64)
        for i, children in enumerate(self.tree.children):
            mine = int(depth[i]) % 2
            begin[i] = top[mine]
            top[mine] += len(self.reach[i]) ** 2
            heights[mine] = max(heights[mine], top[mine])
            if children:
                top[1 - mine] = begin[children[0]]
        return begin + np.where(depth % 2, heights[0], 0), heights


@dataclass(frozen=True)
class Factor:
    """A = L L': dense panels, pivots (k, k) and below (m, k), of every node."""

    symbolic: Symbolic
    pivots: tuple[Floats, ...]
    below: tuple[Floats, ...]

    def __call__(self, b: Floats) -> Floats:
        """Solve A x = b for b (n,) or (n, k)."""
        s, t, shape = self.symbolic, self.symbolic.tree, b.shape
        x = np.ascontiguousarray(b[t.order].reshape(len(b), -1))
        del b  # it may be of no more use to whoever asked
        for i, (L, B) in enumerate(zip(self.pivots, self.below, strict=True)):
            mine = slice(t.start[i], t.start[i + 1])
            x[mine] = blas.dtrsm(1.0, L, x[mine].T, side=1, lower=1, trans_a=1).T
            x[s.reach[i]] -= B @ x[mine]
        for i in range(len(self.pivots) - 1, -1, -1):
            mine = slice(t.start[i], t.start[i + 1])
            rest = x[mine] - self.below[i].T @ x[s.reach[i]]
            x[mine] = blas.dtrsm(1.0, self.pivots[i], rest.T, side=1, lower=1).T
        out = np.empty_like(x)
        out[t.order] = x
        return out.reshape(shape)


def analyse(A: sp.csr_array, xyz: Floats) -> Symbolic:
    """Order and pattern of A (n, n), unknowns at xyz (n, 3): done once for all matrices of the same pattern."""
    tree = dissect(A, xyz)
    indptr, indices, _ = _upper(A.indptr, A.indices, A.data, tree.order)
    reach: list[Ints] = []
    for i, below in enumerate(tree.children):
        lo, hi = tree.start[i], tree.start[i + 1]
        columns = [indices[indptr[lo] : indptr[hi]], *(reach[c] for c in below)]
        rows = np.unique(np.concatenate(columns))
        reach.append(rows[rows >= hi].astype(np.int64))
    return Symbolic(tree, tuple(reach))


def factorise(A: sp.csr_array, symbolic: Symbolic, room: Floats | None = None) -> Factor:
    """Cholesky factor of a symmetric positive definite A (n, n) whose pattern lies within `symbolic`.

    room (symbolic.room,) : where the factor goes; a factor that was there before is no more
    """
    tree = symbolic.tree
    indptr, indices, data = _upper(A.indptr, A.indices, A.data, tree.order)
    local = np.full(A.shape[0], -1, np.int64)
    begin, heights = symbolic.fronts
    # One array: freed in pieces, it would leave holes that stay.
    room, filled = np.empty(symbolic.room) if room is None else room, int(heights.sum())
    pivots: list[Floats] = []
    below: list[Floats] = []
    updates: list[Floats] = []
    for i, children in enumerate(tree.children):
        lo, hi = int(tree.start[i]), int(tree.start[i + 1])
        reach = symbolic.reach[i]
        k, m = hi - lo, len(reach)
        local[lo:hi], local[reach] = np.arange(k), np.arange(k, k + m)
        square, under = room[filled : filled + k * k], room[filled + k * k : filled + k * (k + m)]
        L, B, filled = square.reshape((k, k), order="F"), under.reshape((m, k), order="F"), filled + k * (k + m)
        rest = room[begin[i] : begin[i] + m * m].reshape((m, m), order="F")
        for front in (L, B, rest):
            front.fill(0.0)
        _scatter(L, B, lo, hi, indptr, indices, data, local)
        for c in children:
            _extend_add(L, B, rest, updates[c], local[symbolic.reach[c]])
        _eliminate(L, B, rest)
        updates.append(rest)
        pivots.append(L)
        below.append(B)
    return Factor(symbolic, tuple(pivots), tuple(below))


def _eliminate(L: Floats, B: Floats, rest: Floats) -> None:
    """Overwrites a front's pivots (k, k), what is below (m, k), and the rest (m, m), which has lost them then."""
    _, info = lapack.dpotrf(L, lower=1, clean=1, overwrite_a=1)
    if info:
        raise InputError(
            "the matrix is not positive definite", "solve", "a film or contact for every part, all above 0"
        )
    if len(B):
        blas.dtrsm(1.0, L, B, side=1, lower=1, trans_a=1, overwrite_b=1)
        blas.dsyrk(-1.0, B, beta=1.0, c=rest, lower=1, overwrite_c=1)


@numba.njit(cache=True)
def _upper(indptr, indices, data, order):  # type: ignore[no-untyped-def]
    """Rows of a symmetric matrix as eliminated, from the diagonal on: indptr, indices (in no order) and data."""
    n = len(order)
    place, start = np.empty(n, np.int64), np.zeros(n + 1, np.int64)
    for i in range(n):
        place[order[i]] = i
    for i in range(n):
        start[i + 1] = start[i]
        for p in range(indptr[order[i]], indptr[order[i] + 1]):
            start[i + 1] += place[indices[p]] >= i
    columns, values = np.empty(start[n], np.int32), np.empty(start[n])
    filled = 0
    for i in range(n):
        for p in range(indptr[order[i]], indptr[order[i] + 1]):
            if place[indices[p]] >= i:
                columns[filled], values[filled] = place[indices[p]], data[p]
                filled += 1
    return start, columns, values


@numba.njit(cache=True)
def _scatter(L, B, lo, hi, indptr, indices, data, local):  # type: ignore[no-untyped-def]
    k = hi - lo
    for row in range(lo, hi):
        for p in range(indptr[row], indptr[row + 1]):
            i = local[indices[p]]
            if i < k:
                L[i, row - lo] += data[p]
            else:
                B[i - k, row - lo] += data[p]


@numba.njit(cache=True)
def _extend_add(L, B, rest, update, where):  # type: ignore[no-untyped-def]
    k, inside = L.shape[0], 0
    while inside < len(where) and where[inside] < k:
        inside += 1
    for j in range(len(where)):
        column = where[j]
        if j < inside:
            for i in range(j, inside):
                L[where[i], column] += update[i, j]
            for i in range(inside, len(where)):
                B[where[i] - k, column] += update[i, j]
        else:
            for i in range(j, len(where)):
                rest[where[i] - k, column - k] += update[i, j]
