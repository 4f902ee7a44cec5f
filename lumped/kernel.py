"""The compiled kernel: one linearly implicit, L-stable, second-order scheme for any network.

The scheme is ROS2 (Verwer, Spee, Blom, Hundsdorfer 1999, SIAM J. Sci. Comput. 20, 1456) with gamma = 1 - 1/sqrt(2),
exact Jacobian and time derivative, input factors and boundaries linear over the step. Then R(inf) = 0, states
without capacity are met at the end of the step, and a source gives the trapezium of its input factor.

    W = C + gamma h G,   W k1 = F(t0, x0) + gamma h F_t,   W k2 = F(t1, x0 + h k1) - 2 C k1 - gamma h F_t
    x1 = x0 + 3/2 h k1 + 1/2 h k2,   G = -dF/dx

Tangents differentiate exactly these equations, second derivatives of the temperature laws included. What only some
runs need, rest (settle.py) and the count of heat (count.py), is compiled when it is first asked for.
"""

from __future__ import annotations

from typing import NamedTuple

from lumped.dense import axpy, lu, shifted, solve, solve_many, subtract_product
from lumped.jit import entry, inner, pasted
from lumped.stages import GAMMA, begin, directions, finite, taken
from lumped.terms import DYNAMIC, ROWS, Floats, Ints, bend, clear, directional, flow, jacobian, patterns


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
            turn = T.m[e] * directional(e, f[e], df[e], tau, vw, T.row.size)
            for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
                out[T.row[s]] -= c * vw[s] + turn * v[s]


@pasted
def _rates(T, K0, C, u, t, h, refactor, a, q):
    """Both stages of the step to index t; False if the matrix is singular."""
    n, gh, z0, z1, w0, w1, F, Ft = C.size, GAMMA * h, a.z[0], a.z[1], a.w[0], a.w[1], q.F, q.Ft
    f = T.factor[t - 1]
    flow(T, K0, z0, f, a.tau[0], a.v[0], F)
    if refactor:
        jacobian(T, K0, f, a.tau[0], a.v[0], q.G)
        shifted(q.G, gh, C, q.W)
        if not lu(q.W, q.pivot):
            return False
    patterns(T, w0, a.vw[0])
    _time_slope(T, K0, f, q.df, a, Ft)
    for i in range(n):
        w0[i] = F[i] + gh * Ft[i]
    solve(q.W, q.pivot, w0)
    for i in range(n):
        z1[i] = z0[i] + h * w0[i]
    for i in range(u[t].size):
        z1[n + i] = u[t, i]
    flow(T, K0, z1, T.factor[t], a.tau[1], a.v[1], F)
    for i in range(n):
        w1[i] = F[i] - 2.0 * C[i] * w0[i] - gh * Ft[i]
    solve(q.W, q.pivot, w1)
    return True


@inner
def _moved(T, S, stage, t, df, a, gh, out):
    """out -= d m times what a stage takes out, for every multiplier a tangent moves."""
    for i in range(S.term.size):
        e, j, slope = S.term[i], S.tangent[i], S.slope[i]
        for s in range(T.start[e, ROWS], T.start[e + 1, ROWS]):
            out[T.row[s], j] -= slope * taken(T, e, s, stage, t, df[e], a, gh)


@inner
def _tangents(T, S, K0, C, t, h, curved, a, q):
    """Move the tangents q.D over the step that ends at index t."""
    n, gh = C.size, GAMMA * h
    clear(q.R[0])
    clear(q.R[1])
    for stage in range(2):
        if curved:
            bend(T, T.factor[t - 1], q.df, 1.0 - 2.0 * stage, a.tau[0], a.v[0], a.vw[stage], gh, q.H)
            subtract_product(q.H, q.D, q.R[stage])
        _moved(T, S, stage, t, q.df, a, gh, q.R[stage])
    for stage in range(2):
        subtract_product(q.G, q.D, q.R[stage])
        for i in range(n):
            axpy(-a.w[stage, i] - 2.0 * stage * a.w[0, i], S.dC[i], q.R[stage, i])
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


@pasted
def _outputs(R, z, D, y, dy):
    """Outputs and, where there are any, their tangents."""
    for r in range(y.size):
        for i in range(R.start[r], R.start[r + 1]):
            y[r] += R.weight[i] * z[R.at[i]]
            if R.at[i] < len(D):
                axpy(R.weight[i], D[R.at[i]], dy[r])


@entry
def integrate(time, u, C, K0, T, S, R, renew, curved, a, q, z_out, k_out, y, dy):
    """March over the record; -1, or the index of the time at which the matrix was singular or x not finite.

    u (nt, nb); C (n,); K0 (n, n + nb + 1) constant terms; T, S, R as declared above
    renew (nt,) : whether the matrix of the step that ends there differs from the one before
    curved : whether any dynamic term touches the matrix
    a, q : from stages() and work(); the states start at a.z[0], their tangents at q.D, and both are left at the end
    z_out (nt or 0, n + nb), k_out (nt or 0, 2, n) rates of the step that ends there, y (nt, nr), dy (nt, nr, p):
    filled here, zero before
    """
    n, nb, moves = C.size, u[0].size, q.D[0].size > 0
    h_last = -1.0
    for t in range(time.size):
        h = time[t] - time[max(t - 1, 0)]
        if h > 0.0:
            h = h_last if abs(h - h_last) <= 1e-12 * h else h
            begin(T, u, t, h, a.w, q.df)
            if not _rates(T, K0, C, u, t, h, renew[t] or h != h_last, a, q):
                return t
            h_last = h
            if moves:
                directions(T, a)
                _tangents(T, S, K0, C, t, h, curved, a, q)
            for i in range(n):
                a.z[0, i] += h * (1.5 * a.w[0, i] + 0.5 * a.w[1, i])
            if not finite(a.z[0]):
                return t
            if len(k_out) > 0:
                for i in range(n):
                    k_out[t, 0, i], k_out[t, 1, i] = a.w[0, i], a.w[1, i]
        for i in range(nb):
            a.z[0, n + i] = u[t, i]
        if len(z_out) > 0:
            for i in range(n + nb):
                z_out[t, i] = a.z[0, i]
        _outputs(R, a.z[0], q.D, y[t], dy[t])
    return -1
