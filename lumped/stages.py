"""Both stages of a step: their arrays, their directions, and what a term takes out of the states in them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.jit import inner, pasted
from lumped.terms import Floats, Ints, Terms, directional, flow, patterns

GAMMA = 1.0 - 1.0 / np.sqrt(2.0)


class Stages(NamedTuple):
    """Both stages of a step (first axis: 0 at its start, 1 at its end) in full.

    z (2, nz) z+, v (2, nv + 2 ne) rows of all terms and temperatures of their laws, tau (2, ne, 6) temperature laws,
    w, vw the direction along which it linearises and what that makes of v: on the states their rates
    """

    z: Floats
    v: Floats
    tau: Floats
    w: Floats
    vw: Floats


class Work(NamedTuple):
    """Scratch: df (ne,) factor slopes, F and F_t (n,), matrices W, G, H (n, n), tangents D (n, p), their rates R
    (2, n, p), pivots."""

    df: Floats
    F: Floats
    Ft: Floats
    W: Floats
    G: Floats
    H: Floats
    D: Floats
    R: Floats
    pivot: Ints


def stages(x0: Floats, u0: Floats, T: Terms) -> Stages:
    """The arrays of both stages, with the first states and boundary temperatures in place."""
    ne = T.m.size
    nv = T.row.size + 2 * ne
    tau, z = np.zeros((2, ne, 6)), np.tile(np.concatenate([x0, u0, [1.0]]), (2, 1))
    nz = z.shape[1]
    tau[..., 0] = 1.0
    return Stages(z, np.zeros((2, nv)), tau, np.zeros((2, nz)), np.zeros((2, nv)))


def work(n: int, ne: int, p: int) -> Work:
    """Scratch for n states, ne terms and p tangents."""
    W, G, H = np.zeros((3, n, n))
    F, Ft = np.zeros(n), np.zeros(n)
    return Work(np.zeros(ne), F, Ft, W, G, H, np.zeros((n, p)), np.zeros((2, n, p)), np.zeros(n, np.int64))


@pasted
def length(time, t, last):
    """The step (s) that ends at index t, 0 at the first; one that differs from the last by rounding is the last."""
    h = time[t] - time[max(t - 1, 0)]
    return last if abs(h - last) <= 1e-12 * h else h


@pasted
def begin(T, u, t, h, w, df):
    """Over the step that ends at index t: slopes of factors (df) and of boundaries (w), backwards in stage 1."""
    n = w[0].size - u[0].size - 1
    for e in range(T.m.size):
        df[e] = (T.factor[t, e] - T.factor[t - 1, e]) / h
    for i in range(n):
        w[0, i] = 0.0
    for b in range(u[0].size):
        w[0, n + b] = (u[t, b] - u[t - 1, b]) / h
        w[1, n + b] = -w[0, n + b]


@pasted
def restored(T, K0, z, k, t, h, a, F):
    """Both stages of the step to index t of a run, from its states z and rates k: z+, v, laws, rates; F is scratch."""
    n = k[0, 0].size
    for i in range(n):
        a.w[0, i], a.w[1, i] = k[t, 0, i], k[t, 1, i]
        a.z[0, i], a.z[1, i] = z[t - 1, i], z[t - 1, i] + h * k[t, 0, i]
    for i in range(n, z[0].size):
        a.z[0, i], a.z[1, i] = z[t - 1, i], z[t, i]
    for stage in range(2):
        flow(T, K0, a.z[stage], T.factor[t - 1 + stage], a.tau[stage], a.v[stage], F)


@pasted
def directions(T, a):
    """What the directions make of v."""
    for stage in range(2):
        patterns(T, a.w[stage], a.vw[stage])


@inner
def taken(T, e, s, stage, t, df, a, gh):
    """What a stage of the step to index t takes out of row s by term e, without m; it linearises at the start."""
    f = T.factor[t - 1, e]
    turn = directional(e, f, df * (1.0 - 2.0 * stage), a.tau[0], a.vw[stage], T.row.size)
    now = T.factor[t - 1 + stage, e] * a.tau[stage, e, 0] * a.v[stage, s]
    return now + gh * (f * a.tau[0, e, 0] * a.vw[stage, s] + turn * a.v[0, s])


@inner
def finite(x):
    total = 0.0
    for i in range(x.size):
        total += 0.0 * x[i]
    return total == 0.0
