"""Terms of a network as the compiled kernel follows them, and their temperature laws.

Every link and source is a *term*: it takes m c(t, T) P z+ out of the states, z+ = [x; u; 1]; a source has its
pattern in the last column, with minus signs.
"""

import math
from typing import NamedTuple

from geom.arrays import Array, Ints
from geom.constants import SIGMA, ZERO_C
from lumped.numerics.dense import axpy, matvec
from lumped.numerics.jit import inner, inner_reordered, pasted
from lumped.transfer.laws import FILMS, FIRST_C, FULL_UNITS, LEAST, STEP_K

SMOOTH = 0.01  # K: |dT| ** p is smoothed below this difference, where its derivative would be unbounded
CONSTANT, POWER, RADIATION, LINEAR, TABLE, FILM, INVERSE, STREAM = range(8)
PATTERN, ROW, END, HOT, COLD, POINT, LAST, PLACE = range(8)
CODE, DYNAMIC, STIFF, BENDS, SOURCE = range(5)


class Terms(NamedTuple):
    """The terms the kernel follows one by one, as flat arrays. Films of one face share a pattern, whatever their laws.

    begin (nv + 1,), at, weight : v = [P z+ of all patterns; temperatures that laws see], row by row over z+
    row : the state each row of a pattern takes from
    part (ne, 8) : PATTERN of each term, whose rows are ROW up to END of v; rows HOT and COLD that its law sees;
        POINT up to LAST of its table; PLACE among the input factors of the |input| that its law sees, or 0
    order (ne,) : the terms, those of one pattern in a row
    kind (ne, 5) : CODE of the temperature law; DYNAMIC: assembled every step, else it stands in the constant matrix;
        STIFF: touches the matrix; BENDS: its law depends on temperature; SOURCE: puts heat in
    par (ne, 2), point (np, 2) : of the temperature law: its numbers, its table (x, y)
    m : multipliers
    """

    begin: Ints
    at: Ints
    weight: Array
    row: Ints
    part: Ints
    order: Ints
    kind: Ints
    par: Array
    point: Array
    m: Array


class Forcing(NamedTuple):
    """What drives a network from knot to knot: between two of them input factors and boundaries are parabolas.

    time (nk,) s; u (nk, nb) boundaries; factor (nk, nf) of terms, without multipliers, then what laws see of inputs
    bulge (nk, nf), arch (nk, nb) : how far the factor, the boundary is above the mean of both ends in the middle of the
        interval that ends there
    renew (nk,) : the matrix over that interval is as before (0), other than before (1), varies within it (2)
    first (nk + 1,) : samples first[j] to first[j + 1] lie after knot j - 1 and up to knot j
    share (nt,) : at which share of that interval, 1 at the knot
    """

    time: Array
    u: Array
    factor: Array
    bulge: Array
    arch: Array
    renew: Ints
    first: Ints
    share: Array


@pasted
def _segment(points, start, end, at):
    """Index k of the piece of a table that holds `at`: x[k] <= at < x[k + 1]."""
    while end - start > 1:
        middle = (start + end) // 2
        if points[middle, 0] <= at:
            start = middle
        else:
            end = middle
    return start


@pasted
def _tabulated(points, first, last, d, out):
    """Piecewise linear in |d| between two indices, flat outside; in d itself where the table begins below 0."""
    signed = points[first, 0] < 0.0
    at = d if signed else abs(d)
    out[1] = 0.0
    if at >= points[last, 0]:
        out[0] = points[last, 1]
    elif at <= points[first, 0]:
        out[0] = points[first, 1]
    else:
        k = _segment(points, first, last, at)
        slope = (points[k + 1, 1] - points[k, 1]) / (points[k + 1, 0] - points[k, 0])
        out[0] = points[k, 1] + slope * (at - points[k, 0])
        out[1] = slope if signed or d >= 0.0 else -slope
    out[2] = -out[1]


