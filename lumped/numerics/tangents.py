"""How the readings of a run answer to its multipliers: exact tangents of the scheme. It is compiled on its own.

They differentiate exactly the equations of stages.py, second derivatives of the temperature laws included, along the
steps that the kernel took: those are the same, whatever the multipliers.
"""

from typing import NamedTuple

from lumped.numerics.dense import axpy, solve_many
from lumped.numerics.jit import entry, inner, pasted
from lumped.numerics.stages import C21, C31, C32, EULER, GAMMA, forced, inside, restored, slope_of, stage_outflow
from lumped.numerics.steady_start import outside
from lumped.numerics.terms import (
    BENDS,
    DYNAMIC,
    END,
    ROW,
    STIFF,
    Array,
    Ints,
    clear,
    conductance_derivative,
    conductance_difference,
    flow,
    jacobian,
    pattern_products,
    patterns,
    spread,
)


class Tangents(NamedTuple):
    """Which multiplier each tangent moves: d m[term] / d theta[tangent] = slope; which capacity: d C[state] /
    d theta[column] = mass.

    first (n + nb, p) : of the states at the start, and of the boundaries all along
    """

    tangent: Ints
    term: Ints
    slope: Array
    state: Ints
    column: Ints
    mass: Array
    first: Array


@inner
def _moved(T, S, stage, a, q, h, out):
    """out -= d m times what a stage takes out, for every multiplier a tangent moves."""
    for i in range(S.term.size):
        e, j, slope = S.term[i], S.tangent[i], S.slope[i]
        for s in range(T.part[e, ROW], T.part[e, END]):
            out[T.row[s], j] -= slope * stage_outflow(T, e, s, stage, a, q, h)


@inner
def _heavier(S, c, U, out):
    """out += c dC U."""
    for i in range(S.state.size):
        out[S.state[i], S.column[i]] += c * U[S.state[i]] * S.mass[i]


@inner
def _common(c, d, first, turn, second, third):
    """What the second and third stage share: turn + c d, and what each has of the first."""
    c2, c3 = GAMMA * C21 * c, GAMMA * C31 * c
    for k in range(d.size):
        both = turn[k] + c * d[k]
        second[k] += both + c2 * first[k]
        third[k] += both + c3 * first[k]


@inner
def _less(x, y):
    """y -= x."""
    for k in range(x.size):
        y[k] -= x[k]


@inner
def _rosenbrock(T, S, C, h, curved, L, slot, B, a, q):
    """Move the tangents q.D over a step whose stages are restored and whose matrix is factored.

    With W = C + gh G of the start, W^-1 gh G D = D - W^-1 C D: no product with G is needed.
    """
    n, gh, R0, R1, R2, R3 = C.size, GAMMA * h, q.R[0], q.R[1], q.R[2], q.R[3]
    for stage in range(4):
        clear(q.R[stage])
    if curved:
        pattern_products(T, q.D, q.V)
        late = slope_of(0) * h, slope_of(1) * h, slope_of(2) * h
        conductance_derivative(T, q.f[0], q.df, late, a.tau[0], a.v[0], a.vw, gh, q.V, q.R)
    for stage in range(3):
        _moved(T, S, stage, a, q, h, q.R[stage])
        _heavier(S, -1.0, a.w[stage], q.R[stage])
    outside(B, q.D, gh, R0)
    for i in range(n):
        axpy(C[i], q.D[i], R0[i])
    solve_many(L, slot, R0)
    for i in range(n):
        _less(q.D[i], R0[i])
        axpy(1.0 / GAMMA, R0[i], q.D[i])
    if curved:
        pattern_products(T, q.D, q.V)
        conductance_difference(T, q.f, a.tau, a.v, gh, q.V, R3)
    outside(B, q.D, gh, R3)
    _heavier(S, GAMMA * C21, a.w[0], R1)
    _heavier(S, GAMMA * C31, a.w[0], R2)
    for i in range(n):
        _common(C[i], q.D[i], R0[i], R3[i], R1[i], R2[i])
    solve_many(L, slot, R1)
    _heavier(S, GAMMA * C32, a.w[1], R2)
    for i in range(n):
        _less(q.D[i], R1[i])
        axpy(GAMMA * C32 * C[i], R1[i], R2[i])
    solve_many(L, slot, R2)
    for i in range(n):
        _less(q.D[i], R2[i])
        axpy(1.0, R2[i], q.D[i])


