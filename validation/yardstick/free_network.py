"""A network that is free but for the second law: heat flows down gradients, losses heat, nothing else is known.

For each sensor n, over windows of h seconds,

    T_n(t + h) - T_n(t) = sum_j sum_g a_njg int (T_j - T_n) x_g dt + sum_k b_nk int y_k dt,    all a, b >= 0,

j every other sensor and boundary, x_g shapes of the inputs that a link may follow, y_k products of them that may be
losses. One non-negative least squares per sensor, so there is one optimum and no start to choose.
Source: the integral form of sparse identification (Schaeffer and McCalla 2017), with a library of physics only.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from geom.arrays import Array, Mask
from validation.yardstick.records import Columns, Folds, Record

Shape = tuple[float, float]  # exponent, and the share of the largest size from which on it acts


class Factor(NamedTuple):
    """((|u| - begin) / (1 - begin)) ** exponent of an input u over its largest size; 0 below `begin`."""

    input: str
    exponent: float = 1.0
    begin: float = 0.0


Powers = tuple[Factor, ...]
RIDGE = 1e-12  # on normal equations of unit columns: two inputs that are one another's copy share their work
SMALL = 1e-10  # of the largest: rounding of sums over thousands of rows


@dataclass(frozen=True)
class Form:
    """Which terms a free network may use.  window : s;  shapes : of each input that a link may follow, beside 1"""

    window: float
    shapes: tuple[Shape, ...]


def link_factors(u: Array, shapes: Sequence[Shape]) -> Array:
    """(n, n_factor): 1 and the shapes of every input's size."""
    size = np.abs(u)
    return np.column_stack([np.ones(len(u)), *(np.maximum((size - b) / (1.0 - b), 0.0) ** p for p, b in shapes)])


def loss_factors(u: Array) -> Array:
    """(n, n_loss): 1, the size and square of every input, and of every pair the four products of these."""
    size = np.abs(u)
    single = [size, size**2]
    both = combinations(range(u.shape[1]), 2)
    pairs = [size[:, [i]] ** p * size[:, [j]] ** q for i, j in both for p in (1, 2) for q in (1, 2)]
    return np.column_stack([np.ones(len(u)), *single, *pairs])


def link_powers(inputs: Sequence[str], shapes: Sequence[Shape]) -> list[Powers]:
    """What stands in the columns of `link_factors`."""
    return [(), *((Factor(i, *shape),) for shape in shapes for i in inputs)]


def loss_powers(inputs: Sequence[str]) -> list[Powers]:
    """What stands in the columns of `loss_factors`."""
    powers = (1.0, 2.0)
    single: list[Powers] = [(Factor(i, p),) for p in powers for i in inputs]
    pairs = [(Factor(a, p), Factor(b, q)) for a, b in combinations(inputs, 2) for p in powers for q in powers]
    return [(), *single, *pairs]


def power_words(powers: Powers) -> str:
    """ "id_A^2 speed_rpm", "speed_rpm>0.5" from half of its largest on, "" where nothing is followed."""
    return " ".join(
        f"{f.input}{f'>{f.begin:g}' if f.begin else ''}{f'^{f.exponent:g}' if f.exponent != 1.0 else ''}"
        for f in powers
    )


def integral(time: Array, y: Array) -> Array:
    """The running integral of each column by trapezoids, 0 at the first row."""
    steps = np.diff(time)[:, None] * 0.5 * (y[1:] + y[:-1])
    return np.vstack([np.zeros(y.shape[1]), np.cumsum(steps, axis=0)])


def windows(record: Record, columns: Columns, form: Form) -> Iterator[Array]:
    """Sensor by sensor (n_row, n_term + 1): the integrals of all its terms over each window, and its rise, last."""
    x, heat = link_factors(record.u, form.shapes), integral(record.time, loss_factors(record.u))
    others = np.column_stack([record.T[:, columns.steady], record.boundary])
    h = record.rows(form.window)
    begin = np.arange(0, len(x) - h, max(h // 4, 1))
    for T, read in zip(record.T.T, record.read.T, strict=True):
        flow = (others - T[:, None])[:, :, None] * x[:, None, :]
        whole = np.column_stack([integral(record.time, flow.reshape(len(x), -1)), heat, T])
        some = begin[read[begin] & read[begin + h]]
        yield whole[some + h] - whole[some]


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
        x, y = link_factors(record.u, self.form.shapes), loss_factors(record.u)
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
    """What each fold of records teaches under a form.  Any choice of folds is one fit.

    normal : per fold and sensor (n_term + 1, n_term + 1), its windows' products, see `windows`
    """

    form: Form
    columns: Columns
    normal: Sequence[Sequence[Array]]

    @staticmethod
    def of(folds: Folds, columns: Columns, form: Form) -> "NetworkLessons":
        def taught(fold: Sequence[Record]) -> list[Array]:
            each = zip(*(windows(record, columns, form) for record in fold), strict=True)
            return [sum((A.T @ A for A in tables), np.zeros(())) for tables in each]

        return NetworkLessons(form, columns, [taught(fold) for fold in folds])

    def fit(self, lessons: Sequence[int]) -> FreeNetwork:
        """The network learnt from some folds."""
        k, steady = len(self.columns.sensors), np.flatnonzero(self.columns.steady)
        bodies = steady.size + len(self.columns.boundaries)
        factors = 1 + len(self.form.shapes) * len(self.columns.inputs)
        where = np.append(steady, k + np.arange(len(self.columns.boundaries)))
        links, sources = np.zeros((k, k + len(self.columns.boundaries), factors)), []
        for n in range(k):
            N = np.sum([self.normal[i][n] for i in lessons], axis=0)
            a = nonnegative(N[:-1, :-1], N[:-1, -1])
            links[n, where] = a[: bodies * factors].reshape(bodies, factors)
            links[n, n] = 0.0
            sources.append(a[bodies * factors :])
        return FreeNetwork(self.form, links, np.array(sources))


def nonnegative(AA: Array, Ab: Array, near: Array | None = None) -> Array:
    """The least squares of A x = b with x >= 0, from A'A and A'b; a column of zeros gets 0.

    near : the answer to a similar question, where it is known: its positive terms are tried first

    Active sets on the normal equations of columns of length one (Bro and de Jong 1997). SciPy's solver of the same
    problem ends the process on some of these tables (1.17), so it is not used.
    """
    scale = np.sqrt(np.diag(AA))
    alive = scale > 1e-12 * max(float(scale.max(initial=0.0)), 1e-300)
    x, size = np.zeros(len(scale)), scale[alive]
    unit = AA[np.ix_(alive, alive)] / np.outer(size, size)
    begin = np.zeros(size.size, bool) if near is None else near[alive] > 0.0
    x[alive] = _active_set(unit + RIDGE * np.eye(size.size), Ab[alive] / size, begin) / size
    return x


def _active_set(G: Array, h: Array, begin: Mask) -> Array:
    """min x' G x / 2 - h' x over x >= 0: one term more at a time, and out with those that would fall below zero.

    begin : terms that are free from the start; those of them that would be below zero leave at once
    """
    x, free, least = np.zeros(h.size), begin.copy(), SMALL * float(np.abs(h).max(initial=0.0))
    while free.any():
        trial = np.linalg.solve(G[np.ix_(free, free)], h[free])
        if trial.min() > 0.0:
            x[free] = trial
            break
        free[np.flatnonzero(free)[trial <= 0.0]] = False
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