@pasted
def _filmed(points, first, nd, hot, cold, out):
    """Bilinear in |hot - cold| and the film temperature; nd differences at each of the film temperatures."""
    side, at = (1.0 if hot >= cold else -1.0), 0.5 * (hot + cold)
    d = min(abs(hot - cold), points[first + nd - 1, 0])
    place = min(max((at - FIRST_C) / STEP_K, 0.0), FILMS - 1.0)
    j = min(int(place), FILMS - 2)
    k = _segment(points, first, first + nd - 1, d)
    low, high = k + j * nd, k + (j + 1) * nd
    wide = points[k + 1, 0] - points[k, 0]
    cool = (points[low + 1, 1] - points[low, 1]) / wide
    warm = (points[high + 1, 1] - points[high, 1]) / wide
    one = points[low, 1] + cool * (d - points[k, 0])
    two = points[high, 1] + warm * (d - points[k, 0])
    share = place - j
    by_film = (two - one) / STEP_K if 0.0 < place < FILMS - 1.0 else 0.0
    by_d, both = cool + share * (warm - cool), (warm - cool) / STEP_K
    if abs(hot - cold) >= points[first + nd - 1, 0]:
        by_d, both = 0.0, 0.0
    out[0] = one + share * (two - one)
    out[1] = side * by_d + 0.5 * by_film
    out[2] = -side * by_d + 0.5 * by_film
    out[3] = side * both
    out[5] = -out[3]


@inner
def streamed(T, e, size, hot, cold, out):
    """The StreamTable of term e: shifts over its totals, then its numbers, then its values, one total after the other.

    par : how many totals; the stretch, or less than 0 how many differences the film of still air has that comes next;
    last is then the exponent of their mixture
    """
    points, first, nt, stretch = T.point, T.part[e, POINT], int(T.par[e, 0]), T.par[e, 1]
    total, nd = hot + cold, int(max(-stretch, 0.0))
    last = T.part[e, LAST] - (1 if nd > 0 else 0)
    nn = (last - first - nt - FILMS * nd) // (1 + nt)
    u, at = max(size, LEAST), min(max(total, points[first, 0]), points[first + nt - 1, 0])
    i = _segment(points, first, first + nt - 1, at)
    wide, begin = points[i + 1, 0] - points[i, 0], first + nt
    share, drift = (at - points[i, 0]) / wide, (points[i + 1, 1] - points[i, 1]) / wide
    y = math.log(u) - points[i, 1] - drift * (at - points[i, 0])
    j = _segment(points, begin, begin + nn - 1, y)
    high = points[j + 1, 0] - points[j, 0]
    up, low = max(y, points[begin, 0]) - points[j, 0], begin + nn + (i - first) * nn + j - begin
    cool = (points[low + 1, 1] - points[low, 1]) / high
    warm = (points[low + nn + 1, 1] - points[low + nn, 1]) / high
    one, two = points[low, 1] + cool * up, points[low + nn, 1] + warm * up
    inside, moves = 1.0 if total == at else 0.0, 1.0 if size > LEAST else 0.0
    rising = moves if y > points[begin, 0] else 0.0
    h, by_y, both = one + share * (two - one), rising * (cool + share * (warm - cool)), rising * (warm - cool) / wide
    by_T, by_u = inside * ((two - one) / wide - drift * by_y), by_y / u
    twice, cross = -2.0 * inside * drift * both, inside * both / u
    if nd > 0:
        _excess(points, last - FILMS * nd, nd, points[last, 0], hot, cold, h, by_T, by_u, twice, cross, out)
        return
    if stretch > 0.0:
        N = h * stretch / u
        if N <= FULL_UNITS:
            g, bend = math.exp(N), math.exp(N) * stretch / u
            twice, cross = g * twice + bend * by_T * by_T, g * cross + bend * by_T * (by_u - moves * h / u)
            by_u = g * by_u + moves * (math.expm1(N) - N * g) / stretch
            by_T *= g
            h = math.expm1(N) * u / stretch
        elif math.expm1(FULL_UNITS) > N:
            h = math.expm1(FULL_UNITS) * u / stretch
            by_T, twice, cross, by_u = 0.0, 0.0, 0.0, moves * math.expm1(FULL_UNITS) / stretch
    out[0], out[1], out[2], out[3], out[4], out[5] = h, by_T, by_T, twice, twice, twice
    out[6], out[7], out[8] = by_u, cross, cross


