"""The compiled kernel: adaptive steps of one scheme (stages.py) for any network, and what a step has to pass.

Within every interval between two knots it takes the steps that its error estimate asks for; samples inside a step are
read from the parabola that its stages give every state. The estimate is what the end of the step, put into the
equations, leaves over (Hairer and Wanner 1996, sec. IV.8, filtered by the step's own matrix):

    error = W^-1 gamma h (F(t1, x1) - C x'(t1)),   x'(t1) from the stages

F(t1, x1) serves the next step. The error is of second order.
Where all coefficients are positive a step must also keep the maximum principle: no node colder than all that came
before, none warmer without a source that heats it. What only some runs need is compiled when first asked for.
"""

from typing import NamedTuple

from lumped.numerics.dense import Factored, copy, lu, shifted, solve
from lumped.numerics.jit import entry, inner, pasted
from lumped.numerics.stages import (
    C21,
    C31,
    C32,
    END1,
    END2,
    END3,
    EULER,
    GAMMA,
    ROSENBROCK,
    SLOPE2,
    boundary,
    finite,
    forced,
    inside,
)
from lumped.numerics.terms import (
    DYNAMIC,
    END,
    ROW,
    SOURCE,
    Array,
    Ints,
    conductances,
    directional,
    flow,
    jacobian,
    patterns,
)

KNOT, COUNT, STATUS, NODE, FRESH, SAMPLE = range(6)
SHARE, FACTORED, NEXT, LOW = range(4)
FULL, SINGULAR, OUTSIDE, HOT = range(1, 5)
MOST_TRIES = 12  # from 0.9 of an interval to a millionth of it, and less where the estimate asks for it
LARGEST = 5e-3  # K: what rounding and the estimate itself leave of the maximum principle


class Rows(NamedTuple):
    """Outputs as sparse rows over z+: entries start[r]:start[r + 1] of at, weight.

    state (n + nb,) : which state or boundary of the network every one of the kernel's is, for states that are kept
    """

    start: Ints
    at: Ints
    weight: Array
    state: Ints


class Control(NamedTuple):
    """unit (n,) K per unit of a state;  node (n,) 1 where it is a temperature, 0 for a shape's amplitude

    tolerance (2,): K, and as a share of the range of temperatures;  principle (1,) 1 where the maximum principle holds
    hottest (1,) degC, beyond which nothing goes on;  follow (1,) 1 to take the steps that the trace holds
    """

    unit: Array
    node: Ints
    tolerance: Array
    principle: Ints
    hottest: Array
    follow: Ints


class Trace(NamedTuple):
    """The steps of a portion (ns): in the interval before which knot, from which share of it to which, ROSENBROCK or
    EULER, states at the start (ns, n + nb), increments (ns, 3, n), length (s).

    L : the LU they were taken with, in slot (ns,);  B (slots, n, nb) : -dF by the boundaries, likewise
    """

    knot: Ints
    start: Array
    share: Array
    kind: Ints
    x: Array
    U: Array
    h: Array
    slot: Ints
    L: Factored
    B: Array


class Position(NamedTuple):
    """Where a run is.

    at (6,) : the next knot, steps in the trace, status, node it names, whether F is known, the next sample
    clock (4,) : share of the interval that is done, length of the factored step and of the next (s), coldest (degC)
    """

    at: Ints
    clock: Array


@pasted
def _along_time(T, K0, a, q, out):
    """out = F_t at the start of the step (per s): boundaries move along du, factors along df."""
    n, w, v, vw, tau = out.size, a.w[2], a.v[0], a.vw[2], a.tau[0]
    for i in range(w.size):
        w[i] = q.du[i - n] if n <= i < n + q.du.size else 0.0
    patterns(T, w, vw)
    for i in range(n):
        acc = 0.0
        for b in range(q.du.size):
            acc += K0[i, n + b] * q.du[b]
        out[i] = -acc
    for e in range(T.m.size):
        if T.kind[e, DYNAMIC] and T.m[e] != 0.0:
            c = T.m[e] * q.f[0, e] * tau[e, 0]
            turn = T.m[e] * directional(T, e, q.f[0], q.df, 1.0, tau, vw)
            for s in range(T.part[e, ROW], T.part[e, END]):
                out[T.row[s]] -= c * vw[s] + turn * v[s]


