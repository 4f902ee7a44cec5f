"""A network that is free but for the second law: heat flows down gradients, losses heat, nothing else is known.

For each sensor n, over windows of h seconds,

    T_n(t + h) - T_n(t) = sum_j sum_g a_njg int (T_j - T_n) x_g dt + sum_k b_nk int y_k dt,    all a, b >= 0,

j every other sensor and boundary, x_g powers of the inputs that a link may follow, y_k products of them that may be
losses. One non-negative least squares per sensor, so there is one optimum and no start to choose.
Source: the integral form of sparse identification (Schaeffer and McCalla 2017), with a library of physics only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from validation.yardstick.records import Columns, Record

Array = NDArray[np.float64]
RIDGE = 1e-12  # on normal equations of unit columns: two inputs that are one another's copy share their work
SMALL = 1e-10  # of the largest: rounding of sums over thousands of rows


@dataclass(frozen=True)
class Form:
    """Which terms a free network may use.  window : s;  powers : of each input that a link may follow, beside 1"""

    window: float
    powers: int


def link_factors(u: Array, powers: int) -> Array:
    """(n, n_factor): 1 and the powers of every input's size."""
    size = np.abs(u)
    return np.column_stack([np.ones(len(u)), *(size**p for p in range(1, powers + 1))])


def loss_factors(u: Array) -> Array:
    """(n, n_loss): 1, the size and square of every input, and of every pair the four products of these."""
    size = np.abs(u)
    single = [size, size**2]
    pairs = [size[:, [i]] ** p * size[:, [j]] ** q
             for i, j in combinations(range(u.shape[1]), 2) for p in (1, 2) for q in (1, 2)]  # fmt: skip
    return np.column_stack([np.ones(len(u)), *single, *pairs])


def loss_names(inputs: Sequence[str]) -> list[str]:
    """What stands in the columns of `loss_factors`."""

    def power(name: str, p: int) -> str:
        return name if p == 1 else f"{name}^{p}"

    pairs = [f"{power(a, p)} {power(b, q)}" for a, b in combinations(inputs, 2) for p in (1, 2) for q in (1, 2)]
    return ["1", *inputs, *(power(i, 2) for i in inputs), *pairs]


def integral(time: Array, y: Array) -> Array:
    """The running integral of each column by trapezoids, 0 at the first row."""
    steps = np.diff(time)[:, None] * 0.5 * (y[1:] + y[:-1])
    return np.vstack([np.zeros(y.shape[1]), np.cumsum(steps, axis=0)])


@dataclass(frozen=True)
class Triangle:
    """The windows of some records for one sensor, turned into a triangle that has the same normal equations."""

    R: Array

    @staticmethod
    def of(A: Array) -> Triangle:
        return Triangle(np.asarray(np.linalg.qr(A, mode="r"), float))