@pasted
def _excess(points, first, nd, n, hot, cold, h, by_T, by_u, twice, cross, out):
    """What blown air adds to a film of still air, from the film h of blown air alone and its derivatives.

    With m = (h^n + s^n)^(1/n), p = h / m and q = s / m the derivatives of m are p^(n-1) and q^(n-1), the second ones
    (n-1) (p q)^(n-2) / m times q^2, -p q and p^2.
    """
    for k in range(6):
        out[k] = 0.0
    _filmed(points, first, nd, hot, cold, out)
    s, s_hot, s_cold = out[0], out[1], out[2]
    m = (h**n + s**n) ** (1.0 / n)
    if m == 0.0:
        out[6] = out[7] = out[8] = 0.0
        return
    p, q = h / m, s / m
    by_h, by_s = p ** (n - 1.0), q ** (n - 1.0) - 1.0
    bend = (n - 1.0) * (p * q) ** (n - 2.0) / m
    hh, hs, ss = bend * q * q, -bend * p * q, bend * p * p
    out[0] = m - s
    out[3] = by_s * out[3] + by_h * twice + hh * by_T * by_T + 2.0 * hs * by_T * s_hot + ss * s_hot * s_hot
    out[4] = by_s * out[4] + by_h * twice + hh * by_T * by_T + hs * by_T * (s_hot + s_cold) + ss * s_hot * s_cold
    out[5] = by_s * out[5] + by_h * twice + hh * by_T * by_T + 2.0 * hs * by_T * s_cold + ss * s_cold * s_cold
    out[1], out[2] = by_h * by_T + by_s * s_hot, by_h * by_T + by_s * s_cold
    out[6] = by_h * by_u
    out[7] = by_h * cross + by_u * (hh * by_T + hs * s_hot)
    out[8] = by_h * cross + by_u * (hh * by_T + hs * s_cold)


@pasted
def law(code, a, b, hot, cold, out):
    """Temperature law: value, its derivatives by hot and cold, and the second ones hh, hc, cc, into out."""
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
    elif code == INVERSE:
        out[0] = 1.0 / (1.0 + a * (hot - b))
        out[1] = -a * out[0] * out[0]
        out[3] = -2.0 * a * out[0] * out[1]


@inner
def clear(A):
    for i in range(len(A)):
        for j in range(A[0].size):
            A[i, j] = 0.0


@inner_reordered
def patterns(T, z, out):
    """Rows of all patterns at z+, and the temperatures that laws see."""
    for s in range(out.size):
        acc = 0.0
        for i in range(T.begin[s], T.begin[s + 1]):
            acc += T.weight[i] * z[T.at[i]]
        out[s] = acc


@pasted
def _evaluate(T, f, v, tau):
    """Temperature laws of all terms: tau (ne, 9) = value, d/dhot, d/dcold, hh, hc, cc, d/dinput, uh, uc."""
    for e in range(T.m.size):
        if T.kind[e, BENDS]:
            hot, cold = v[T.part[e, HOT]], v[T.part[e, COLD]]
            if T.kind[e, CODE] == TABLE:
                _tabulated(T.point, T.part[e, POINT], T.part[e, LAST] - 1, hot - cold, tau[e])
            elif T.kind[e, CODE] == FILM:
                _filmed(T.point, T.part[e, POINT], int(T.par[e, 0]), hot, cold, tau[e])
            elif T.kind[e, CODE] == STREAM:
                streamed(T, e, f[T.part[e, PLACE]], hot, cold, tau[e])
            else:
                law(T.kind[e, CODE], T.par[e, 0], T.par[e, 1], hot, cold, tau[e])


@inner
def flow(T, K0, z, f, tau, v, out):
    """out = F = -K0 z - sum of the dynamic terms at z, whose tau and v = P z are left; f (nf,) input factors."""
    patterns(T, z, v)
    _evaluate(T, f, v, tau)
    matvec(K0, z, out)
    for e in range(T.m.size):
        if T.kind[e, DYNAMIC] and T.m[e] != 0.0:
            c = T.m[e] * f[e] * tau[e, 0]
            for s in range(T.part[e, ROW], T.part[e, END]):
                out[T.row[s]] -= c * v[s]


