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
        s, t = self.symbolic, self.symbolic.tree
        x = np.ascontiguousarray(b[t.order].reshape(len(b), -1))
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
        return out.reshape(b.shape)


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
    pivots: list[Floats] = []
    below: list[Floats] = []
    waiting: dict[int, Floats] = {}
    for i, children in enumerate(tree.children):
        lo, hi = int(tree.start[i]), int(tree.start[i + 1])
        k, reach = hi - lo, symbolic.reach[i]
        local[lo:hi], local[reach] = np.arange(k), np.arange(k, k + len(reach))
        mine, rest = np.zeros((k + len(reach), k), order="F"), np.zeros((len(reach), len(reach)), order="F")
        _scatter(mine, lo, hi, upper.indptr, upper.indices, upper.data, local)
        for c in children:
            _extend_add(mine, rest, waiting.pop(c), local[symbolic.reach[c]])
        L, B, waiting[i] = _eliminate(mine, rest)
        pivots.append(L)
        below.append(B)
    return Factor(symbolic, tuple(pivots), tuple(below))


def _eliminate(mine: Floats, rest: Floats) -> tuple[Floats, Floats, Floats]:
    """Factor of a front's own columns (k + m, k), and what `rest` (m, m), overwritten, becomes without them."""
    k = mine.shape[1]
    L, info = lapack.dpotrf(mine[:k], lower=1, clean=1)
    if info:
        raise InputError(
            "the matrix is not positive definite", "solve", "a film or contact for every part, all above 0"
        )
    B = blas.dtrsm(1.0, L, mine[k:], side=1, lower=1, trans_a=1)
    return L, B, blas.dsyrk(-1.0, B, beta=1.0, c=rest, lower=1, overwrite_c=1) if len(B) else rest


def _upper(A: sp.csr_array, tree: Tree) -> sp.csr_array:
    return sp.csr_array(sp.triu(A[tree.order][:, tree.order], format="csr"))


@numba.njit(cache=True)
def _scatter(mine, lo, hi, indptr, indices, data, local):  # type: ignore[no-untyped-def]
    for row in range(lo, hi):
        for p in range(indptr[row], indptr[row + 1]):
            mine[local[indices[p]], row - lo] += data[p]


@numba.njit(cache=True)
def _extend_add(mine, rest, update, where):  # type: ignore[no-untyped-def]
    k = mine.shape[1]
    for j in range(len(where)):
        if where[j] < k:
            for i in range(j, len(where)):
                mine[where[i], where[j]] += update[i, j]
        else:
            for i in range(j, len(where)):
                rest[where[i] - k, where[j] - k] += update[i, j]
