"""Dense LU that skips zeros: condensed networks are two thirds to nine tenths zeros and n is at most some hundreds."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types
from numpy.typing import NDArray

from lumped.numerics.jit import inner, inner_reordered

# numba's own way to BLAS, which it registers for compiled code: products of many columns are worth the call
_POINTERS = (types.voidptr, types.intp)
_GEMM: Any = types.ExternalFunction("numba_xxgemm", types.intc(
    types.char, types.char, types.char, types.intp, types.intp, types.intp, types.voidptr, *_POINTERS, *_POINTERS,
    types.voidptr, *_POINTERS,
))  # fmt: skip
_DOUBLE, _AS_IS = (int(np.frombuffer(c, np.int8)[0]) for c in (b"d", b"n"))
GAP = 8  # columns: a loop over as many zeros costs less than to begin another
FACTORS = np.array([0.0, 1.0])  # of what a product is put on: it replaces that, or is added


REACHED, FIRST, BEGIN, FROM, TO = range(5)


def entries(n: int) -> NDArray[np.int64]:
    """Where an LU has entries.

    REACHED : scratch;  FIRST : of every row of L;  BEGIN : of every row of U its stretches, columns FROM and up to TO
    """
    return np.zeros((5, n * (n // (GAP + 1) + 1) + 1), np.int64)


@inner
def lu(A, pivot, spans):
    """LU in place, rows swapped only where the diagonal is below a tenth of its column; False if singular.

    spans : of `entries`, filled here
    """
    n = len(A)
    for i in range(n):
        spans[FIRST, i] = i
    spans[BEGIN, 0] = 0
    for k in range(n):
        best, reached = k, 0
        for i in range(k + 1, n):
            if A[i, k] != 0.0:
                spans[REACHED, reached] = i
                reached += 1
                if abs(A[i, k]) > abs(A[best, k]):
                    best = i
        best = k if abs(A[k, k]) >= 0.1 * abs(A[best, k]) else best
        pivot[k] = best
        if A[best, k] == 0.0 or not np.isfinite(A[best, k]):
            return False
        if best != k:
            for j in range(n):
                A[k, j], A[best, j] = A[best, j], A[k, j]
            first = spans[FIRST, best]
            spans[FIRST, k], spans[FIRST, best] = min(first, k), min(spans[FIRST, k], k)
        _spanned(A[k], k, spans)
        inverse = 1.0 / A[k, k]
        for r in range(reached):
            i = spans[REACHED, r]
            factor = A[i, k] * inverse
            A[i, k] = factor
            spans[FIRST, i] = min(spans[FIRST, i], k)
            for s in range(spans[BEGIN, k], spans[BEGIN, k + 1]):
                for j in range(spans[FROM, s], spans[TO, s]):
                    A[i, j] -= factor * A[k, j]
    return True


@inner
def _spanned(a, k, spans):
    """The stretches behind the diagonal that hold the entries of row k; zeros between two are taken along up to GAP."""
    found, last = spans[BEGIN, k], -GAP
    for j in range(k + 1, a.size):
        if a[j] != 0.0:
            if j - last > GAP or found == spans[BEGIN, k]:
                spans[FROM, found] = j
                found += 1
            last = j
            spans[TO, found - 1] = j + 1
    spans[BEGIN, k + 1] = found


@inner
def shifted(A, c, d, out):
    """out = c A + diag(d)."""
    n = len(A)
    for i in range(n):
        for j in range(n):
            out[i, j] = c * A[i, j]
        out[i, i] += d[i]


@inner_reordered
def solve(A, pivot, spans, b):
    """One right-hand side, in place."""
    n = len(A)
    for i in range(n):
        b[i], b[pivot[i]] = b[pivot[i]], b[i]
    for i in range(1, n):
        acc = 0.0
        for j in range(spans[FIRST, i], i):
            acc += A[i, j] * b[j]
        b[i] -= acc
    for i in range(n - 1, -1, -1):
        acc = 0.0
        for s in range(spans[BEGIN, i], spans[BEGIN, i + 1]):
            for j in range(spans[FROM, s], spans[TO, s]):
                acc += A[i, j] * b[j]
        b[i] = (b[i] - acc) / A[i, i]


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
def solve_many(A, pivot, spans, B):
    """Right-hand sides in the columns of B (n, p), in place."""
    n, p = len(B), B[0].size
    for i in range(n):
        if pivot[i] != i:
            for j in range(p):
                B[i, j], B[pivot[i], j] = B[pivot[i], j], B[i, j]
    for i in range(1, n):
        _fours(A[i], spans[FIRST, i], i, B, 1.0, B[i])
    for i in range(n - 1, -1, -1):
        for s in range(spans[BEGIN, i], spans[BEGIN, i + 1]):
            _fours(A[i], spans[FROM, s], spans[TO, s], B, 1.0, B[i])
        inverse = 1.0 / A[i, i]
        for j in range(p):
            B[i, j] *= inverse


@inner
def inverse(A, pivot, spans, out):
    """out = A^-1 from its LU."""
    n = len(A)
    for i in range(n):
        for j in range(n):
            out[i, j] = 1.0 if i == j else 0.0
    solve_many(A, pivot, spans, out)


@inner
def product(A, X, factors, keep, out):
    """out = A X, or out += A X to keep what is there.  A (n, m), X (m, p), out (n, p), all row by row"""
    n, m, p = len(A), len(X), X[0].size
    _GEMM(_DOUBLE, _AS_IS, _AS_IS, p, n, m, factors[1:].ctypes, X.ctypes, p, A.ctypes, m, factors[keep:].ctypes,
          out.ctypes, p)  # fmt: skip
