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
from lumped.jit import entry, inner
from lumped.terms import Floats, Ints, bend, clear, directional, evaluate, force, jacobian, patterns

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


def stage(n: int, nb: int, nv: int, ne: int) -> Stage:
    """A stage's arrays for n states, nb boundaries, nv rows of all terms and ne terms."""
    nz = n + nb + 1
    tau, z = np.zeros((ne, 6)), np.zeros(nz)
    tau[:, 0] = 1.0
    z[nz - 1] = 1.0
    return Stage(z, np.zeros(nv), tau, np.zeros(nz), np.zeros(nv), np.zeros(n))


def work(n: int, ne: int, p: int) -> Work:
    """Scratch for n states, ne terms and p tangents."""
    W, G, G2, H = np.zeros((4, n, n))
    D, D1, D2 = np.zeros((3, n, p))
    F, Ft = np.zeros(n), np.zeros(n)
    pivot, seen = np.zeros(n, np.int64), np.full(ne, np.nan)
    return Work(np.zeros(ne), F, Ft, W, G, G2, H, D, D1, D2, pivot, seen)


@inner
def _changed(T, f, seen):
    """Whether the matrix differs from the one last factorised."""
    out = False
    for e in range(T.m.size):
        if T.dynamic[e] and T.stiff[e] and T.m[e] != 0.0:
            if T.bends[e] or f[e] != seen[e]:
                out = True
            seen[e] = f[e]
    return out


@inner
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


@inner
def _factorise(C, gh, q):
    n = C.size
    for i in range(n):
        for j in range(n):
            q.W[i, j] = gh * q.G[i, j]
        q.W[i, i] += C[i]
    return lu(q.W, q.pivot)


@inner
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
    for i in range(n):
        a.k[i] = q.F[i] + gh * q.Ft[i]
    solve(q.W, q.pivot, a.k)
    for i in range(n):
        b.z[i] = a.z[i] + h * a.k[i]
    for i in range(u2.size):
        b.z[n + i] = u2[i]
    evaluate(T, b.z, b.tau)
    patterns(T, b.z, b.v)
    force(T, K0, b.z, f2, b.tau, b.v, q.F)
    for i in range(n):
        b.k[i] = q.F[i] - 2.0 * C[i] * a.k[i] - gh * q.Ft[i]
    solve(q.W, q.pivot, b.k)
    return True


@inner
def _directions(T, a, b, n):
    """The directions along which each stage linearises: its rate, and time forwards (a) or backwards (b)."""
    for i in range(n):
        a.w[i] = a.k[i]
        b.w[i] = b.k[i]
    for i in range(n, a.w.size):
        b.w[i] = -a.w[i]
    patterns(T, a.w, a.vw)
    patterns(T, b.w, b.vw)


@inner
def _taken(T, e, s, f, f0, df, a, b, gh):
    """What stage b takes out of row s by term e, without m; it linearises at the start a of the step."""
    turn = directional(T, e, f0, df, a.tau, b.w)
    return f * b.tau[e, 0] * b.v[s] + gh * (f0 * a.tau[e, 0] * b.vw[s] + turn * a.v[s])


@inner
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


@inner
def _moved(T, S, f, f0, df, sign, a, b, gh, out):
    """out -= d m times what stage b takes out, for every multiplier a tangent moves."""
    for i in range(S.term.size):
        e, j, slope = S.term[i], S.tangent[i], S.slope[i]
        for s in range(T.row_start[e], T.row_start[e + 1]):
            out[T.row[s], j] -= slope * _taken(T, e, s, f[e], f0[e], sign * df[e], a, b, gh)


@inner
def _tangents(T, S, K0, C, f, f2, h, curved, a, b, q):
    """Move the tangents q.D over the step."""
    n, gh = C.size, GAMMA * h
    clear(q.D1)
    clear(q.D2)
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
        for i in range(n):
            copy(q.G[i], q.G2[i])
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


@inner
def _finite(x):
    total = 0.0
    for i in range(x.size):
        total += 0.0 * x[i]
    return total == 0.0


@inner
def _begin(T, u, t, h, a, q):
    """Slopes of factors (q.df) and boundaries (a.w) over the step that ends at index t."""
    n, nb = q.F.size, u.shape[1]
    for e in range(T.m.size):
        q.df[e] = (T.factor[t, e] - T.factor[t - 1, e]) / h
    for i in range(n):
        a.w[i] = 0.0
    for b in range(nb):
        a.w[n + b] = (u[t, b] - u[t - 1, b]) / h


@inner
def _balance_rows(T, K0, C, f, a, q):
    """W = G in the rows without capacity, identity elsewhere; F at a.z. False if singular."""
    evaluate(T, a.z, a.tau)
    patterns(T, a.z, a.v)
    force(T, K0, a.z, f, a.tau, a.v, q.F)
    jacobian(T, K0, f, a.tau, a.v, q.W)
    for i in range(C.size):
        if C[i] > 0.0:
            q.F[i] = 0.0
            for j in range(C.size):
                q.W[i, j] = 0.0
            q.W[i, i] = 1.0
    return lu(q.W, q.pivot)