@inner
def spread(T, e, v, by_hot, by_cold, A):
    """A += v (by_hot hot + by_cold cold)' on the columns that A has, for term e."""
    for side in range(2):
        node, by = T.part[e, COLD if side else HOT], by_cold if side else by_hot
        for i in range(T.begin[node], T.begin[node + 1]):
            if T.at[i] < A[0].size:
                for s in range(T.part[e, ROW], T.part[e, END]):
                    A[T.row[s], T.at[i]] += v[s] * (by * T.weight[i])


@inner
def _placed(T, e, c, A):
    """A += c P on the columns that A has, for the pattern of term e."""
    for s in range(T.part[e, ROW], T.part[e, END]):
        for i in range(T.begin[s], T.begin[s + 1]):
            if T.at[i] < A[0].size:
                A[T.row[s], T.at[i]] += c * T.weight[i]


@pasted
def _ends(T, k):
    """Whether term order[k] is the last of its pattern."""
    return k + 1 == T.order.size or T.part[T.order[k + 1], PATTERN] != T.part[T.order[k], PATTERN]


@inner
def jacobian(T, K0, f, tau, v, G):
    """G = -dF/dx (n, n), or by boundaries too (n, n + nb)."""
    for i in range(len(G)):
        for j in range(G[0].size):
            G[i, j] = K0[i, j]
    c = 0.0
    for k in range(T.order.size):
        e = T.order[k]
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.m[e] != 0.0:
            mf = T.m[e] * f[e]
            c += mf * tau[e, 0]
            if T.kind[e, BENDS]:
                spread(T, e, v, mf * tau[e, 1], mf * tau[e, 2], G)
        if _ends(T, k):
            if c != 0.0:
                _placed(T, e, c, G)
            c = 0.0


@inner
def conductances(T, K0, f, tau, K):
    """K (n, n): every term at its coefficient, without how that turns with temperature."""
    for i in range(len(K)):
        for j in range(len(K)):
            K[i, j] = K0[i, j]
    for e in range(T.m.size):
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.m[e] != 0.0:
            _placed(T, e, T.m[e] * f[e] * tau[e, 0], K)


@inner
def directional(T, e, f, df, late, tau, v_dot):
    """d/ds of the coefficient c (without m) of term e along v_dot, and over `late` s with df (nf,) = df/dt."""
    turn = tau[e, 1] * v_dot[T.part[e, HOT]] + tau[e, 2] * v_dot[T.part[e, COLD]]
    return f[e] * (turn + late * df[T.part[e, PLACE]] * tau[e, 6]) + late * df[e] * tau[e, 0]


@inner_reordered
def _probe(T, s, D, V):
    """Row s of V = what it sees of D; four at a time, so that V is written a quarter as often."""
    out, i, last = V[s], T.begin[s], T.begin[s + 1]
    for j in range(out.size):
        out[j] = 0.0
    while i + 3 < last and max(T.at[i], T.at[i + 1], T.at[i + 2], T.at[i + 3]) < len(D):
        w0, w1, w2, w3 = T.weight[i], T.weight[i + 1], T.weight[i + 2], T.weight[i + 3]
        d0, d1, d2, d3 = D[T.at[i]], D[T.at[i + 1]], D[T.at[i + 2]], D[T.at[i + 3]]
        for j in range(out.size):
            out[j] += w0 * d0[j] + w1 * d1[j] + w2 * d2[j] + w3 * d3[j]
        i += 4
    while i < last:
        if T.at[i] < len(D):
            axpy(T.weight[i], D[T.at[i]], out)
        i += 1