@inner
def _euler(T, S, K0, C, h, x0, U, L, slot, a, q):
    """Move the tangents over a step of implicit Euler with the coefficients of its start."""
    n = C.size
    for i in range(n):
        a.z[1, i], a.w[0, i] = x0[i], U[0, i]
    for i in range(n, a.w[0].size):
        a.w[0, i] = 0.0
    flow(T, K0, a.z[1], q.f[1], a.tau[1], a.v[1], q.F[1])
    patterns(T, a.w[0], a.vw[0])
    jacobian(T, K0, q.f[1], a.tau[1], a.v[1], q.G)
    clear(q.H)
    for e in range(T.m.size):
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.kind[e, BENDS] and T.m[e] != 0.0:
            c = T.m[e] * q.f[1, e]
            spread(T, e, a.vw[0], c * a.tau[1, e, 1], c * a.tau[1, e, 2], q.H)
    clear(q.R[0])
    for i in range(n):
        for j in range(len(q.D)):
            axpy(-h * (q.G[i, j] + q.H[i, j]), q.D[j], q.R[0, i])
    for i in range(S.term.size):
        e, j, c = S.term[i], S.tangent[i], h * S.slope[i]
        c *= q.f[1, e] * a.tau[1, e, 0]
        for s in range(T.part[e, ROW], T.part[e, END]):
            q.R[0, T.row[s], j] -= c * (a.v[1, s] + a.vw[0, s])
    _heavier(S, -1.0, a.w[0], q.R[0])
    solve_many(L, slot, q.R[0])
    for i in range(n):
        axpy(1.0, q.R[0, i], q.D[i])


@pasted
def _outputs(R, D, dy):
    clear(dy)
    for r in range(len(dy)):
        for i in range(R.start[r], R.start[r + 1]):
            if R.at[i] < len(D):
                axpy(R.weight[i], D[R.at[i]], dy[r])


@inner
def _printed(R, t, until, D, dy):
    """The tangents of the outputs at samples up to, not including, `until`; that sample."""
    while t < until:
        _outputs(R, D, dy[t])
        t += 1
    return t


@inner
def _within(Q, R, X, k, t, q, dy):
    """The tangents of the outputs at samples inside a step, whose end is q.D and whose stages are q.R; the next."""
    n, j, s0, s1 = len(q.G), X.knot[k], X.start[k], X.share[k]
    while t < Q.first[j + 1] and Q.share[t] < 1.0 and Q.share[t] <= s1:
        _outputs(R, q.D, dy[t])
        for stage in range(3):
            c = inside(X.kind[k], (Q.share[t] - s0) / (s1 - s0), stage)
            for r in range(len(dy[t])):
                for i in range(R.start[r], R.start[r + 1]):
                    if R.at[i] < n:
                        axpy(c * R.weight[i], q.R[stage, R.at[i]], dy[t, r])
        t += 1
    return t


@entry
def differentiate(Q, C, K0, T, S, R, curved, X, steps, t, until, a, q, dy):
    """dy (nt, nr, p): how the outputs of a run answer to what S moves; filled here from sample t to before `until`.

    curved : whether any dynamic term touches the matrix
    X, steps : the trace of the run and how many steps it holds;  all else as for the kernel
    a, q : the tangents of states and boundaries start at q.D and are left there at the end
    """
    for k in range(steps):
        j, h, slot = X.knot[k], X.h[k], X.slot[k]
        t = _printed(R, t, Q.first[j], q.D, dy)
        for i in range(a.z[0].size - 1):
            a.z[0, i] = X.x[k, i]
        forced(Q, j, X.start[k], X.share[k], a, q)
        if X.kind[k] == EULER:
            _euler(T, S, K0, C, h, X.x[k], X.U[k], X.L, slot, a, q)
        else:
            restored(T, K0, X.x[k], X.U[k], h, a, q)
            _rosenbrock(T, S, C, h, curved, X.L, slot, X.B[slot], a, q)
        t = _within(Q, R, X, k, t, q, dy)
        if X.share[k] == 1.0:
            t = _printed(R, t, Q.first[j + 1], q.D, dy)
    _printed(R, t, until, q.D, dy)