def windows(record: Record, n: int, others: Array, form: Form) -> Array:
    """(n_row, n_term + 1): the integrals of all terms of sensor n over each window, and its rise, last.

    others (n_time, n_other) degC
    """
    x, y = link_factors(record.u, form.powers), loss_factors(record.u)
    flow = (others - record.T[:, [n]])[:, :, None] * x[:, None, :]
    whole = integral(record.time, np.hstack([flow.reshape(len(x), -1), y]))
    h = record.rows(form.window)
    begin = np.arange(0, len(x) - h, max(h // 4, 1))
    begin = begin[record.read[begin, n] & record.read[begin + h, n]]
    return np.column_stack([whole[begin + h] - whole[begin], record.T[begin + h, n] - record.T[begin, n]])


@dataclass(frozen=True)
class FreeNetwork:
    """Learnt coefficients.

    links (n_sensor, n_body, n_factor) 1/s: from each sensor and boundary;  sources (n_sensor, n_loss) K/s
    """

    form: Form
    links: Array
    sources: Array

    def run(self, record: Record) -> Array:
        """(n, n_sensor) degC: from the first reading on, without looking at another."""
        k = self.sources.shape[0]
        x, y = link_factors(record.u, self.form.powers), loss_factors(record.u)
        G = np.einsum("tg,njg->tnj", x, self.links)
        A = G[:, :, :k] - np.eye(k) * G.sum(axis=2)[:, :, None]
        s = y @ self.sources.T + np.einsum("tnj,tj->tn", G[:, :, k:], record.boundary)
        return linear_run(record.time, A, s, record.T[0])


def linear_run(time: Array, A: Array, s: Array, start: Array) -> Array:
    """(n, k): dT/dt = A(t) T + s(t) by an L-stable rule of third order in A (Pade 1, 2), A and s at mid-step."""
    h = np.diff(time)[:, None, None]
    A, s = 0.5 * (A[1:] + A[:-1]), 0.5 * (s[1:] + s[:-1])
    k = A.shape[1]
    hA, one = h * A, np.eye(k)
    left = one - hA * (2.0 / 3.0) + hA @ hA / 6.0
    right = np.concatenate([one + hA / 3.0, (h[:, 0] * s)[:, :, None] - (hA @ (h[:, 0] * s)[:, :, None]) / 6.0], axis=2)
    step = np.linalg.solve(left, right)
    out = np.empty((len(time), k))
    out[0] = start
    for i, (P, q) in enumerate(zip(step[:, :, :k], step[:, :, k], strict=True)):
        out[i + 1] = P @ out[i] + q
    return out


@dataclass(frozen=True)
class NetworkLessons:
    """What each fold of records teaches under a form: per fold and sensor a triangle.  Any choice is one fit."""

    form: Form
    columns: Columns
    parts: Sequence[Sequence[Triangle]]

    @staticmethod
    def of(folds: Sequence[Sequence[Record]], columns: Columns, form: Form) -> NetworkLessons:
        def taught(fold: Sequence[Record], n: int) -> Triangle:
            others = [np.column_stack([r.T[:, columns.steady], r.boundary]) for r in fold]
            return Triangle.of(np.vstack([windows(r, n, o, form) for r, o in zip(fold, others, strict=True)]))

        return NetworkLessons(form, columns, [[taught(f, n) for n in range(len(columns.sensors))] for f in folds])

    def fit(self, lessons: Sequence[int]) -> FreeNetwork:
        """The network learnt from some folds."""
        k, steady = len(self.columns.sensors), np.flatnonzero(self.columns.steady)
        bodies, factors = steady.size + len(self.columns.boundaries), 1 + self.form.powers * len(self.columns.inputs)
        where = np.append(steady, k + np.arange(len(self.columns.boundaries)))
        links, sources = np.zeros((k, k + len(self.columns.boundaries), factors)), []
        for n in range(k):
            R = np.vstack([self.parts[i][n].R for i in lessons])
            a = nonnegative(R[:, :-1], R[:, -1])
            links[n, where] = a[: bodies * factors].reshape(bodies, factors)
            links[n, n] = 0.0
            sources.append(a[bodies * factors :])
        return FreeNetwork(self.form, links, np.array(sources))


def nonnegative(A: Array, b: Array) -> Array:
    """The least squares of A x = b with x >= 0; a column of zeros gets 0.

    Active sets on the normal equations of columns of length one (Bro and de Jong 1997). SciPy's solver of the same
    problem ends the process on some of these tables (1.17), so it is the reference of the test and not used here.
    """
    scale = np.linalg.norm(A, axis=0)
    alive = scale > 1e-12 * max(float(scale.max(initial=0.0)), 1e-300)
    x = np.zeros(A.shape[1])
    unit = A[:, alive] / scale[alive]
    x[alive] = _active_set(unit.T @ unit + RIDGE * np.eye(unit.shape[1]), unit.T @ b) / scale[alive]
    return x


def _active_set(G: Array, h: Array) -> Array:
    """min x' G x / 2 - h' x over x >= 0: one term more at a time, and out with those that would fall below zero."""
    x, free, least = np.zeros(h.size), np.zeros(h.size, bool), SMALL * float(np.abs(h).max(initial=0.0))
    for _ in range(3 * h.size):
        slope = np.where(free, -np.inf, h - G @ x)
        if not h.size or slope.max() <= least:
            break
        free[int(np.argmax(slope))] = True
        while True:
            trial = np.zeros(h.size)
            trial[free] = np.linalg.solve(G[np.ix_(free, free)], h[free])
            low = free & (trial <= 0.0)
            if not low.any():
                break
            x += min(1.0, float(np.min(x[low] / np.maximum(x[low] - trial[low], 1e-300)))) * (trial - x)
            free &= x > SMALL * max(float(x.max()), 1e-300)
            x[~free] = 0.0
        x = trial
    return x