@inner
def pattern_products(T, D, V):
    """V = P D of all acting terms that touch the matrix, and what their laws see: rows of v, a column per tangent."""
    acts, last = False, -1
    for k in range(T.order.size):
        e = T.order[k]
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.m[e] != 0.0:
            acts = True
            same = last >= 0 and T.part[e, HOT] == T.part[last, HOT] and T.part[e, COLD] == T.part[last, COLD]
            if T.kind[e, BENDS] and not same:
                _probe(T, T.part[e, HOT], D, V)
                _probe(T, T.part[e, COLD], D, V)
                last = e
        if _ends(T, k):
            for s in range(T.part[e, ROW], T.part[e, END] if acts else T.part[e, ROW]):
                _probe(T, s, D, V)
            acts = False


@inner
def conductance_difference(T, f, tau, v, scale, V, out):
    """out -= scale times how G differs between slots 1 and 0, times D.  V : of `pattern_products`"""
    other = 0.0
    for k in range(T.order.size):
        e = T.order[k]
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.m[e] != 0.0:
            m, a, b = scale * T.m[e], f[0, e], f[1, e]
            other += m * (b * tau[1, e, 0] - a * tau[0, e, 0])
            for s in range(T.part[e, ROW], T.part[e, END] if T.kind[e, BENDS] else T.part[e, ROW]):
                axpy(-m * (b * tau[1, e, 1] * v[1, s] - a * tau[0, e, 1] * v[0, s]), V[T.part[e, HOT]], out[T.row[s]])
                axpy(-m * (b * tau[1, e, 2] * v[1, s] - a * tau[0, e, 2] * v[0, s]), V[T.part[e, COLD]], out[T.row[s]])
        if _ends(T, k):
            for s in range(T.part[e, ROW], T.part[e, END]):
                axpy(-other, V[s], out[T.row[s]])
            other = 0.0


@inner
def conductance_derivative(T, f, df, late, tau, v, v_dot, scale, V, out):
    """out (3, n, p) -= scale times how G changes along v_dot (3, nv) and over `late` (3,) seconds, times D.

    df (nf,) slopes of the factors;  V : of `pattern_products`
    """
    t0, t1, t2 = 0.0, 0.0, 0.0
    for k in range(T.order.size):
        e = T.order[k]
        if T.kind[e, DYNAMIC] and T.kind[e, STIFF] and T.m[e] != 0.0:
            m = scale * T.m[e]
            t0 += m * directional(T, e, f, df, late[0], tau, v_dot[0])
            t1 += m * directional(T, e, f, df, late[1], tau, v_dot[1])
            t2 += m * directional(T, e, f, df, late[2], tau, v_dot[2])
            for stage in range(3 if T.kind[e, BENDS] else 0):
                _law_derivative(T, e, m, f[e], df, late[stage], tau, v, v_dot[stage], V, out[stage])
        if _ends(T, k):
            for s in range(T.part[e, ROW], T.part[e, END]):
                if t0 != 0.0 or t1 != 0.0 or t2 != 0.0:
                    _thrice(t0, t1, t2, V[s], out[0, T.row[s]], out[1, T.row[s]], out[2, T.row[s]])
            t0, t1, t2 = 0.0, 0.0, 0.0


@inner
def _law_derivative(T, e, m, f, df, late, tau, v, v_dot, V, out):
    """The part of a law that follows temperature."""
    hot, cold = T.part[e, HOT], T.part[e, COLD]
    slope, step = late * df[e], late * df[T.part[e, PLACE]]
    by_hot = slope * tau[e, 1] + f * (tau[e, 3] * v_dot[hot] + tau[e, 4] * v_dot[cold] + step * tau[e, 7])
    by_cold = slope * tau[e, 2] + f * (tau[e, 4] * v_dot[hot] + tau[e, 5] * v_dot[cold] + step * tau[e, 8])
    for s in range(T.part[e, ROW], T.part[e, END]):
        axpy(-m * (by_hot * v[s] + f * tau[e, 1] * v_dot[s]), V[hot], out[T.row[s]])
        axpy(-m * (by_cold * v[s] + f * tau[e, 2] * v_dot[s]), V[cold], out[T.row[s]])


@inner
def _thrice(a, b, c, x, y0, y1, y2):
    for k in range(x.size):
        y0[k] -= a * x[k]
        y1[k] -= b * x[k]
        y2[k] -= c * x[k]
