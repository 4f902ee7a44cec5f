"""The stages of a step: their arrays, what drives them, and what a term takes out of the states in them.

The scheme is a Rosenbrock method of order three with three stages, L-stable and stiffly accurate, whose second and
third stage share one evaluation of the right-hand side (order conditions: Hairer and Wanner 1996, sec. IV.7):

    alpha = (0, 1, 1),  b = (2/3, 1/3 - g, g) = the last row of A + Gamma,  g^3 - 3 g^2 + 3/2 g - 1/6 = 0
    W U_i + g h D_i = g h F(t_i, Y_i) + g sum_j c_ij C U_j,   W = C + g h G,   G = -dF/dx at the start
    Y_1 = x0,  Y_2 = Y_3 = x0 + U_1 / g,  x1 = Y_2 + U_3

D_i: what F loses along time at the start, gamma_i h. It gives a source whose input factor is a parabola exactly, and
states without capacity are met at the end of the step. Where it fails, implicit Euler with the coefficients of the
start (matrix K instead of G: an M-matrix) takes its place: U = (C + h K)^-1 h F(t1, x0), x1 = x0 + U.
"""

from typing import NamedTuple

import numpy as np

from lumped.numerics.dense import GROUP, Factored, dense, factored
from lumped.numerics.jit import inner, pasted
from lumped.numerics.terms import PLACE, Array, Ints, Terms, directional, flow, patterns

GAMMA = 0.43586652150845899941601945119356
_B2 = 1.0 / 3.0 - GAMMA
_BETA2 = (0.5 - 2.0 * GAMMA + GAMMA**2) / _B2
_WEIGHTS = np.array([[GAMMA, 0.0, 0.0], [_BETA2 - 1.0, GAMMA, 0.0], [-1.0 / 3.0, _B2, GAMMA]])
_INVERSE = np.linalg.inv(_WEIGHTS)
C21, C31, C32 = (float(x) for x in (-_INVERSE[1, 0], -_INVERSE[2, 0], -_INVERSE[2, 1]))
SLOPE2 = GAMMA + _BETA2 - 1.0  # gamma_i: GAMMA, SLOPE2, 0
# x'(t1) h from the rates of the stages: second order, and nothing of a component that is at rest at the end
_BETA = np.array([[GAMMA, 0.0, 0.0], [_BETA2, GAMMA, 0.0], [2.0 / 3.0, _B2, GAMMA]])
_CONDITIONS = np.stack([np.ones(3), _BETA.sum(axis=1), np.linalg.solve(_BETA, np.ones(3))])
_RATES = np.linalg.solve(_CONDITIONS, np.array([1.0, 1.0, 0.0])) @ _INVERSE
END1, END2, END3 = (float(x) for x in _RATES)
# at a share s of a step: x0 + sum_i (INSIDE[i, 0] s + INSIDE[i, 1] s^2) U_i, of second order; a state that follows at
# once is on the parabola of its balance (U_2 + U_3 is what that bends over the step)
_THROUGH = np.linalg.inv(np.stack([_WEIGHTS @ np.ones(3), _WEIGHTS @ _BETA.sum(axis=1), [0.0, 1.0, 1.0]]))
INSIDE = np.stack([_THROUGH[:, 0], 0.5 * _THROUGH[:, 1] + _THROUGH[:, 2]], axis=1)
ROSENBROCK, EULER = 0, 1
ABREAST = 8  # columns of tangents are filled up to whole vectors of a processor: what is left over is done one by one


class Stages(NamedTuple):
    """First axis of z, v, tau: 0 the start of a step, 1 its inner stages, 2 its end; of w, vw: the three stages.

    z (3, nz) z+, v (3, nv) rows of all patterns and temperatures that laws see, tau (3, ne, 9) temperature laws
    w (3, nz) increments U of the states, and of the boundaries what D moves them by;  vw what that makes of v
    """

    z: Array
    v: Array
    tau: Array
    w: Array
    vw: Array


class Work(NamedTuple):
    """Scratch.  f (2, nf) input factors at start and end of the step, df (nf,), du (nb,) slopes of both

    F (3, n) right-hand side as z;  G, H (n, n + nb) by states and boundaries;  L : an LU for rest
    error (n,) of the step
    heat (2, n) least and most of all sources
    D (n + nb, p) tangents of states and boundaries, R (4, n, p) of the stages and one more, its n filled up to GROUP
    V (nv, p) what patterns and laws see of them
    """

    f: Array
    df: Array
    du: Array
    F: Array
    G: Array
    H: Array
    L: Factored
    error: Array
    heat: Array
    D: Array
    R: Array
    V: Array


class Steps(NamedTuple):
    """The steps of a run: each ends at a share of the interval before a knot;  kind : ROSENBROCK or EULER."""

    knot: Ints
    share: Array
    kind: Ints


