"""How the residual of a calibrated model is correlated, per sensor, and the whitener that follows from it.

    r = w [ white + OU(tau) + Matern-3/2(ell) ]      each with its own standard deviation

White is reading noise, OU the fast and Matern-3/2 the slow model error; w (K) is the size of error that is usual for
the channel in this test, so that a test with ten times the rise may have ten times the error. The shape is chosen by
maximum likelihood on a grid with log-normal priors around tau = 2 min and ell = 20 min; the scale has a closed form. A
grid instead of an optimiser: the Cholesky factors of all shapes are made once per time grid, so the hundreds of
simulated data sets of the null are whitened in milliseconds each. Whatever the fit says, the slow part is never below
the error that a model of this kind is allowed, the fast part never below a quarter of it: a residual that a calibration
has just made small says nothing about how wrong the model is elsewhere.
Source: Rasmussen and Williams 2006, chapters 4.2 and 5.4; Kennedy and O'Hagan 2001 for the allowance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from validation.sheet import Segment

Array = NDArray[np.float64]
FLOOR_K = 0.03
PRIOR_COUNT = 4.0
FAST = 0.25
TAU, ELL = 120.0, 1200.0


@dataclass(frozen=True)
class Shape:
    """Correlation of a residual, up to its scale: variances a (OU) and b (Matern-3/2) relative to white; times in s."""

    a: float
    tau: float
    b: float
    ell: float

    def log_prior(self) -> float:
        fast = np.log(self.tau / TAU) / 0.8 if self.a else 0.0
        slow = np.log(self.ell / ELL) / 0.8 if self.b else 0.0
        return -0.5 * float(fast**2 + slow**2)

    def matrix(self, time: Array) -> Array:
        key = stamp(time)
        out: Array = self.a * _decay(key, self.tau) + self.b * _matern(key, self.ell)
        out[np.diag_indices(time.size)] += 1.0
        return out


def stamp(time: Array) -> bytes:
    """A time grid as a key."""
    return np.round(time - time[0], 3).tobytes()


def _gaps(time: bytes) -> Array:
    t = np.frombuffer(time)
    return np.asarray(np.abs(t[:, None] - t[None, :]))


@lru_cache(maxsize=64)
def _decay(time: bytes, tau: float) -> Array:
    return np.asarray(np.exp(-_gaps(time) / tau))


@lru_cache(maxsize=64)
def _matern(time: bytes, ell: float) -> Array:
    d = np.sqrt(3.0) * _gaps(time) / ell
    return np.asarray((1.0 + d) * np.exp(-d))


def shapes() -> tuple[Shape, ...]:
    """The grid: white alone, with OU, with Matern, with both."""
    fast = [(0.0, TAU), *product((1.0, 10.0, 100.0), (60.0, 240.0))]
    slow = [(0.0, ELL), *product((1.0, 10.0, 100.0, 1000.0, 10000.0), (600.0, ELL, 2400.0))]
    return tuple(Shape(a, tau, b, ell) for (a, tau), (b, ell) in product(fast, slow))


GRID = shapes()


@lru_cache(maxsize=16)
def _factors(time: bytes) -> tuple[Array, Array]:
    """Inverse Cholesky factors (n_shape, n, n) and log-determinants (n_shape,) of all shapes on one time grid."""
    t = np.frombuffer(time)
    inverse, logdet = np.empty((len(GRID), t.size, t.size)), np.empty(len(GRID))
    for k, shape in enumerate(GRID):
        L = np.linalg.cholesky(shape.matrix(t))
        inverse[k] = solve_triangular(L, np.eye(t.size), lower=True)
        logdet[k] = 2.0 * np.sum(np.log(np.diag(L)))
    return inverse, logdet


def factors(time: Array) -> tuple[Array, Array]:
    return _factors(stamp(time))


@lru_cache(maxsize=256)
def _whitener(time: bytes, shape: Shape) -> Array:
    L = np.linalg.cholesky(shape.matrix(np.frombuffer(time)))
    return np.asarray(solve_triangular(L, np.eye(len(L)), lower=True))


@dataclass(frozen=True)
class Level:
    """Standard deviations of the three parts and their times (s)."""

    white: float
    fast: float
    tau: float
    slow: float
    ell: float

    def at(self, segment: Segment, allow: float = 1.0) -> Level:
        """In K at a segment: in proportion to its weight, and not below what a model may be wrong by there."""
        w, m = segment.weight, allow * segment.model_K
        white, slow = max(w * self.white, FLOOR_K), max(w * self.slow, m)
        return Level(white, max(w * self.fast, FAST * m), self.tau, slow, self.ell)

    def shape(self) -> Shape:
        """Relative to white, rounded so that equal ones are recognised."""
        a, b = (float(f"{(part / self.white) ** 2:.3g}") for part in (self.fast, self.slow))
        return Shape(a, self.tau, b, self.ell)


START = Level(1.0 / 3.0, 0.0, TAU, 1.0, ELL)


@dataclass(frozen=True)
class Noise:
    """levels : per channel, in units of the segments' weight; `reserve` for channels that were never fitted.

    allow : share of what a model may be wrong by that the noise is never below; 0 for the residual's own noise
    """

    levels: Mapping[str, Level]
    reserve: Level = START
    allow: float = 1.0

    def at(self, segment: Segment) -> Level:
        return self.levels.get(segment.channel, self.reserve).at(segment, self.allow)

    def whiten(self, segment: Segment, columns: Array) -> Array:
        """Sigma^-1/2 applied to columns (n, k) of a segment."""
        level = self.at(segment)
        return (_whitener(stamp(segment.time), level.shape()) @ columns) / level.white


def first_noise(parts: Sequence[Segment]) -> Noise:
    """Before any calibration: slow error of the usual size, white of a third of it."""
    return Noise({s.channel: START for s in parts})


def fit_noise(parts: Sequence[Segment]) -> Noise:
    """Maximum likelihood per channel, all its tests together, each in proportion to its weight."""
    channels = list(dict.fromkeys(s.channel for s in parts))
    square, logdet, count = (np.zeros((len(channels), k)) for k in (len(GRID), len(GRID), 1))
    for own in _tests(parts):
        time = np.unique(np.concatenate([s.time for s in own]))
        inverse, ld = factors(time)
        white = np.tensordot(inverse, np.column_stack([_complete(s, time) for s in own]), axes=(2, 0))
        for s, norm in zip(own, np.einsum("kns,kns->sk", white, white), strict=True):
            at = channels.index(s.channel)
            square[at] += norm
            logdet[at] += ld
            count[at] += time.size
    floor = np.array([FLOOR_K / max(s.weight for s in parts if s.channel == c) for c in channels])[:, None]
    variance = (square + PRIOR_COUNT * floor**2) / (count + PRIOR_COUNT)
    prior = np.array([g.log_prior() for g in GRID])
    best = np.argmin(count * np.log(variance) + logdet - 2.0 * prior, axis=1)
    return Noise({c: _level(GRID[k], float(variance[i, k])) for i, (c, k) in enumerate(zip(channels, best))})


def _level(g: Shape, variance: float) -> Level:
    white, fast, slow = np.sqrt(variance * np.array([1.0, g.a, g.b]))
    return Level(float(white), float(fast), g.tau, float(slow), g.ell)


def _tests(parts: Sequence[Segment]) -> list[list[Segment]]:
    """Segments by test; those of one are whitened in one product, on all instants that any of them has."""
    out: dict[str, list[Segment]] = {}
    for s in parts:
        out.setdefault(s.test, []).append(s)
    return list(out.values())


def _complete(s: Segment, time: Array) -> Array:
    """The weighted residual with its gaps drawn straight across: only here, to choose a shape."""
    return np.interp(time, s.time, s.r) / s.weight
