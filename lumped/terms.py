"""Terms of a network as the compiled kernel follows them, and their temperature laws.

Every link and source is a *term*: it takes m c(t, T) P z+ out of the states, z+ = [x; u; 1]; a source has its
pattern in the last column, with minus signs.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lumped.jit import inner

SIGMA = 5.670374419e-8
ZERO_C = 273.15
SMOOTH = 0.01  # K: |dT| ** p is smoothed below this difference, where its derivative would be unbounded
CONSTANT, POWER, RADIATION, LINEAR, TABLE = range(5)

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Terms(NamedTuple):
    """The terms the kernel follows one by one, in flat arrays; `*_start` (ne + 1,) bound the entries of each term.

    start, slot, col, val : triplets of P; slot counts the term's own distinct rows
    row_start, row : distinct rows
    hot_start, hot_at, hot_w, cold_start, cold_at, cold_w : the two temperatures of the law as rows over z+
    code, par (ne, 2), table_start, table_x, table_y : temperature law
    m : multipliers; factor (nt, ne) input factors without m
    dynamic : 1 where the term is assembled every step, 0 where it stands in the constant matrix
    stiff : 1 where it touches the matrix; bends : 1 where its law depends on temperature
    """

    start: Ints
    slot: Ints
    col: Ints
    val: Floats
    row_start: Ints
    row: Ints
    hot_start: Ints
    hot_at: Ints
    hot_w: Floats
    cold_start: Ints
    cold_at: Ints
    cold_w: Floats
    code: Ints
    par: Floats
    table_start: Ints
    table_x: Floats
    table_y: Floats
    m: Floats
    factor: Floats
    dynamic: Ints
    stiff: Ints
    bends: Ints


@inner
def _segment(x, start, end, at):
    """Index k of the piece of a table that holds `at`: x[k] <= at < x[k + 1]."""
    while end - start > 1:
        middle = (start + end) // 2
        if x[middle] <= at:
            start = middle
        else:
            end = middle
    return start


@inner
def _tabulated(T, e, d, out):
    """Piecewise linear in |d|, flat outside."""
    first, last, at = T.table_start[e], T.table_start[e + 1] - 1, abs(d)
    out[1] = 0.0
    if at >= T.table_x[last]:
        out[0] = T.table_y[last]
    elif at <= T.table_x[first]:
        out[0] = T.table_y[first]
    else:
        k = _segment(T.table_x, first, last, at)
        slope = (T.table_y[k + 1] - T.table_y[k]) / (T.table_x[k + 1] - T.table_x[k])
        out[0] = T.table_y[k] + slope * (at - T.table_x[k])
        out[1] = slope if d >= 0.0 else -slope
    out[2] = -out[1]


@inner
def law(code, a, b, hot, cold, out):
    """Temperature law: value, its derivatives by hot and cold, and the second ones hh, hc, cc, into out (6,)."""
    if code == POWER:
        d = hot - cold
        s = d * d + SMOOTH * SMOOTH
        out[0] = s ** (0.5 * a)
        out[1] = a * out[0] / s * d
        out[2] = -out[1]
        out[3] = a * out[0] / s * (1.0 + (a - 2.0) * d * d / s)
        out[4] = -out[3]
        out[5] = out[3]
    elif code == RADIATION:
        h, c = hot + ZERO_C, cold + ZERO_C
        out[0] = SIGMA * (h * h + c * c) * (h + c)
        out[1] = SIGMA * (3.0 * h * h + 2.0 * h * c + c * c)
        out[2] = SIGMA * (3.0 * c * c + 2.0 * h * c + h * h)
        out[3] = SIGMA * (6.0 * h + 2.0 * c)
        out[4] = 2.0 * SIGMA * (h + c)
        out[5] = SIGMA * (6.0 * c + 2.0 * h)
    elif code == LINEAR:
        out[0] = 1.0 + a * (hot - b)
        out[1] = a


@inner
def clear(A):
    for i in range(A.shape[0]):
        for j in range(A.shape[1]):
            A[i, j] = 0.0


@inner
def _dot(start, at, weight, e, z):
    out = 0.0
    for i in range(start[e], start[e + 1]):
        out += weight[i] * z[at[i]]
    return out


@inner
def evaluate(T, z, tau):
    """Temperature laws of all terms at z: tau (ne, 6) = value, d/dhot, d/dcold, hh, hc, cc."""
    for e in range(T.m.size):
        if T.bends[e]:
            hot = _dot(T.hot_start, T.hot_at, T.hot_w, e, z)
            cold = _dot(T.cold_start, T.cold_at, T.cold_w, e, z)
            if T.code[e] == TABLE:
                _tabulated(T, e, hot - cold, tau[e])
            else:
                law(T.code[e], T.par[e, 0], T.par[e, 1], hot, cold, tau[e])


@inner
def patterns(T, z, out):
    """P z of every term, on its own rows."""
    for s in range(out.size):
        out[s] = 0.0
    for e in range(T.m.size):
        base = T.row_start[e]
        for i in range(T.start[e], T.start[e + 1]):
            out[base + T.slot[i]] += T.val[i] * z[T.col[i]]


@inner
def force(T, K0, z, f, tau, v, out):
    """out = F = -K0 z - sum of the dynamic terms; f (ne,) input factors, tau and v = P z at z."""
    for i in range(out.size):
        acc = 0.0
        for j in range(z.size):
            acc += K0[i, j] * z[j]
        out[i] = -acc
    for e in range(T.m.size):
        if T.dynamic[e] and T.m[e] != 0.0:
            c = T.m[e] * f[e] * tau[e, 0]
            for s in range(T.row_start[e], T.row_start[e + 1]):
                out[T.row[s]] -= c * v[s]


@inner
def _add_pattern(T, e, c, A):
    base, n = T.row_start[e], A.shape[0]
    for i in range(T.start[e], T.start[e + 1]):
        if T.col[i] < n:
            A[T.row[base + T.slot[i]], T.col[i]] += c * T.val[i]


@inner
def _add_outer(T, e, v, by_hot, by_cold, A):
    """A += v (by_hot hot + by_cold cold)' on the states."""
    n = A.shape[0]
    for s in range(T.row_start[e], T.row_start[e + 1]):
        r = T.row[s]
        for i in range(T.hot_start[e], T.hot_start[e + 1]):
            if T.hot_at[i] < n:
                A[r, T.hot_at[i]] += v[s] * by_hot * T.hot_w[i]
        for i in range(T.cold_start[e], T.cold_start[e + 1]):
            if T.cold_at[i] < n:
                A[r, T.cold_at[i]] += v[s] * by_cold * T.cold_w[i]