@inner
def _rosenbrock(T, K0, C, h, L, slot, a, q):
    """The stages with the matrix at hand: x1 and F there into slot 2, the error of the step."""
    n, gh, w0, w1, w2, Ft = C.size, GAMMA * h, a.w[0], a.w[1], a.w[2], q.F[2]
    _along_time(T, K0, a, q, Ft)
    for i in range(n):
        w0[i] = gh * (q.F[0, i] + gh * Ft[i])
    solve(L, slot, w0[:n])
    for i in range(n):
        a.z[1, i] = a.z[0, i] + w0[i] / GAMMA
    flow(T, K0, a.z[1], q.f[1], a.tau[1], a.v[1], q.F[1])
    for i in range(n):
        w1[i] = gh * (q.F[1, i] + SLOPE2 * h * Ft[i]) + GAMMA * C21 * C[i] * w0[i]
    solve(L, slot, w1[:n])
    for i in range(n):
        w2[i] = gh * q.F[1, i] + GAMMA * C[i] * (C31 * w0[i] + C32 * w1[i])
    solve(L, slot, w2[:n])
    for i in range(n):
        a.z[2, i] = a.z[1, i] + w2[i]
    flow(T, K0, a.z[2], q.f[1], a.tau[2], a.v[2], q.F[2])
    for i in range(n):
        q.error[i] = gh * q.F[2, i] - GAMMA * C[i] * (END1 * w0[i] + END2 * w1[i] + END3 * w2[i])
    solve(L, slot, q.error)


@inner
def _euler(T, K0, C, h, L, slot, a, q):
    """The step by an M-matrix, with the coefficients of the start; the error of the step is what it moves."""
    n = C.size
    for i in range(n):
        a.z[1, i] = a.z[0, i]
    flow(T, K0, a.z[1], q.f[1], a.tau[1], a.v[1], q.F[1])
    conductances(T, K0, q.f[1], a.tau[1], q.G)
    shifted(q.G, h, C, L, slot)
    if not lu(L, slot):
        return False
    for i in range(n):
        a.w[0, i], a.w[1, i], a.w[2, i] = h * q.F[1, i], 0.0, 0.0
    solve(L, slot, a.w[0][:n])
    for i in range(n):
        a.z[2, i] = a.z[0, i] + a.w[0, i]
        q.error[i] = 0.5 * a.w[0, i]
    flow(T, K0, a.z[2], q.f[1], a.tau[2], a.v[2], q.F[2])
    return True


@pasted
def _size(L, z, error, n):
    """Error over what is allowed."""
    low, high, largest = z[n], z[n], 0.0
    for i in range(z.size - 1):
        if i >= n or L.node[i]:
            low, high = min(low, z[i]), max(high, z[i])
    for i in range(n):
        largest = max(largest, L.unit[i] * abs(error[i]))
    return largest / (L.tolerance[0] + L.tolerance[1] * (high - low))


@pasted
def _heat(T, K0, a, q):
    """Least and most heat of all sources of a node over the step (W)."""
    n, last = q.F[0].size, a.z[0].size - 1
    for i in range(n):
        q.heat[0, i] = q.heat[1, i] = 0.0
    for e in range(T.m.size):
        if T.kind[e, SOURCE] and T.kind[e, DYNAMIC] and T.m[e] != 0.0:
            for s in range(T.part[e, ROW], T.part[e, END]):
                start = -T.m[e] * q.f[0, e] * a.tau[0, e, 0] * a.v[0, s]
                end = -T.m[e] * q.f[1, e] * a.tau[2, e, 0] * a.v[2, s]
                q.heat[0, T.row[s]] += min(start, end)
                q.heat[1, T.row[s]] += max(start, end)
    for i in range(n):
        q.heat[0, i] -= K0[i, last]
        q.heat[1, i] -= K0[i, last]


