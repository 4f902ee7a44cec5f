"""The compiled kernel: one linearly implicit, L-stable, second-order scheme for any network.

The scheme is ROS2 (Verwer, Spee, Blom, Hundsdorfer 1999, SIAM J. Sci. Comput. 20, 1456) with gamma = 1 - 1/sqrt(2),
exact Jacobian and time derivative, input factors and boundaries linear over the step. Then R(inf) = 0, states
without capacity are met at the end of the step, and a source gives the trapezium of its input factor.

    W = C + gamma h G,   W k1 = F(t0, x0) + gamma h F_t,   W k2 = F(t1, x0 + h k1) - 2 C k1 - gamma h F_t
    x1 = x0 + 3/2 h k1 + 1/2 h k2,   G = -dF/dx

Tangents differentiate exactly these equations, second derivatives of the temperature laws included.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.dense import axpy, copy, lu, solve, solve_many, subtract_product
from lumped.jit import entry, inner, pasted
from lumped.terms import (
    BENDS,
    DYNAMIC,
    ROWS,
    STIFF,
    Floats,
    Ints,
    Terms,
    bend,
    clear,
    directional,
    flow,
    jacobian,
    patterns,
)

GAMMA = 1.0 - 1.0 / np.sqrt(2.0)
MOST_ITERATIONS, CONVERGED_K = 50, 1e-9


class Tangents(NamedTuple):
    """Which multiplier each tangent moves: d m[term] / d theta[tangent] = slope; dC (n, p) for the capacities."""

    tangent: Ints
    term: Ints
    slope: Floats
    dC: Floats


class Rows(NamedTuple):
    """Outputs as sparse rows over z+: entries start[r]:start[r + 1] of at, weight."""

    start: Ints
    at: Ints
    weight: Floats


class Stages(NamedTuple):
    """Both stages of a step (first axis: 0 at its start, 1 at its end) in full.

    z (2, nz) z+, v (2, nv) P z+, tau (2, ne, 6) temperature laws, w, vw direction z_dot and P z_dot, k (2, n) the rates
    """

    z: Floats
    v: Floats
    tau: Floats
    w: Floats
    vw: Floats
    k: Floats


class Work(NamedTuple):
    """Scratch: df (ne,) factor slopes, F and F_t (n,), matrices W, G, H (n, n), tangents D (n, p), their rates R
    (2, n, p), pivots, the factors last seen."""

    df: Floats
    F: Floats
    Ft: Floats
    W: Floats
    G: Floats
    H: Floats
    D: Floats
    R: Floats
    pivot: Ints
    seen: Floats


def stages(x0: Floats, u0: Floats, T: Terms) -> Stages:
    """The arrays of both stages, with the first states and boundary temperatures in place."""
    n, nv, ne = x0.size, T.row.size, T.m.size
    tau, z = np.zeros((2, ne, 6)), np.tile(np.concatenate([x0, u0, [1.0]]), (2, 1))
    nz = z.shape[1]
    tau[..., 0] = 1.0
    return Stages(z, np.zeros((2, nv)), tau, np.zeros((2, nz)), np.zeros((2, nv)), np.zeros((2, n)))


def work(n: int, ne: int, p: int) -> Work:
    """Scratch for n states, ne terms and p tangents."""
    W, G, H = np.zeros((3, n, n))
    F, Ft = np.zeros(n), np.zeros(n)
    pivot, seen = np.zeros(n, np.int64), np.full(ne, np.nan)
    return Work(np.zeros(ne), F, Ft, W, G, H, np.zeros((n, p)), np.zeros((2, n, p)), pivot, seen)


@pasted
def _changed(T, f, seen):
    """Whether the matrix differs from the one last factorised."""
    out = False
    for e in range(T.m.size):
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.m[e] != 0.0:
            if T.kind[e, BENDS] or f[e] != seen[e]:
                out = True
            seen[e] = f[e]
    return out


@pasted
def _time_slope(T, K0, f, df, a, out):
    """out = F_t at the start of the step: boundaries move along w, factors along df."""
    n, w, v, vw, tau = out.size, a.w[0], a.v[0], a.vw[0], a.tau[0]
    for i in range(n):
        acc = 0.0
        for b in range(n, w.size):
            acc += K0[i, b] * w[b]
        out[i] = -acc
    for e in range(T.m.size):
        if T.kind[e, DYNAMIC] and T.m[e] != 0.0:
            c = T.m[e] * f[e] * tau[e, 0]
            turn = T.m[e] * directional(T, e, f[e], df[e], tau, w)
            for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
                out[T.row[s]] -= c * vw[s] + turn * v[s]


@pasted
def _rates(T, K0, C, f, f2, u2, h, refactor, a, q):
    """Both stages of one step; False if the matrix is singular."""
    n, gh = C.size, GAMMA * h
    flow(T, K0, a.z[0], f, a.tau[0], a.v[0], q.F)
    if refactor:
        jacobian(T, K0, f, a.tau[0], a.v[0], q.G)
        for i in range(n):
            for j in range(n):
                q.W[i, j] = gh * q.G[i, j]
            q.W[i, i] += C[i]
        if not lu(q.W, q.pivot):
            return False
    patterns(T, a.w[0], a.vw[0])
    _time_slope(T, K0, f, q.df, a, q.Ft)
    for i in range(n):
        a.k[0, i] = q.F[i] + gh * q.Ft[i]
    solve(q.W, q.pivot, a.k[0])
    for i in range(n):
        a.z[1, i] = a.z[0, i] + h * a.k[0, i]
    for i in range(u2.size):
        a.z[1, n + i] = u2[i]
    flow(T, K0, a.z[1], f2, a.tau[1], a.v[1], q.F)
    for i in range(n):
        a.k[1, i] = q.F[i] - 2.0 * C[i] * a.k[0, i] - gh * q.Ft[i]
    solve(q.W, q.pivot, a.k[1])
    return True


@pasted
def _directions(T, a, n):
    """The directions along which each stage linearises: its rate, and time forwards (0) or backwards (1)."""
    for i in range(n):
        a.w[0, i] = a.k[0, i]
        a.w[1, i] = a.k[1, i]
    for i in range(n, a.w.shape[1]):
        a.w[1, i] = -a.w[0, i]
    for stage in range(2):
        patterns(T, a.w[stage], a.vw[stage])


@inner
def _taken(T, e, s, stage, t, df, a, gh):
    """What a stage of the step to index t takes out of row s by term e, without m; it linearises at the start."""
    f = T.factor[t - 1, e]
    turn = directional(T, e, f, df * (1.0 - 2.0 * stage), a.tau[0], a.w[stage])
    now = T.factor[t - 1 + stage, e] * a.tau[stage, e, 0] * a.v[stage, s]
    return now + gh * (f * a.tau[0, e, 0] * a.vw[stage, s] + turn * a.v[0, s])


@pasted
def _count(T, through, t, h, a, df, before, after):
    """Heat through every term over the step (J), by the scheme's own quadrature."""
    for e in range(T.m.size):
        acc = 0.0
        for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
            for stage in range(2):
                acc += through[s] * _taken(T, e, s, stage, t, df[e], a, GAMMA * h)
        after[e] = before[e] + 0.5 * h * T.m[e] * acc


