"""LU that skips zeros: condensed networks are two thirds to nine tenths zeros and n is at most some hundreds.

Unknowns are eliminated in an order in which few zeros fill in, columns swapped only where a diagonal is small.
Rows of U are taken in groups: shapes of one part have nearly the same neighbours; a row is written once for all four.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.numerics.jit import inner, inner_reordered

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
GROUP = 4  # rows of U
SMALL = 1e-3  # of all behind it in its row: UMFPACK's for matrices of symmetric pattern (Davis 2004)
GAP = 8  # columns: a loop over as many zeros costs less than to begin another
FIRST, BEGIN, FROM, TO = range(4)


class Factored(NamedTuple):
    """Some LU, each in a slot (k).  A (k, n, n) in the order of elimination, its rows filled up to whole groups

    over (k, n) : one over the diagonal of U;  pivot (k, n) : the column that took its place
    spans (k, 4, m) : FIRST entry of every row of L;  BEGIN of every group of rows of U the stretches behind it, columns
        FROM and up to TO, whole groups
    order (n,) : of elimination;  b : scratch
    """

    A: Floats
    over: Floats
    pivot: Ints
    spans: Ints
    order: Ints
    b: Floats


def factored(slots: int, order: Ints) -> Factored:
    """Room for as many LU of one size."""
    n = order.size
    spans = np.zeros((slots, 4, max(n, (n // GROUP + 1) * (n // (GAP + 1) + 2))), np.int64)
    A = np.zeros((slots, n, n + -n % GROUP))
    return Factored(A, np.zeros((slots, n)), np.zeros((slots, n), np.int64), spans, order, np.zeros(A.shape[2]))


def least_fill(touches: NDArray[np.bool_]) -> Ints:
    """(n,) the order of elimination in which every next unknown has the fewest neighbours left (minimum degree; George
    and Liu 1989).  touches (n, n) : where a matrix may have entries"""
    A = touches | touches.T
    np.fill_diagonal(A, False)
    order, left = np.zeros(len(A), np.int64), np.ones(len(A), bool)
    for i in range(len(A)):
        order[i] = k = int(np.argmin(np.where(left, A.sum(axis=1), len(A))))
        near = np.flatnonzero(A[k])
        A[np.ix_(near, near)] = True
        A[near, near] = A[k] = A[:, k] = left[k] = False
    return order


@inner
def lu(L, slot):
    """LU in place, row by row; columns swapped only where a diagonal is SMALL. False if singular."""
    A, over, pivot, spans = L.A[slot], L.over[slot], L.pivot[slot], L.spans[slot]
    n = len(A)
    spans[BEGIN, 0] = 0
    for i in range(n):
        a = A[i]
        spans[FIRST, i] = whole = i - i % GROUP
        for k in range(0, whole, GROUP):
            if a[k] != 0.0 or a[k + 1] != 0.0 or a[k + 2] != 0.0 or a[k + 3] != 0.0:
                spans[FIRST, i] = min(spans[FIRST, i], k)
                _eliminated(A, over, k, spans, a)
        for k in range(whole, i):
            a[k] *= over[k]
            for j in range(k + 1, n):
                a[j] -= a[k] * A[k, j]
        pivot[i] = i
        if abs(a[i]) < SMALL * _total(a, i + 1):
            pivot[i] = _largest(a, i)
            _swapped(A, i, pivot[i], spans)
        if a[i] == 0.0 or not np.isfinite(a[i]):
            return False
        over[i] = 1.0 / a[i]
        if i % GROUP == GROUP - 1:
            _spanned(A, i + 1, spans)
    return True


@inner_reordered
def _total(a, first):
    """Sum of the magnitudes from there on."""
    out = 0.0
    for j in range(first, a.size):
        out += abs(a[j])
    return out


@inner
def _largest(a, first):
    """The largest from there on."""
    best = first
    for j in range(first + 1, a.size):
        if abs(a[j]) > abs(a[best]):
            best = j
    return best


@inner_reordered
def _eliminated(A, over, k, spans, a):
    """Row a less what the group of rows from k on takes out of it; what it takes is left in a."""
    u0, u1, u2, u3 = A[k], A[k + 1], A[k + 2], A[k + 3]
    c0 = a[k] * over[k]
    c1 = (a[k + 1] - c0 * u0[k + 1]) * over[k + 1]
    c2 = (a[k + 2] - c0 * u0[k + 2] - c1 * u1[k + 2]) * over[k + 2]
    c3 = (a[k + 3] - c0 * u0[k + 3] - c1 * u1[k + 3] - c2 * u2[k + 3]) * over[k + 3]
    a[k], a[k + 1], a[k + 2], a[k + 3] = c0, c1, c2, c3
    for s in range(spans[BEGIN, k // GROUP], spans[BEGIN, k // GROUP + 1]):
        for j in range(spans[FROM, s], spans[TO, s], GROUP):
            x0 = a[j] - c0 * u0[j] - c1 * u1[j] - c2 * u2[j] - c3 * u3[j]
            x1 = a[j + 1] - c0 * u0[j + 1] - c1 * u1[j + 1] - c2 * u2[j + 1] - c3 * u3[j + 1]
            x2 = a[j + 2] - c0 * u0[j + 2] - c1 * u1[j + 2] - c2 * u2[j + 2] - c3 * u3[j + 2]
            x3 = a[j + 3] - c0 * u0[j + 3] - c1 * u1[j + 3] - c2 * u2[j + 3] - c3 * u3[j + 3]
            a[j], a[j + 1], a[j + 2], a[j + 3] = x0, x1, x2, x3


@inner
def _swapped(A, i, best, spans):
    """Swap two columns; groups that are done may then reach anywhere."""
    for r in range(len(A)):
        A[r, i], A[r, best] = A[r, best], A[r, i]
    for g in range(i // GROUP):
        spans[FROM, g], spans[TO, g], spans[BEGIN, g + 1] = GROUP * (g + 1), A[0].size, g + 1


@inner
def _spanned(A, end, spans):
    """The stretches behind the group of rows that ends there; zeros between two are taken along up to GAP."""
    g = end // GROUP - 1
    found, last, k = spans[BEGIN, g], -GAP, end - GROUP
    for j in range(end, len(A)):
        if A[k, j] != 0.0 or A[k + 1, j] != 0.0 or A[k + 2, j] != 0.0 or A[k + 3, j] != 0.0:
            if j - last > GAP or found == spans[BEGIN, g]:
                spans[FROM, found] = j - j % GROUP
                found += 1
            last = j
            spans[TO, found - 1] = j - j % GROUP + GROUP
    spans[BEGIN, g + 1] = found


@inner
def shifted(A, c, d, L, slot):
    """c A + diag(d) into a slot, to be factored there."""
    out, order = L.A[slot], L.order
    for i in range(order.size):
        a = A[order[i]]
        for j in range(order.size):
            out[i, j] = c * a[order[j]]
        out[i, i] += d[order[i]]


@inner_reordered
def solve(L, slot, x):
    """One right-hand side, in place."""
    A, over, pivot, spans, b = L.A[slot], L.over[slot], L.pivot[slot], L.spans[slot], L.b
    n = len(A)
    for i in range(n):
        acc = 0.0
        for j in range(spans[FIRST, i], i):
            acc += A[i, j] * b[j]
        b[i] = x[L.order[i]] - acc
    for i in range(n - 1, -1, -1):
        g = i // GROUP
        acc = 0.0
        for j in range(i + 1, min(GROUP * (g + 1), n)):
            acc += A[i, j] * b[j]
        if GROUP * (g + 1) <= n:
            for s in range(spans[BEGIN, g], spans[BEGIN, g + 1]):
                for j in range(spans[FROM, s], spans[TO, s]):
                    acc += A[i, j] * b[j]
        b[i] = (b[i] - acc) * over[i]
    for i in range(n - 1, -1, -1):
        b[i], b[pivot[i]] = b[pivot[i]], b[i]
    for i in range(n):
        x[L.order[i]] = b[i]


@inner_reordered
def matvec(A, x, out):
    """out = -A x."""
    for i in range(out.size):
        acc = 0.0
        for j in range(x.size):
            acc += A[i, j] * x[j]
        out[i] = -acc


@inner
def axpy(a, x, y):
    if a != 0.0:
        for j in range(x.size):
            y[j] += a * x[j]


@inner
def copy(x, y):
    """y = x."""
    for j in range(x.size):
        y[j] = x[j]


@inner_reordered
def _fours(a, first, last, X, c, out):
    """out -= c sum of a[j] X[j] from first to last, four rows at a time: out is read and written a quarter as often."""
    j = first
    while j + 3 < last:
        a0, a1, a2, a3 = c * a[j], c * a[j + 1], c * a[j + 2], c * a[j + 3]
        if a0 != 0.0 or a1 != 0.0 or a2 != 0.0 or a3 != 0.0:
            x0, x1, x2, x3 = X[j], X[j + 1], X[j + 2], X[j + 3]
            for k in range(out.size):
                out[k] -= a0 * x0[k] + a1 * x1[k] + a2 * x2[k] + a3 * x3[k]
        j += 4
    while j < last:
        axpy(-c * a[j], X[j], out)
        j += 1


@inner
def solve_many(L, slot, X, B):
    """Right-hand sides in the columns of X (n, p), in place;  B (n, p) : scratch."""
    A, pivot, spans = L.A[slot], L.pivot[slot], L.spans[slot]
    n, p = len(X), X[0].size
    for i in range(n):
        copy(X[L.order[i]], B[i])
        _fours(A[i], spans[FIRST, i], i, B, 1.0, B[i])
    for i in range(n - 1, -1, -1):
        g = i // GROUP
        _fours(A[i], i + 1, min(GROUP * (g + 1), n), B, 1.0, B[i])
        if GROUP * (g + 1) <= n:
            for s in range(spans[BEGIN, g], spans[BEGIN, g + 1]):
                _fours(A[i], spans[FROM, s], min(spans[TO, s], n), B, 1.0, B[i])
        for j in range(p):
            B[i, j] *= L.over[slot, i]
    for i in range(n - 1, -1, -1):
        if pivot[i] != i:
            for j in range(p):
                B[i, j], B[pivot[i], j] = B[pivot[i], j], B[i, j]
    for i in range(n):
        copy(B[i], X[L.order[i]])
