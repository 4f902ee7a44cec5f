"""LU that skips zeros: condensed networks are two thirds to nine tenths zeros and n is at most some hundreds.

Unknowns are eliminated in an order in which few zeros fill in, columns swapped only where a diagonal is small.
Rows of U are taken in groups: shapes of one part have nearly the same neighbours; a row is written once for all four.
"""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array, Ints
from lumped.numerics.jit import inner, inner_reordered

GROUP = 4  # rows of U
SMALL = 1e-3  # of all behind it in its row: UMFPACK's for matrices of symmetric pattern (Davis 2004)
GAP = 8  # columns: a loop over as many zeros costs less than to begin another
SPARSE, FULL = range(2)


class Structure(NamedTuple):
    """Where an LU has entries: [SPARSE] as its matrix lets one expect, [FULL] once columns were swapped.

    begin (2, n + 1), group : of every row of L its whole groups of columns, numbers
    after (2, groups + 1), first, last : of every group of rows of U the stretches behind it, whole groups of columns
    """

    begin: Ints
    group: Ints
    after: Ints
    first: Ints
    last: Ints


class Factored(NamedTuple):
    """Some LU, each in a slot (k).  A (k, n, n), its rows filled up to whole groups;  over (k, n) : 1 / diagonal of U

    pivot (k, n) : the column that took a column's place;  kind (k,) SPARSE or FULL
    """

    A: Array
    over: Array
    pivot: Ints
    kind: Ints
    structure: Structure


def factored(slots: int, structure: Structure) -> Factored:
    """Room for as many LU of one structure."""
    n = structure.begin.shape[1] - 1
    A = np.zeros((slots, n, n + -n % GROUP))
    return Factored(A, np.zeros((slots, n)), np.zeros((slots, n), np.int64), np.zeros(slots, np.int64), structure)


def least_fill(touches: NDArray[np.bool_]) -> tuple[Ints, Structure]:
    """(n,) the order of elimination in which every next unknown has the fewest neighbours left (minimum degree; George
    and Liu 1989), and the structure in it.  touches (n, n) : where a matrix may have entries"""
    A = touches | touches.T
    np.fill_diagonal(A, False)
    n = len(A)
    order, left, filled = np.zeros(n, np.int64), np.ones(n, bool), np.zeros((n, n), bool)
    for i in range(n):
        order[i] = k = int(np.argmin(np.where(left, A.sum(axis=1), n)))
        near = np.flatnonzero(A[k])
        filled[k, near] = True
        A[np.ix_(near, near)] = True
        A[near, near] = A[k] = A[:, k] = left[k] = False
    return order, structured(filled[np.ix_(order, order)])