@inner
def _moved(T, S, stage, t, df, a, gh, out):
    """out -= d m times what a stage takes out, for every multiplier a tangent moves."""
    for i in range(S.term.size):
        e, j, slope = S.term[i], S.tangent[i], S.slope[i]
        for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
            out[T.row[s], j] -= slope * _taken(T, e, s, stage, t, df[e], a, gh)


@inner
def _tangents(T, S, K0, C, t, h, curved, a, q):
    """Move the tangents q.D over the step that ends at index t."""
    n, gh = C.size, GAMMA * h
    clear(q.R[0])
    clear(q.R[1])
    for stage in range(2):
        if curved:
            bend(T, T.factor[t - 1], q.df, 1.0 - 2.0 * stage, a.tau[0], a.v[0], a.w[stage], a.vw[stage], gh, q.H)
            subtract_product(q.H, q.D, q.R[stage])
        _moved(T, S, stage, t, q.df, a, gh, q.R[stage])
    for stage in range(2):
        subtract_product(q.G, q.D, q.R[stage])
        for i in range(n):
            axpy(-a.k[stage, i] - 2.0 * stage * a.k[0, i], S.dC[i], q.R[stage, i])
            axpy(-2.0 * stage * C[i], q.R[0, i], q.R[stage, i])
        solve_many(q.W, q.pivot, q.R[stage])
        if stage == 0:
            for i in range(n):
                axpy(h, q.R[0, i], q.D[i])
            if curved:
                jacobian(T, K0, T.factor[t], a.tau[1], a.v[1], q.G)
    for i in range(n):
        axpy(0.5 * h, q.R[0, i], q.D[i])
        axpy(0.5 * h, q.R[1, i], q.D[i])


@inner
def _finite(x):
    total = 0.0
    for i in range(x.size):
        total += 0.0 * x[i]
    return total == 0.0


