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
from numba import njit

from lumped.dense import axpy, lu, solve, solve_many, subtract_product
from lumped.terms import Floats, Ints, bend, directional, evaluate, force, jacobian, patterns

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


class Stage(NamedTuple):
    """Everything known at one stage: z+, P z+, temperature laws, direction z_dot, P z_dot, the rate k."""

    z: Floats
    v: Floats
    tau: Floats
    w: Floats
    vw: Floats
    k: Floats


class Work(NamedTuple):
    """Scratch: df (ne,) factor slopes, F and F_t (n,), matrices (n, n), tangents (n, p), pivots, last factors."""

    df: Floats
    F: Floats
    Ft: Floats
    W: Floats
    G: Floats
    G2: Floats
    H: Floats
    D: Floats
    D1: Floats
    D2: Floats
    pivot: Ints
    seen: Floats


@njit(cache=True, nogil=True)
def _stage(n, nb, nv, ne):
    nz = n + nb + 1
    tau = np.zeros((ne, 6))
    tau[:, 0] = 1.0
    z = np.zeros(nz)
    z[nz - 1] = 1.0
    return Stage(z, np.zeros(nv), tau, np.zeros(nz), np.zeros(nv), np.zeros(n))


@njit(cache=True, nogil=True)
def _work(n, ne, p):
    square = np.zeros((4 if p > 0 else 2, n, n))
    wide = np.zeros((3, n, p))
    last = square.shape[0] - 1
    return Work(
        np.zeros(ne),
        np.zeros(n),
        np.zeros(n),
        square[0],
        square[1],
        square[max(2, last) if p > 0 else 1],
        square[last],
        wide[0],
        wide[1],
        wide[2],
        np.zeros(n, np.int64),
        np.full(ne, np.nan),
    )


@njit(cache=True, nogil=True)
def _changed(T, f, seen):
    """Whether the matrix differs from the one last factorised."""
    out = False
    for e in range(T.m.size):
        if T.dynamic[e] and T.stiff[e] and T.m[e] != 0.0:
            if T.bends[e] or f[e] != seen[e]:
                out = True
            seen[e] = f[e]
    return out


@njit(cache=True, nogil=True)
def _time_slope(T, K0, f, a, q):
    """F_t at the start of the step: boundaries move along a.w, factors along q.df."""
    n = q.Ft.size
    for i in range(n):
        acc = 0.0
        for b in range(n, a.w.size):
            acc += K0[i, b] * a.w[b]
        q.Ft[i] = -acc
    for e in range(T.m.size):
        if T.dynamic[e] and T.m[e] != 0.0:
            c = T.m[e] * f[e] * a.tau[e, 0]
            turn = T.m[e] * directional(T, e, f[e], q.df[e], a.tau, a.w)
            for s in range(T.row_start[e], T.row_start[e + 1]):
                q.Ft[T.row[s]] -= c * a.vw[s] + turn * a.v[s]


@njit(cache=True, nogil=True)
def _factorise(C, gh, q):
    q.W[:, :] = gh * q.G
    for i in range(C.size):
        q.W[i, i] += C[i]
    return lu(q.W, q.pivot)


@njit(cache=True, nogil=True)
def _rates(T, K0, C, f, f2, u2, h, refactor, a, b, q):
    """Both stages of one step: a at its start, b at its end; False if the matrix is singular."""
    n, gh = C.size, GAMMA * h
    evaluate(T, a.z, a.tau)
    patterns(T, a.z, a.v)
    force(T, K0, a.z, f, a.tau, a.v, q.F)
    if refactor:
        jacobian(T, K0, f, a.tau, a.v, q.G)
        if not _factorise(C, gh, q):
            return False
    patterns(T, a.w, a.vw)
    _time_slope(T, K0, f, a, q)
    a.k[:] = q.F + gh * q.Ft
    solve(q.W, q.pivot, a.k)
    b.z[:n] = a.z[:n] + h * a.k
    b.z[n : n + u2.size] = u2
    evaluate(T, b.z, b.tau)
    patterns(T, b.z, b.v)
    force(T, K0, b.z, f2, b.tau, b.v, q.F)
    b.k[:] = q.F - 2.0 * C * a.k - gh * q.Ft
    solve(q.W, q.pivot, b.k)
    return True