def structured(filled: NDArray[np.bool_]) -> Structure:
    """From where U has entries behind its diagonal (n, n), as L has them below it."""
    n, whole = len(filled), len(filled) // GROUP
    begin: list[Ints] = []
    after: list[Ints] = []
    group: list[int] = []
    stretches: list[tuple[int, int]] = []
    for U in (filled, np.triu(np.ones((n, n), bool), 1)):
        rows = [np.asarray(U[GROUP * g : GROUP * g + GROUP].any(axis=0)) for g in range(whole)]
        below = [[g for g in range(i // GROUP) if rows[g][i]] for i in range(n)]
        ends = [_stretches(rows[g], GROUP * (g + 1)) for g in range(whole)]
        begin.append(len(group) + np.cumsum([0, *(len(x) for x in below)]))
        after.append(len(stretches) + np.cumsum([0, *(len(x) for x in ends)]))
        group += [g for x in below for g in x]
        stretches += [pair for x in ends for pair in x]
    first, last = np.array(stretches, np.int64).reshape(-1, 2).T.copy()
    return Structure(np.array(begin), np.array(group, np.int64), np.array(after), first, last)


@cache
def dense(n: int) -> Structure:
    """Where any entry may be."""
    return structured(np.triu(np.ones((n, n), bool), 1))


def _stretches(entries: NDArray[np.bool_], start: int) -> list[tuple[int, int]]:
    """Columns from `start` on in which there are entries, in whole groups; up to GAP zeros are taken along."""
    out: list[tuple[int, int]] = []
    for j in start + np.flatnonzero(entries[start:]):
        low = int(j - j % GROUP)
        if out and low - out[-1][1] < GAP:
            out[-1] = out[-1][0], low + GROUP
        else:
            out.append((low, low + GROUP))
    return out


@inner
def lu(L, slot):
    """LU in place, row by row; columns swapped only where a diagonal is SMALL. False if singular."""
    A, over, pivot, S, kind = L.A[slot], L.over[slot], L.pivot[slot], L.structure, SPARSE
    n = len(A)
    for i in range(n):
        a = A[i]
        for q in range(S.begin[kind, i], S.begin[kind, i + 1]):
            _eliminated(A, over, S, kind, S.group[q], a)
        for k in range(i - i % GROUP, i):
            a[k] *= over[k]
            for j in range(k + 1, n):
                a[j] -= a[k] * A[k, j]
        pivot[i] = i
        if abs(a[i]) < SMALL * _total(a, i + 1):
            pivot[i], kind = _largest(a, i), FULL
            for r in range(n):
                A[r, i], A[r, pivot[i]] = A[r, pivot[i]], A[r, i]
        if a[i] == 0.0 or not np.isfinite(a[i]):
            return False
        over[i] = 1.0 / a[i]
    L.kind[slot] = kind
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
def _eliminated(A, over, S, kind, g, a):
    """Row a less what a group of rows takes out of it; what it takes is left in a."""
    k = GROUP * g
    u0, u1, u2, u3 = A[k], A[k + 1], A[k + 2], A[k + 3]
    c0 = a[k] * over[k]
    c1 = (a[k + 1] - c0 * u0[k + 1]) * over[k + 1]
    c2 = (a[k + 2] - c0 * u0[k + 2] - c1 * u1[k + 2]) * over[k + 2]
    c3 = (a[k + 3] - c0 * u0[k + 3] - c1 * u1[k + 3] - c2 * u2[k + 3]) * over[k + 3]
    a[k], a[k + 1], a[k + 2], a[k + 3] = c0, c1, c2, c3
    for s in range(S.after[kind, g], S.after[kind, g + 1]):
        for j in range(S.first[s], S.last[s], GROUP):
            x0 = a[j] - c0 * u0[j] - c1 * u1[j] - c2 * u2[j] - c3 * u3[j]
            x1 = a[j + 1] - c0 * u0[j + 1] - c1 * u1[j + 1] - c2 * u2[j + 1] - c3 * u3[j + 1]
            x2 = a[j + 2] - c0 * u0[j + 2] - c1 * u1[j + 2] - c2 * u2[j + 2] - c3 * u3[j + 2]
            x3 = a[j + 3] - c0 * u0[j + 3] - c1 * u1[j + 3] - c2 * u2[j + 3] - c3 * u3[j + 3]
            a[j], a[j + 1], a[j + 2], a[j + 3] = x0, x1, x2, x3


@inner
def shifted(A, c, d, L, slot):
    """c A + diag(d) into a slot, to be factored there."""
    out = L.A[slot]
    for i in range(d.size):
        for j in range(d.size):
            out[i, j] = c * A[i, j]
        out[i, i] += d[i]


@inner_reordered
def solve(L, slot, b):
    """One right-hand side, in place."""
    A, over, pivot, S, kind = L.A[slot], L.over[slot], L.pivot[slot], L.structure, L.kind[slot]
    n = len(A)
    for i in range(n):
        acc = 0.0
        for q in range(S.begin[kind, i], S.begin[kind, i + 1]):
            k = GROUP * S.group[q]
            acc += A[i, k] * b[k] + A[i, k + 1] * b[k + 1] + A[i, k + 2] * b[k + 2] + A[i, k + 3] * b[k + 3]
        for k in range(i - i % GROUP, i):
            acc += A[i, k] * b[k]
        b[i] -= acc
    for i in range(n - 1, -1, -1):
        g, acc = i // GROUP, 0.0
        for j in range(i + 1, min(GROUP * (g + 1), n)):
            acc += A[i, j] * b[j]
        if GROUP * (g + 1) <= n:
            for s in range(S.after[kind, g], S.after[kind, g + 1]):
                for j in range(S.first[s], min(S.last[s], n)):
                    acc += A[i, j] * b[j]
        b[i] = (b[i] - acc) * over[i]
    for i in range(n - 1, -1, -1):
        b[i], b[pivot[i]] = b[pivot[i]], b[i]


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
def _four(a, j, X, out):
    """out -= a[j] X[j] + ... of four rows: out is read and written a quarter as often."""
    a0, a1, a2, a3 = a[j], a[j + 1], a[j + 2], a[j + 3]
    x0, x1, x2, x3 = X[j], X[j + 1], X[j + 2], X[j + 3]
    for k in range(out.size):
        out[k] -= a0 * x0[k] + a1 * x1[k] + a2 * x2[k] + a3 * x3[k]


@inner
def _several(a, first, last, X, out):
    """out -= sum of a[j] X[j] from first, the beginning of a group, to last."""
    for j in range(first, last - GROUP + 1, GROUP):
        _four(a, j, X, out)
    for j in range(last - (last - first) % GROUP, last):
        axpy(-a[j], X[j], out)


@inner
def solve_many(L, slot, B):
    """Right-hand sides in the columns of B (n, p), in place."""
    A, over, pivot, S, kind = L.A[slot], L.over[slot], L.pivot[slot], L.structure, L.kind[slot]
    n, p = len(B), B[0].size
    for i in range(n):
        for q in range(S.begin[kind, i], S.begin[kind, i + 1]):
            _four(A[i], GROUP * S.group[q], B, B[i])
        for k in range(i - i % GROUP, i):
            axpy(-A[i, k], B[k], B[i])
    for i in range(n - 1, -1, -1):
        g = i // GROUP
        for j in range(i + 1, min(GROUP * (g + 1), n)):
            axpy(-A[i, j], B[j], B[i])
        if GROUP * (g + 1) <= n:
            for s in range(S.after[kind, g], S.after[kind, g + 1]):
                _several(A[i], S.first[s], min(S.last[s], n), B, B[i])
        for j in range(p):
            B[i, j] *= over[i]
    for i in range(n - 1, -1, -1):
        if pivot[i] != i:
            for j in range(p):
                B[i, j], B[pivot[i], j] = B[pivot[i], j], B[i, j]