@inner
def _outside(T, K0, C, h, P, a, q):
    """The node that the step puts where the maximum principle allows none, or -1."""
    n, z0, z1 = C.size, a.z[0], a.z[2]
    _heat(T, K0, a, q)
    top, hot, rate, bare = z0[n], -1e300, 0.0, False
    for i in range(z0.size - 1):
        top = max(top, z0[i])
        if i >= n:
            arch = 0.25 * abs(z0[i] + h * q.du[i - n] - z1[i])
            top = max(top, max(z0[i], z1[i]) + arch)
            P.clock[LOW] = min(P.clock[LOW], min(z0[i], z1[i]) - arch)
    for i in range(n):
        if q.heat[0, i] < 0.0:
            P.clock[LOW] = -1e300
        if q.heat[1, i] > 0.0:
            hot = max(hot, z1[i])
            if C[i] > 0.0:
                rate = max(rate, q.heat[1, i] / C[i])
            else:
                bare = True
    for i in range(n):
        most = top + h * rate if q.heat[1, i] > 0.0 else max(top, hot)
        free = q.heat[1, i] > 0.0 and bare
        if z1[i] < P.clock[LOW] - LARGEST or (not free and z1[i] > most + LARGEST):
            return i
    return -1


@inner
def _attempt(T, K0, C, kind, h, build, L, X, slot, P, a, q):
    """A step; how many times the allowed error it has, at least: below 1 it may stand."""
    if kind == EULER:
        if not _euler(T, K0, C, h, X.L, slot, a, q):
            P.at[STATUS] = SINGULAR
            return 1e300
        P.clock[FACTORED] = -1.0
    else:
        if build:
            for i in range(C.size):
                copy(q.G[i, C.size :], X.B[slot, i])
            shifted(q.G, GAMMA * h, C, X.L, slot)
            if not lu(X.L, slot):
                P.at[STATUS] = SINGULAR
                P.clock[FACTORED] = -1.0
                return 1e300
            P.clock[FACTORED] = h
        _rosenbrock(T, K0, C, h, X.L, slot, a, q)
    if not finite(a.z[2]):
        P.at[STATUS] = SINGULAR
        return 1e300
    size = _size(L, a.z[2], q.error, C.size)
    if L.principle[0]:
        node = _outside(T, K0, C, h, P, a, q)
        if node >= 0:
            P.at[STATUS], P.at[NODE] = OUTSIDE, node
            return max(size, 1e3)
    return size


@inner
def _accept(X, k, slot, P, L, kind, h, s1, a, q, n):
    """Write down the step and go to its end."""
    X.knot[k], X.start[k], X.share[k], X.kind[k], X.h[k] = P.at[KNOT], P.clock[SHARE], s1, kind, h
    X.slot[k] = slot
    for i in range(X.x[k].size):
        X.x[k, i] = a.z[0, i]
    for stage in range(3):
        for i in range(n):
            X.U[k, stage, i] = a.w[stage, i]
    for i in range(n):
        if L.node[i] and not abs(a.z[2, i]) < L.hottest[0]:
            P.at[STATUS], P.at[NODE] = HOT, i
        q.F[0, i] = q.F[2, i]
    copy(a.z[2], a.z[0])
    copy(a.v[2], a.v[0])
    for e in range(len(a.tau[0])):
        copy(a.tau[2, e], a.tau[0, e])