@njit(cache=True, nogil=True)
def _directions(T, a, b, n):
    """The directions along which each stage linearises: its rate, and time forwards (a) or backwards (b)."""
    a.w[:n] = a.k
    b.w[:n] = b.k
    b.w[n:] = -a.w[n:]
    patterns(T, a.w, a.vw)
    patterns(T, b.w, b.vw)


@njit(cache=True, nogil=True)
def _taken(T, e, s, f, f0, df, a, b, gh):
    """What stage b takes out of row s by term e, without m; it linearises at the start a of the step."""
    turn = directional(T, e, f0, df, a.tau, b.w)
    return f * b.tau[e, 0] * b.v[s] + gh * (f0 * a.tau[e, 0] * b.vw[s] + turn * a.v[s])


@njit(cache=True, nogil=True)
def _count(T, through, f, f2, h, a, b, q, before, after):
    """Heat through every term over the step (J), by the scheme's own quadrature."""
    gh = GAMMA * h
    for e in range(T.m.size):
        acc = 0.0
        for s in range(T.row_start[e], T.row_start[e + 1]):
            if through[s] != 0.0:
                first = _taken(T, e, s, f[e], f[e], q.df[e], a, a, gh)
                acc += through[s] * (first + _taken(T, e, s, f2[e], f[e], -q.df[e], a, b, gh))
        after[e] = before[e] + 0.5 * h * T.m[e] * acc


@njit(cache=True, nogil=True)
def _moved(T, S, f, f0, df, sign, a, b, gh, out):
    """out -= d m times what stage b takes out, for every multiplier a tangent moves."""
    for i in range(S.term.size):
        e, j, slope = S.term[i], S.tangent[i], S.slope[i]
        for s in range(T.row_start[e], T.row_start[e + 1]):
            out[T.row[s], j] -= slope * _taken(T, e, s, f[e], f0[e], sign * df[e], a, b, gh)


@njit(cache=True, nogil=True)
def _tangents(T, S, K0, C, f, f2, h, curved, a, b, q):
    """Move the tangents q.D over the step."""
    n, gh = C.size, GAMMA * h
    q.D1[:, :] = 0.0
    q.D2[:, :] = 0.0
    subtract_product(q.G, q.D, q.D1)
    if curved:
        bend(T, f, q.df, 1.0, a.tau, a.v, a.w, a.vw, gh, q.H)
        subtract_product(q.H, q.D, q.D1)
        bend(T, f, q.df, -1.0, a.tau, a.v, b.w, b.vw, gh, q.H)
        subtract_product(q.H, q.D, q.D2)
    _moved(T, S, f, f, q.df, 1.0, a, a, gh, q.D1)
    for i in range(n):
        axpy(-a.k[i], S.dC[i], q.D1[i])
    solve_many(q.W, q.pivot, q.D1)
    _moved(T, S, f2, f, q.df, -1.0, a, b, gh, q.D2)
    if curved:
        jacobian(T, K0, f2, b.tau, b.v, q.G2)
    else:
        q.G2[:, :] = q.G
    for i in range(n):
        axpy(h, q.D1[i], q.D[i])
    subtract_product(q.G2, q.D, q.D2)
    for i in range(n):
        axpy(-2.0 * C[i], q.D1[i], q.D2[i])
        axpy(-(b.k[i] + 2.0 * a.k[i]), S.dC[i], q.D2[i])
    solve_many(q.W, q.pivot, q.D2)
    for i in range(n):
        axpy(0.5 * h, q.D1[i], q.D[i])
        axpy(0.5 * h, q.D2[i], q.D[i])


@njit(cache=True, nogil=True)
def _balance_rows(T, K0, C, f, a, q):
    """W = G in the rows without capacity, identity elsewhere; F at a.z. False if singular."""
    evaluate(T, a.z, a.tau)
    patterns(T, a.z, a.v)
    force(T, K0, a.z, f, a.tau, a.v, q.F)
    jacobian(T, K0, f, a.tau, a.v, q.W)
    for i in range(C.size):
        if C[i] > 0.0:
            q.F[i] = 0.0
            q.W[i] = 0.0
            q.W[i, i] = 1.0
    return lu(q.W, q.pivot)