@inner
def jacobian(T, K0, f, tau, v, G):
    """G = -dF/dx (n, n)."""
    for i in range(G.shape[0]):
        for j in range(G.shape[0]):
            G[i, j] = K0[i, j]
    for e in range(T.m.size):
        if T.dynamic[e] and T.stiff[e] and T.m[e] != 0.0:
            mf = T.m[e] * f[e]
            _add_pattern(T, e, mf * tau[e, 0], G)
            if T.bends[e]:
                _add_outer(T, e, v, mf * tau[e, 1], mf * tau[e, 2], G)


@inner
def directional(T, e, f, df, tau, z_dot):
    """d/ds of the coefficient c (without m) of term e along z_dot, and along time with df = df/dt."""
    hot = _dot(T.hot_start, T.hot_at, T.hot_w, e, z_dot)
    cold = _dot(T.cold_start, T.cold_at, T.cold_w, e, z_dot)
    return f * (tau[e, 1] * hot + tau[e, 2] * cold) + df * tau[e, 0]


@inner
def bend(T, f, df, sign, tau, v, z_dot, v_dot, scale, H):
    """H = scale * how G changes along z_dot and along time (forwards or backwards by sign); df (ne,) slopes."""
    clear(H)
    for e in range(T.m.size):
        if T.dynamic[e] and T.stiff[e] and T.m[e] != 0.0:
            m, slope = scale * T.m[e], sign * df[e]
            _add_pattern(T, e, m * directional(T, e, f[e], slope, tau, z_dot), H)
            if T.bends[e]:
                hot = _dot(T.hot_start, T.hot_at, T.hot_w, e, z_dot)
                cold = _dot(T.cold_start, T.cold_at, T.cold_w, e, z_dot)
                by_hot = slope * tau[e, 1] + f[e] * (tau[e, 3] * hot + tau[e, 4] * cold)
                by_cold = slope * tau[e, 2] + f[e] * (tau[e, 4] * hot + tau[e, 5] * cold)
                _add_outer(T, e, v, m * by_hot, m * by_cold, H)
                _add_outer(T, e, v_dot, m * f[e] * tau[e, 1], m * f[e] * tau[e, 2], H)
