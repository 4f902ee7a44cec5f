"""The compiled kernel: one linearly implicit, L-stable, second-order scheme for any network.

The scheme is ROS2 (Verwer, Spee, Blom, Hundsdorfer 1999, SIAM J. Sci. Comput. 20, 1456) with gamma = 1 - 1/sqrt(2),
exact Jacobian and time derivative, input factors and boundaries linear over the step. Then R(inf) = 0, states
without capacity are met at the end of the step, and a source gives the trapezium of its input factor.

    W = C + gamma h G,   W k1 = F(t0, x0) + gamma h F_t,   W k2 = F(t1, x0 + h k1) - 2 C k1 - gamma h F_t
    x1 = x0 + 3/2 h k1 + 1/2 h k2,   G = -dF/dx

What only some runs need is compiled when it is first asked for: tangents (tangents.py), rest (settle.py) and the count
of heat (count.py).
"""

from __future__ import annotations

from typing import NamedTuple

from lumped.dense import lu, shifted, solve
from lumped.jit import entry, pasted
from lumped.stages import GAMMA, begin, finite, length
from lumped.terms import DYNAMIC, ROWS, Floats, Ints, directional, flow, jacobian, patterns


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


@pasted
def _outputs(R, z, y):
    for r in range(y.size):
        acc = 0.0
        for i in range(R.start[r], R.start[r + 1]):
            acc += R.weight[i] * z[R.at[i]]
        y[r] = acc


@entry
def integrate(time, u, C, K0, T, R, renew, a, q, z, k, y):
    """March over a record; -1, or the index of the time at which the matrix was singular or x not finite.

    u (nt, nb); C (n,); K0 (n, n + nb + 1) constant terms; T, R as declared above
    renew (nt,) : whether the matrix of the step that ends there differs from the one before
    a, q : from stages() and work(); the states start at a.z[0] and are left there at the end
    z (nt, n + nb), k (nt, 2, n) rates of the step that ends there, y (nt, nr): filled here, but for k at the first time
    """
    n, nb = C.size, u[0].size
    h_last = -1.0
    for t in range(time.size):
        h = length(time, t, h_last)
        if h > 0.0:
            begin(T, u, t, h, a.w, q.df)
            if not _rates(T, K0, C, u, t, h, renew[t] or h != h_last, a, q):
                return t
            h_last = h
            for i in range(n):
                k[t, 0, i], k[t, 1, i] = a.w[0, i], a.w[1, i]
                a.z[0, i] += h * (1.5 * a.w[0, i] + 0.5 * a.w[1, i])
            if not finite(a.z[0]):
                return t
        for i in range(nb):
            a.z[0, n + i] = u[t, i]
        for i in range(n + nb):
            z[t, i] = a.z[0, i]
        _outputs(R, a.z[0], y[t])
    return -1