@njit(cache=True, nogil=True)
def settle(T, S, K0, C, f, a, q):
    """Bring the states without capacity to their balance at fixed others (Newton), tangents with them."""
    n = C.size
    for _ in range(MOST_ITERATIONS):
        if not _balance_rows(T, K0, C, f, a, q):
            return False
        solve(q.W, q.pivot, q.F)
        a.z[:n] += q.F
        if np.max(np.abs(q.F)) < CONVERGED_K:
            break
    else:
        return False
    if S.dC.shape[1] > 0:
        _balance_rows(T, K0, C, f, a, q)
        q.D1[:, :] = 0.0
        a.w[:] = 0.0
        a.vw[:] = 0.0
        _moved(T, S, f, f, q.df, 0.0, a, a, 0.0, q.D1)
        for i in range(n):
            if C[i] > 0.0:
                q.D1[i] = q.D[i]
        solve_many(q.W, q.pivot, q.D1)
        q.D[:, :] = q.D1
    return np.all(np.isfinite(a.z))


@njit(cache=True, nogil=True)
def _outputs(R, z, D, y, dy):
    n, p = D.shape
    for r in range(y.size):
        for i in range(R.start[r], R.start[r + 1]):
            y[r] += R.weight[i] * z[R.at[i]]
            if p > 0 and R.at[i] < n:
                axpy(R.weight[i], D[R.at[i]], dy[r])


@njit(cache=True, nogil=True)
def integrate(time, u, x0, C, K0, T, S, R, through, z_out, y, dy, heat):
    """March over the record; -1, or the index of the time at which the matrix was singular or x not finite.

    u (nt, nb); x0, C (n,); K0 (n, n + nb + 1) constant terms; T, S, R as declared above
    through : (rows of all terms,) weights that sum a term's rows to the heat through it
    z_out (nt or 0, n + nb), y (nt, nr), dy (nt, nr, p), heat (nt or 0, ne) cumulated J: filled here, zero before
    """
    n, nb, ne = x0.size, u.shape[1], T.m.size
    a, b = _stage(n, nb, T.row.size, ne), _stage(n, nb, T.row.size, ne)
    q = _work(n, ne, S.dC.shape[1])
    p, count = S.dC.shape[1], heat.shape[0] > 0
    curved = np.any(T.dynamic * T.stiff == 1)
    a.z[:n], a.z[n : n + nb] = x0, u[0]
    massless = np.any(C == 0.0)
    h_last = -1.0
    for t in range(time.size):
        h = time[t] - time[max(t - 1, 0)]
        if h > 0.0:
            f, f2 = T.factor[t - 1], T.factor[t]
            h = h_last if abs(h - h_last) <= 1e-12 * h else h
            q.df[:] = (f2 - f) / h
            a.w[:n] = 0.0
            a.w[n : n + nb] = (u[t] - u[t - 1]) / h
            fresh = _changed(T, f, q.seen) or h != h_last
            if not _rates(T, K0, C, f, f2, u[t], h, fresh, a, b, q):
                return t
            h_last = h
            if p > 0 or count:
                _directions(T, a, b, n)
            if p > 0:
                _tangents(T, S, K0, C, f, f2, h, curved, a, b, q)
            if count:
                _count(T, through, f, f2, h, a, b, q, heat[t - 1], heat[t])
            a.z[:n] += h * (1.5 * a.k + 0.5 * b.k)
            if not np.all(np.isfinite(a.z[:n])):
                return t
        elif count and t > 0:
            heat[t] = heat[t - 1]
        a.z[n : n + nb] = u[t]
        if h == 0.0 and massless:
            h_last = -1.0
            if not settle(T, S, K0, C, T.factor[t], a, q):
                return t
        if z_out.shape[0] > 0:
            z_out[t] = a.z[: n + nb]
        _outputs(R, a.z, q.D, y[t], dy[t])
    return -1


@njit(cache=True, nogil=True)
def rest(u, x0, K0, T, S, R, z, y, dy, G):
    """The state at which nothing changes any more (all capacities set aside); False if there is none.

    u (1, nb); x0 (n,) first guess; z (n + nb,), y (1, nr), dy (1, nr, p) and G = -dF/dx (n, n) are filled here.
    """
    n, nb, ne = x0.size, u.shape[1], T.m.size
    a, q = _stage(n, nb, T.row.size, ne), _work(n, ne, S.dC.shape[1])
    a.z[:n], a.z[n : n + nb] = x0, u[0]
    if not settle(T, S, K0, np.zeros(n), T.factor[0], a, q):
        return False
    evaluate(T, a.z, a.tau)
    patterns(T, a.z, a.v)
    jacobian(T, K0, T.factor[0], a.tau, a.v, G)
    z[:] = a.z[: n + nb]
    _outputs(R, a.z, q.D, y[0], dy[0])
    return True