@inner
def _step(Q, C, K0, T, L, X, k, P, a, q):
    """One step that stands, smaller where the first does not; False if none does."""
    j, s0 = P.at[KNOT], P.clock[SHARE]
    span = Q.time[j] - Q.time[j - 1]
    if P.at[FRESH] == 0:
        forced(Q, j, s0, 1.0, a, q)
        flow(T, K0, a.z[0], q.f[0], a.tau[0], a.v[0], q.F[0])
    has_jacobian, next_h, last = False, P.clock[NEXT], X.slot[k - 1] if k > 0 else -1
    for tries in range(MOST_TRIES + 1):
        rest = (1.0 - s0) * span
        count = max(1.0, -((-rest * (1.0 - 1e-9)) // next_h))
        kind, s1, h = ROSENBROCK, 1.0 if count == 1.0 else s0 + (1.0 - s0) / count, rest / count
        if L.follow[0]:
            kind, s1 = X.kind[k], X.share[k]
            h = (s1 - s0) * span
        elif tries == MOST_TRIES and L.principle[0]:
            kind = EULER
        if abs(h - P.clock[FACTORED]) <= 1e-12 * h:
            h = P.clock[FACTORED]
        forced(Q, j, s0, s1, a, q)
        changed = Q.renew[j] == 2 or (Q.renew[j] == 1 and s0 == 0.0)
        build = (changed and not has_jacobian) or h != P.clock[FACTORED]
        if build and kind == ROSENBROCK and not has_jacobian:
            jacobian(T, K0, q.f[0], a.tau[0], a.v[0], q.G)
            has_jacobian = True
        slot = (last + 1) % len(X.B) if build or kind == EULER or tries > 0 else last
        P.at[STATUS] = 0
        size = _attempt(T, K0, C, kind, h, build, L, X, slot, P, a, q)
        if size <= 1.0 or (P.at[STATUS] == 0 and (L.follow[0] or kind == EULER)) or (L.follow[0] and size < 1e300):
            P.at[STATUS] = 0
            _accept(X, k, slot, P, L, kind, h, s1, a, q, C.size)
            P.clock[SHARE], P.clock[NEXT], P.at[FRESH] = s1, h * min(max(0.9 * size ** (-1 / 3), 0.2), 8.0), 1
            return P.at[STATUS] == 0
        if L.follow[0]:
            return False
        next_h = h * min(max(0.8 * size ** (-1 / 3), 0.05), 0.5)
    return False


@pasted
def _outputs(R, z, y):
    """The outputs at z."""
    for r in range(y.size):
        acc = 0.0
        for i in range(R.start[r], R.start[r + 1]):
            acc += R.weight[i] * z[R.at[i]]
        y[r] = acc


@inner
def _within(Q, R, X, k, P, a, q, z, y):
    """The samples inside a step that is written down, by its own parabola of every state."""
    n, j, t, s0, s1, U = q.F[0].size, X.knot[k], P.at[SAMPLE], X.start[k], X.share[k], X.U[k]
    while t < Q.first[j + 1] and Q.share[t] < 1.0 and Q.share[t] <= s1:
        s = (Q.share[t] - s0) / (s1 - s0)
        c0, c1, c2 = inside(X.kind[k], s, 0), inside(X.kind[k], s, 1), inside(X.kind[k], s, 2)
        for i in range(n):
            a.z[1, i] = a.z[0, i] + c0 * U[0, i] + c1 * U[1, i] + c2 * U[2, i]
        for b in range(q.du.size):
            a.z[1, n + b] = boundary(Q, j, Q.share[t], b)
        _sampled(R, t, a.z[1], z, y)
        t += 1
    P.at[SAMPLE] = t


@inner
def _sampled(R, t, now, z, y):
    if len(z) > 0:
        for i in range(z[t].size):
            z[t, R.state[i]] = now[i]
    if y[t].size > 0:
        _outputs(R, now, y[t])


@entry
def integrate(Q, C, K0, T, R, L, X, P, a, q, z, y):
    """March over a record from where P is until its end, or until the trace is full or no step stands: see P.at.

    Q : what drives the network;  C (n,);  K0 (n, n + nb + 1) constant terms;  T, R, L as declared above
    X, P : the steps taken, where the run is;  a, q : from stages() and work(): states at a.z[0]
    z (nt or 0, n + nb), y (nt, nr) : states, outputs: filled here
    """
    n, nb = C.size, q.du.size
    P.at[COUNT], P.at[STATUS], P.clock[FACTORED] = 0, 0, -1.0
    while P.at[KNOT] < Q.time.size:
        j = P.at[KNOT]
        if j > 0 and Q.time[j] > Q.time[j - 1]:
            if P.at[COUNT] == X.h.size:
                P.at[STATUS] = FULL
                return
            if not _step(Q, C, K0, T, L, X, P.at[COUNT], P, a, q):
                return
            P.at[COUNT] += 1
            if P.at[SAMPLE] < Q.first[j + 1]:
                _within(Q, R, X, P.at[COUNT] - 1, P, a, q, z, y)
            if P.clock[SHARE] < 1.0:
                continue
        else:
            P.at[FRESH] = 0
        for b in range(nb):
            a.z[0, n + b] = Q.u[j, b]
            P.clock[LOW] = min(P.clock[LOW], Q.u[j, b])
        P.clock[SHARE] = 0.0
        P.at[KNOT] += 1
        while P.at[SAMPLE] < Q.first[j + 1]:
            _sampled(R, P.at[SAMPLE], a.z[0], z, y)
            P.at[SAMPLE] += 1