@inner
def settle(T, K0, C, f, a, q):
    """Bring the states without capacity to their balance at fixed others (Newton)."""
    n = C.size
    for _ in range(MOST_ITERATIONS):
        if not _balance_rows(T, K0, C, f, a, q):
            return False
        solve(q.W, q.pivot, q.F)
        largest = 0.0
        for i in range(n):
            a.z[i] += q.F[i]
            largest = max(largest, abs(q.F[i]))
        if largest < CONVERGED_K:
            break
    else:
        return False
    return _finite(a.z)


@inner
def settle_tangents(T, S, K0, C, f, a, q):
    """The tangents of the states without capacity, at their balance."""
    _balance_rows(T, K0, C, f, a, q)
    clear(q.D1)
    for i in range(a.w.size):
        a.w[i] = 0.0
    for i in range(a.vw.size):
        a.vw[i] = 0.0
    _moved(T, S, f, f, q.df, 0.0, a, a, 0.0, q.D1)
    for i in range(C.size):
        if C[i] > 0.0:
            copy(q.D[i], q.D1[i])
    solve_many(q.W, q.pivot, q.D1)
    for i in range(C.size):
        copy(q.D1[i], q.D[i])


@inner
def _outputs(R, z, y):
    for r in range(y.size):
        for i in range(R.start[r], R.start[r + 1]):
            y[r] += R.weight[i] * z[R.at[i]]


@inner
def _tangent_outputs(R, D, dy):
    for r in range(dy.shape[0]):
        for i in range(R.start[r], R.start[r + 1]):
            if R.at[i] < D.shape[0]:
                axpy(R.weight[i], D[R.at[i]], dy[r])


@inner
def _has_both(x, y):
    found = 0
    for i in range(x.size):
        found += x[i] * y[i]
    return found > 0


@inner
def _has_zero(x):
    smallest = np.inf
    for i in range(x.size):
        smallest = min(smallest, abs(x[i]))
    return smallest == 0.0


@inner
def _start(a, x0, u):
    """x0 and the first boundary temperatures into the stage's z."""
    for i in range(x0.size):
        a.z[i] = x0[i]
    for b in range(u.shape[1]):
        a.z[x0.size + b] = u[0, b]


@entry
def integrate(time, u, x0, C, K0, T, S, R, through, a, b, q, z_out, y, dy, heat):
    """March over the record; -1, or the index of the time at which the matrix was singular or x not finite.

    u (nt, nb); x0, C (n,); K0 (n, n + nb + 1) constant terms; T, S, R as declared above
    through : (rows of all terms,) weights that sum a term's rows to the heat through it
    a, b, q : from stage() and work()
    z_out (nt or 0, n + nb), y (nt, nr), dy (nt, nr, p), heat (nt, ne) cumulated J: filled here, zero before
    S is None without tangents and heat where none is counted: their code is then not even compiled
    """
    n, nb, ne = x0.size, u.shape[1], T.m.size
    curved, massless = _has_both(T.dynamic, T.stiff), _has_zero(C)
    _start(a, x0, u)
    h_last = -1.0
    for t in range(time.size):
        h = time[t] - time[max(t - 1, 0)]
        if h > 0.0:
            f, f2 = T.factor[t - 1], T.factor[t]
            h = h_last if abs(h - h_last) <= 1e-12 * h else h
            _begin(T, u, t, h, a, q)
            fresh = _changed(T, f, q.seen) or h != h_last
            if not _rates(T, K0, C, f, f2, u[t], h, fresh, a, b, q):
                return t
            h_last = h
            if S is not None or heat is not None:
                _directions(T, a, b, n)
            if S is not None:
                _tangents(T, S, K0, C, f, f2, h, curved, a, b, q)
            if heat is not None:
                _count(T, through, f, f2, h, a, b, q, heat[t - 1], heat[t])
            for i in range(n):
                a.z[i] += h * (1.5 * a.k[i] + 0.5 * b.k[i])
            if not _finite(a.z):
                return t
        elif heat is not None and t > 0:
            for e in range(ne):
                heat[t, e] = heat[t - 1, e]
        for i in range(nb):
            a.z[n + i] = u[t, i]
        if h == 0.0 and massless:
            h_last = -1.0
            if not settle(T, K0, C, T.factor[t], a, q):
                return t
            if S is not None:
                settle_tangents(T, S, K0, C, T.factor[t], a, q)
        if z_out.shape[0] > 0:
            for i in range(n + nb):
                z_out[t, i] = a.z[i]
        _outputs(R, a.z, y[t])
        if S is not None:
            _tangent_outputs(R, q.D, dy[t])
    return -1


@entry
def rest(u, x0, none, K0, T, S, R, a, q, z, y, dy, G):
    """The state at which nothing changes any more (all capacities set aside); False if there is none.

    u (1, nb); x0 (n,) first guess; none (n,) zeros; S is None without tangents; a, q : from stage() and work()
    z (n + nb,), y (1, nr), dy (1, nr, p) and G = -dF/dx (n, n) are filled here.
    """
    n, nb = x0.size, u.shape[1]
    _start(a, x0, u)
    if not settle(T, K0, none, T.factor[0], a, q):
        return False
    if S is not None:
        settle_tangents(T, S, K0, none, T.factor[0], a, q)
        _tangent_outputs(R, q.D, dy[0])
    evaluate(T, a.z, a.tau)
    patterns(T, a.z, a.v)
    jacobian(T, K0, T.factor[0], a.tau, a.v, G)
    for i in range(n + nb):
        z[i] = a.z[i]
    _outputs(R, a.z, y[0])
    return True