@pasted
def _begin(T, u, t, h, w, df):
    """Slopes of factors (df) and boundaries (w) over the step that ends at index t."""
    n = w.size - u.shape[1] - 1
    for e in range(T.m.size):
        df[e] = (T.factor[t, e] - T.factor[t - 1, e]) / h
    for i in range(n):
        w[i] = 0.0
    for b in range(u.shape[1]):
        w[n + b] = (u[t, b] - u[t - 1, b]) / h


@pasted
def _settle(T, K0, C, f, a, q):
    """Bring the states without capacity to their balance at fixed others (Newton); q.G is left as -dF/dx there.

    States with capacity stay: the identity stands in their rows.
    """
    n = C.size
    for _ in range(MOST_ITERATIONS):
        flow(T, K0, a.z[0], f, a.tau[0], a.v[0], q.F)
        jacobian(T, K0, f, a.tau[0], a.v[0], q.G)
        for i in range(n):
            copy(q.G[i], q.W[i])
            if C[i] > 0.0:
                q.F[i] = 0.0
                clear(q.W[i : i + 1])
                q.W[i, i] = 1.0
        if not lu(q.W, q.pivot):
            return False
        solve(q.W, q.pivot, q.F)
        largest = 0.0
        for i in range(n):
            a.z[0, i] += q.F[i]
            largest = max(largest, abs(q.F[i]))
        if largest < CONVERGED_K:
            return _finite(a.z[0])
    return False


@pasted
def _settle_tangents(T, S, C, f, a, D, q):
    """D: tangents of the states without capacity, at the balance found just before."""
    clear(q.R[0])
    for i in range(S.term.size):
        e = S.term[i]
        for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
            q.R[0, T.row[s], S.tangent[i]] -= S.slope[i] * f[e] * a.tau[0, e, 0] * a.v[0, s]
    for i in range(C.size):
        if C[i] > 0.0:
            copy(D[i], q.R[0, i])
    solve_many(q.W, q.pivot, q.R[0])
    for i in range(C.size):
        copy(q.R[0, i], D[i])


@pasted
def _outputs(R, z, D, y, dy):
    """Outputs and, where there are any, their tangents."""
    for r in range(y.size):
        for i in range(R.start[r], R.start[r + 1]):
            y[r] += R.weight[i] * z[R.at[i]]
            if R.at[i] < D.shape[0]:
                axpy(R.weight[i], D[R.at[i]], dy[r])


@entry
def integrate(time, u, C, K0, T, S, R, through, curved, massless, a, q, z_out, y, dy, heat):
    """March over the record; -1, or the index of the time at which the matrix was singular or x not finite.

    u (nt, nb); C (n,); K0 (n, n + nb + 1) constant terms; T, S, R as declared above
    through : (rows of all terms,) weights that sum a term's rows to the heat through it
    curved : whether any dynamic term touches the matrix;  massless : whether any state has no capacity
    a, q : from stages() and work()
    z_out (nt or 0, n + nb), y (nt, nr), dy (nt, nr, p), heat (nt or 0, ne) cumulated J: filled here, zero before
    """
    n, nb, ne = C.size, u.shape[1], T.m.size
    moves, counts = dy.shape[2] > 0, heat.shape[0] > 0
    h_last = -1.0
    for t in range(time.size):
        h = time[t] - time[max(t - 1, 0)]
        if h > 0.0:
            f, f2 = T.factor[t - 1], T.factor[t]
            h = h_last if abs(h - h_last) <= 1e-12 * h else h
            _begin(T, u, t, h, a.w[0], q.df)
            fresh = _changed(T, f, q.seen) or h != h_last
            if not _rates(T, K0, C, f, f2, u[t], h, fresh, a, q):
                return t
            h_last = h
            if moves or counts:
                _directions(T, a, n)
            if moves:
                _tangents(T, S, K0, C, t, h, curved, a, q)
            if counts:
                _count(T, through, t, h, a, q.df, heat[t - 1], heat[t])
            for i in range(n):
                a.z[0, i] += h * (1.5 * a.k[0, i] + 0.5 * a.k[1, i])
            if not _finite(a.z[0]):
                return t
        elif counts and t > 0:
            for e in range(ne):
                heat[t, e] = heat[t - 1, e]
        for i in range(nb):
            a.z[0, n + i] = u[t, i]
        if h == 0.0 and massless:
            h_last = -1.0
            if not _settle(T, K0, C, T.factor[t], a, q):
                return t
            if moves:
                _settle_tangents(T, S, C, T.factor[t], a, q.D, q)
        if z_out.shape[0] > 0:
            for i in range(n + nb):
                z_out[t, i] = a.z[0, i]
        _outputs(R, a.z[0], q.D, y[t], dy[t])
    return -1