def stages(x0: Array, u0: Array, T: Terms) -> Stages:
    """The arrays of the stages, with the first states and boundary temperatures in place."""
    ne = T.m.size
    nv = T.begin.size - 1
    tau, z = np.zeros((3, ne, 9)), np.tile(np.concatenate([x0, u0, [1.0]]), (3, 1))
    nz = z.shape[1]
    tau[..., 0] = 1.0
    return Stages(z, np.zeros((3, nv)), tau, np.zeros((3, nz)), np.zeros((3, nv)))


def work(n: int, nb: int, T: Terms, p: int) -> Work:
    """Scratch for n states, nb boundaries, some terms and p tangents."""
    nf = max(T.m.size, int(T.part[:, PLACE].max(initial=0)) + 1)
    G, H = np.zeros((2, n, n + nb))
    p += -p % ABREAST
    return Work(
        np.zeros((2, nf)),
        np.zeros(nf),
        np.zeros(nb),
        np.zeros((3, n)),
        G,
        H,
        factored(1, dense(n)),
        np.zeros(n),
        np.zeros((2, n)),
        np.zeros((n + nb, p)),
        np.zeros((4, n + -n % GROUP, p)),
        np.zeros((T.begin.size - 1, p)),
    )


@pasted
def _parabola(f0, f1, bulge, s):
    f = f0 + s * (f1 - f0) + 4.0 * s * (1.0 - s) * bulge
    return max(f, 0.0) if f0 >= 0.0 and f1 >= 0.0 else f


@inner
def boundary(P, j, s, b):
    """A boundary (degC) at a share of the interval before knot j."""
    if s == 1.0:
        return P.u[j, b]
    return P.u[j - 1, b] + s * (P.u[j, b] - P.u[j - 1, b]) + 4.0 * s * (1.0 - s) * P.arch[j, b]


@inner
def inside(kind, s, stage):
    """What of a stage's increment a step has made at its share s, less what it makes in all."""
    if kind == EULER:
        return s - 1.0 if stage == 0 else 0.0
    return (s - 1.0) * (INSIDE[stage, 0] + (s + 1.0) * INSIDE[stage, 1])


@inner
def forced(P, j, s0, s1, a, q):
    """Factors, their slopes and boundaries (into slots 1 and 2) over a step, from share s0 to s1 of the interval before
    knot j."""
    n, span = q.F[0].size, P.time[j] - P.time[j - 1]
    for e in range(q.df.size):
        f0, f1, bulge = P.factor[j - 1, e], P.factor[j, e], P.bulge[j, e]
        q.f[0, e], q.f[1, e] = _parabola(f0, f1, bulge, s0), _parabola(f0, f1, bulge, s1)
        q.df[e] = (f1 - f0 + 4.0 * (1.0 - 2.0 * s0) * bulge) / span
    for b in range(q.du.size):
        q.du[b] = (P.u[j, b] - P.u[j - 1, b] + 4.0 * (1.0 - 2.0 * s0) * P.arch[j, b]) / span
        a.z[1, n + b] = a.z[2, n + b] = boundary(P, j, s1, b)


@pasted
def slope_of(stage):
    return GAMMA if stage == 0 else (SLOPE2 if stage == 1 else 0.0)


@pasted
def restored(T, K0, x0, U, h, a, q):
    """Both evaluations of a Rosenbrock step and the directions of its stages, from its first states and increments."""
    n = U[0].size
    for i in range(n):
        a.z[0, i], a.z[1, i] = x0[i], x0[i] + U[0, i] / GAMMA
        for stage in range(3):
            a.w[stage, i] = U[stage, i]
    for stage in range(3):
        for b in range(q.du.size):
            a.w[stage, n + b] = slope_of(stage) * h * q.du[b]
        patterns(T, a.w[stage], a.vw[stage])
    flow(T, K0, a.z[0], q.f[0], a.tau[0], a.v[0], q.F[0])
    flow(T, K0, a.z[1], q.f[1], a.tau[1], a.v[1], q.F[1])


@inner
def stage_outflow(T, e, s, stage, a, q, h):
    """What a stage takes out of row s by term e, times the step and without m; it linearises at the start."""
    at = min(stage, 1)
    turn = directional(T, e, q.f[0], q.df, slope_of(stage) * h, a.tau[0], a.vw[stage])
    now = q.f[at, e] * a.tau[at, e, 0] * a.v[at, s]
    return GAMMA * h * (now + q.f[0, e] * a.tau[0, e, 0] * a.vw[stage, s] + turn * a.v[0, s])


@inner
def finite(x):
    total = 0.0
    for i in range(x.size):
        total += 0.0 * x[i]
    return total == 0.0
