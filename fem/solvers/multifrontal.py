"""Multifrontal Cholesky: a direct solver for many right-hand sides from dense BLAS alone, without any licence attached.

Source: Duff and Reid 1983; Liu 1992, "The multifrontal method for sparse matrix solution".
"""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np
import scipy.sparse as sp
from scipy.linalg import blas, lapack

from fem.solvers.dissection import Tree, dissect
from geom.arrays import Array as Floats
from geom.arrays import Ints
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
    upper = _upper(A, tree)
    reach: list[Ints] = []
    for i, below in enumerate(tree.children):
        lo, hi = tree.start[i], tree.start[i + 1]
        columns = [upper.indices[upper.indptr[lo] : upper.indptr[hi]], *(reach[c] for c in below)]
        rows = np.unique(np.concatenate(columns))
        reach.append(rows[rows >= hi].astype(np.int64))
    return Symbolic(tree, tuple(reach))


def factorise(A: sp.csr_array, symbolic: Symbolic) -> Factor:
    """Cholesky factor of a symmetric positive definite A (n, n) whose pattern lies within `symbolic`."""
    tree, upper = symbolic.tree, _upper(A, symbolic.tree)
    local = np.full(A.shape[0], -1, np.int64)
    room, filled = np.zeros(symbolic.size), 0  # one array: freed in pieces, it would leave holes that stay
    pivots: list[Floats] = []
    below: list[Floats] = []
    waiting: dict[int, Floats] = {}
    for i, children in enumerate(tree.children):
        lo, hi = int(tree.start[i]), int(tree.start[i + 1])
        reach = symbolic.reach[i]
        k, m = hi - lo, len(reach)
        local[lo:hi], local[reach] = np.arange(k), np.arange(k, k + m)
        square, under = room[filled : filled + k * k], room[filled + k * k : filled + k * (k + m)]
        L, B, filled = square.reshape((k, k), order="F"), under.reshape((m, k), order="F"), filled + k * (k + m)
        rest = np.zeros((m, m), order="F")
        _scatter(L, B, lo, hi, upper.indptr, upper.indices, upper.data, local)
        for c in children:
            _extend_add(L, B, rest, waiting.pop(c), local[symbolic.reach[c]])
        waiting[i] = _eliminate(L, B, rest)
        pivots.append(L)
        below.append(B)
    return Factor(symbolic, tuple(pivots), tuple(below))


def _eliminate(L: Floats, B: Floats, rest: Floats) -> Floats:
    """Overwrites a front's pivots (k, k) and what is below (m, k); `rest` (m, m) without them."""
    _, info = lapack.dpotrf(L, lower=1, clean=1, overwrite_a=1)
    if info:
        raise InputError(
            "the matrix is not positive definite", "solve", "a film or contact for every part, all above 0"
        )
    if not len(B):
        return rest
    blas.dtrsm(1.0, L, B, side=1, lower=1, trans_a=1, overwrite_b=1)
    return np.asarray(blas.dsyrk(-1.0, B, beta=1.0, c=rest, lower=1, overwrite_c=1))


def _upper(A: sp.csr_array, tree: Tree) -> sp.csr_array:
    return sp.csr_array(sp.triu(A[tree.order][:, tree.order], format="csr"))


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
    k = L.shape[0]
    for j in range(len(where)):
        for i in range(j, len(where)):
            row, column = where[i], where[j]
            if column >= k:
                rest[row - k, column - k] += update[i, j]
            elif row >= k:
                B[row - k, column] += update[i, j]
            else:
                L[row, column] += update[i, j]
