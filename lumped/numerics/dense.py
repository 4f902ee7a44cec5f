"""LU that skips zeros: condensed networks are two thirds to nine tenths zeros and n is at most some hundreds.

Unknowns are eliminated in an order in which few zeros fill in, columns swapped only where a diagonal is small.
Rows and columns are taken in groups, the last filled up with the identity: shapes of one part have nearly the same
neighbours, and what a group of rows takes out of another is sixteen products for every column that is read.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from geom.arrays import Array, Ints, Mask
from lumped.numerics.jit import inner, inner_noalias, inner_reordered, pasted

GROUP = 4  # rows, columns
SMALL = 1e-3  # of all behind it in its row: UMFPACK's for matrices of symmetric pattern (Davis 2004)
GAP = 8  # columns: a loop over as many zeros costs less than to begin another
SPARSE, FULL = range(2)


class Structure(NamedTuple):
    """Where an LU has entries: [SPARSE] as its matrix lets one expect, [FULL] once columns were swapped.

    begin (2, groups + 1), group : of every group of rows of L the groups of columns, numbers
    after (2, groups + 1), first, last : of every group of rows of U the stretches behind it, whole groups of columns
    """

    begin: Ints
    group: Ints
    after: Ints
    first: Ints
    last: Ints


class Factored(NamedTuple):
    """Some LU, each in a slot (k).  A (k, n, n), n filled up to whole groups;  over (k, n) : 1 / diagonal of U

    pivot (k, n) : the column that took a column's place;  kind (k,) SPARSE or FULL;  x (n,) scratch
    """

    A: Array
    over: Array
    pivot: Ints
    kind: Ints
    x: Array
    structure: Structure


def factored(slots: int, structure: Structure) -> Factored:
    """Room for as many LU of one structure."""
    n = GROUP * (structure.begin.shape[1] - 1)
    over, pivot = np.zeros((slots, n)), np.zeros((slots, n), np.int64)
    return Factored(np.zeros((slots, n, n)), over, pivot, np.zeros(slots, np.int64), np.zeros(n), structure)


def least_fill(touches: Mask) -> tuple[Ints, Structure]:
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


def structured(filled: Mask) -> Structure:
    """From where U has entries behind its diagonal (n, n), as L has them below it."""
    filled = np.pad(filled, (0, -len(filled) % GROUP))
    n, whole = len(filled), len(filled) // GROUP
    begin: list[Ints] = []
    after: list[Ints] = []
    group: list[int] = []
    stretches: list[tuple[int, int]] = []
    for U in (filled, np.triu(np.ones((n, n), bool), 1)):
        rows = [np.asarray(U[GROUP * g : GROUP * g + GROUP].any(axis=0)) for g in range(whole)]
        below = [[g for g in range(i) if rows[g][GROUP * i : GROUP * i + GROUP].any()] for i in range(whole)]
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


def _stretches(entries: Mask, start: int) -> list[tuple[int, int]]:
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
    """LU in place, group by group of rows; columns swapped only where a diagonal is SMALL. False if singular."""
    A, over, pivot, S, kind = L.A[slot], L.over[slot], L.pivot[slot], L.structure, SPARSE
    n = len(A)
    for i in range(n):
        if i % GROUP == 0:
            for q in range(S.begin[kind, i // GROUP], S.begin[kind, i // GROUP + 1]):
                _eliminated(A, over, S, kind, S.group[q], i)
        a = A[i]
        for k in range(i - i % GROUP, i):
            a[k] *= over[k]
            _subtract(a[k], A[k], a, k + 1, i - i % GROUP + GROUP)
            for s in range(S.after[kind, i // GROUP], S.after[kind, i // GROUP + 1]):
                _subtract(a[k], A[k], a, S.first[s], S.last[s])
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
def _eliminated(A, over, S, kind, g, i):
    """The group of rows from i less what group g of rows takes out of it; what it takes is left there."""
    k = GROUP * g
    for r in range(i, i + GROUP):
        a = A[r]
        a[k] *= over[k]
        a[k + 1] = (a[k + 1] - a[k] * A[k, k + 1]) * over[k + 1]
        a[k + 2] = (a[k + 2] - a[k] * A[k, k + 2] - a[k + 1] * A[k + 1, k + 2]) * over[k + 2]
        last = a[k + 3] - a[k] * A[k, k + 3] - a[k + 1] * A[k + 1, k + 3] - a[k + 2] * A[k + 2, k + 3]
        a[k + 3] = last * over[k + 3]
    for s in range(S.after[kind, g], S.after[kind, g + 1]):
        _four_by_four(A, i, k, A, S.first[s], S.last[s])


@inner
def _four_by_four(A, i, k, X, first, last):
    """Group i of rows of X less A[i, k] X[k] of group k, from one column to another."""
    _less(A, i, k, X[k], X[k + 1], X[k + 2], X[k + 3], X[i], X[i + 1], X[i + 2], X[i + 3], first, last)


@inner_noalias
def _less(A, i, k, x0, x1, x2, x3, y0, y1, y2, y3, first, last):
    a0, a1, a2, a3 = A[i, k], A[i, k + 1], A[i, k + 2], A[i, k + 3]
    b0, b1, b2, b3 = A[i + 1, k], A[i + 1, k + 1], A[i + 1, k + 2], A[i + 1, k + 3]
    c0, c1, c2, c3 = A[i + 2, k], A[i + 2, k + 1], A[i + 2, k + 2], A[i + 2, k + 3]
    d0, d1, d2, d3 = A[i + 3, k], A[i + 3, k + 1], A[i + 3, k + 2], A[i + 3, k + 3]
    for j in range(first, last):
        u0, u1, u2, u3 = x0[j], x1[j], x2[j], x3[j]
        y0[j] -= a0 * u0 + a1 * u1 + a2 * u2 + a3 * u3
        y1[j] -= b0 * u0 + b1 * u1 + b2 * u2 + b3 * u3
        y2[j] -= c0 * u0 + c1 * u1 + c2 * u2 + c3 * u3
        y3[j] -= d0 * u0 + d1 * u1 + d2 * u2 + d3 * u3


@inner
def shifted(A, c, d, L, slot):
    """c A + diag(d) into a slot, to be factored there."""
    out = L.A[slot]
    for i in range(d.size):
        for j in range(d.size):
            out[i, j] = c * A[i, j]
        out[i, i] += d[i]
    fill(out, d.size)


@inner
def fill(A, n):
    """The identity behind n rows and columns of a matrix."""
    for i in range(len(A)):
        for j in range(n if i < n else 0, len(A)):
            A[i, j] = 1.0 if i == j else 0.0


@inner_reordered
def solve(L, slot, b):
    """One right-hand side, in place."""
    A, over, pivot, S, kind, x = L.A[slot], L.over[slot], L.pivot[slot], L.structure, L.kind[slot], L.x
    n = len(A)
    for i in range(n):
        x[i] = b[i] if i < b.size else 0.0
    for i in range(0, n, GROUP):
        s = 0.0, 0.0, 0.0, 0.0
        for q in range(S.begin[kind, i // GROUP], S.begin[kind, i // GROUP + 1]):
            s = _products(A, i, GROUP * S.group[q], x, s)
        x[i] -= s[0]
        x[i + 1] -= s[1] + A[i + 1, i] * x[i]
        x[i + 2] -= s[2] + A[i + 2, i] * x[i] + A[i + 2, i + 1] * x[i + 1]
        x[i + 3] -= s[3] + A[i + 3, i] * x[i] + A[i + 3, i + 1] * x[i + 1] + A[i + 3, i + 2] * x[i + 2]
    for i in range(n - GROUP, -1, -GROUP):
        s = 0.0, 0.0, 0.0, 0.0
        for e in range(S.after[kind, i // GROUP], S.after[kind, i // GROUP + 1]):
            for j in range(S.first[e], S.last[e], GROUP):
                s = _products(A, i, j, x, s)
        x[i + 3] = (x[i + 3] - s[3]) * over[i + 3]
        x[i + 2] = (x[i + 2] - s[2] - A[i + 2, i + 3] * x[i + 3]) * over[i + 2]
        x[i + 1] = (x[i + 1] - s[1] - A[i + 1, i + 2] * x[i + 2] - A[i + 1, i + 3] * x[i + 3]) * over[i + 1]
        last = s[0] + A[i, i + 1] * x[i + 1] + A[i, i + 2] * x[i + 2] + A[i, i + 3] * x[i + 3]
        x[i] = (x[i] - last) * over[i]
    for i in range(n - 1, -1, -1):
        x[i], x[pivot[i]] = x[pivot[i]], x[i]
    for i in range(b.size):
        b[i] = x[i]


@pasted
def _products(A, i, k, x, s):
    """s plus what the group of rows from i makes of the group of columns from k."""
    x0, x1, x2, x3 = x[k], x[k + 1], x[k + 2], x[k + 3]
    return (
        s[0] + A[i, k] * x0 + A[i, k + 1] * x1 + A[i, k + 2] * x2 + A[i, k + 3] * x3,
        s[1] + A[i + 1, k] * x0 + A[i + 1, k + 1] * x1 + A[i + 1, k + 2] * x2 + A[i + 1, k + 3] * x3,
        s[2] + A[i + 2, k] * x0 + A[i + 2, k + 1] * x1 + A[i + 2, k + 2] * x2 + A[i + 2, k + 3] * x3,
        s[3] + A[i + 3, k] * x0 + A[i + 3, k + 1] * x1 + A[i + 3, k + 2] * x2 + A[i + 3, k + 3] * x3,
    )


@inner_reordered
def matvec(A, x, out):
    """out = -A x."""
    for i in range(out.size):
        acc = 0.0
        for j in range(x.size):
            acc += A[i, j] * x[j]
        out[i] = -acc


@inner_noalias
def _subtract(c, x, y, first, last):
    """y -= c x from one column to another."""
    for j in range(first, last):
        y[j] -= c * x[j]


@inner_noalias
def axpy(a, x, y):
    if a != 0.0:
        for j in range(x.size):
            y[j] += a * x[j]


@inner_noalias
def copy(x, y):
    """y = x."""
    for j in range(x.size):
        y[j] = x[j]


@inner
def solve_many(L, slot, B):
    """Right-hand sides in the columns of B, in place; rows and columns are filled up to whole groups."""
    A, over, pivot, S, kind = L.A[slot], L.over[slot], L.pivot[slot], L.structure, L.kind[slot]
    n, p = len(B), B[0].size
    for i in range(n):
        if i % GROUP == 0:
            for q in range(S.begin[kind, i // GROUP], S.begin[kind, i // GROUP + 1]):
                _four_by_four(A, i, GROUP * S.group[q], B, 0, p)
        for k in range(i - i % GROUP, i):
            axpy(-A[i, k], B[k], B[i])
    for i in range(n - 1, -1, -1):
        g = i // GROUP
        if i % GROUP == GROUP - 1:
            for s in range(S.after[kind, g], S.after[kind, g + 1]):
                for j in range(S.first[s], S.last[s], GROUP):
                    _four_by_four(A, GROUP * g, j, B, 0, p)
        for j in range(i + 1, GROUP * (g + 1)):
            axpy(-A[i, j], B[j], B[i])
        for j in range(p):
            B[i, j] *= over[i]
    for i in range(n - 1, -1, -1):
        if pivot[i] != i:
            for j in range(p):
                B[i, j], B[pivot[i], j] = B[pivot[i], j], B[i, j]
