"""How the residual of a calibrated model is correlated, per sensor, and the whitener that follows from it.

    r = w [ white + OU(tau) + Matern-3/2(ell) ]      each with its own standard deviation

White is reading noise, OU the fast and Matern-3/2 the slow model error; w (K) is the size of error that is usual for
the channel in this test, so that a test with ten times the rise may have ten times the error. The shape is chosen by
maximum likelihood on a grid with log-normal priors around tau = 2 min and ell = 20 min; the scale has a closed form. A
grid instead of an optimiser: for each fast part and each ell one basis, made once per time grid, makes all slow parts
diagonal, so the hundreds of simulated data sets of the null are judged in a millisecond each. Whatever the fit says,
the slow part is never below the error that a model of this kind is allowed, the fast part never below a quarter of it:
a residual that a calibration has just made small says nothing about how wrong the model is elsewhere.
Source: Rasmussen and Williams 2006, chapters 4.2 and 5.4; Kennedy and O'Hagan 2001 for the allowance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array
from measured.doubt import FORM, USUAL

if TYPE_CHECKING:
    from validation.comparison.linearisation import Segment

TAU, ELL = FORM["fast time"], FORM["slow time"]
FLOOR_K = FORM["resolved"]
MEDIAN = 0.6745  # deviations that half of normal readings are within
TINY = 1e-9  # deviations, so that a fit without any residual has a scale
OUTLYING = 3.0  # deviations: of a thousand readings three are further off by chance


@dataclass(frozen=True)
class Shape:
    """Correlation of a residual, up to its scale: variances a (OU) and b (Matern-3/2) relative to white; times in s."""

    a: float
    tau: float
    b: float
    ell: float

    def log_prior(self) -> float:
        fast = np.log(self.tau / TAU) / FORM["times"] if self.a else 0.0
        slow = np.log(self.ell / ELL) / FORM["times"] if self.b else 0.0
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


# Variance over the white one, and s: decades, as the evidence turns slowly with either.
FASTS = ((0.0, TAU), *product((1.0, 10.0, 100.0), (60.0, 240.0)))
ELLS = (ELL, 600.0, 2400.0)  # s, of the slow part: the usual one, a shorter and a longer
SLOWS = np.array([0.0, 1.0, 10.0, 100.0, 1000.0, 10000.0])  # variance over the white one, by decades
_AT = [(f, e, b) for f, e, b in product(range(len(FASTS)), range(len(ELLS)), range(len(SLOWS))) if b or ELLS[e] == ELL]
GRID = tuple(Shape(*FASTS[f], float(SLOWS[b]), ELLS[e]) for f, e, b in _AT)
GRID_INDEX = tuple(np.array(_AT).T)  # of all fast parts, lengths and slow parts those on the grid


class Bases(NamedTuple):
    """Of a time grid, for every fast part f and ell: W (n_f, n_ell, n, n) with W S_f W' = 1, and W M_ell W' diagonal.

    M_ell : Matern;  S_f : white and fast together;  slow : the diagonal (n_f, n_ell, n);  logdet : of S_f, (n_f,)
    """

    W: Array
    slow: Array
    logdet: Array

    def judged(self, x: Array) -> tuple[Array, Array]:
        """x'Sigma^-1 x of columns x (n, k) and log|Sigma| for every shape of the grid: (n_shape, k) and (n_shape,)."""
        square = np.tensordot(self.W, x, axes=(3, 0)) ** 2
        scale = 1.0 + SLOWS[:, None] * self.slow[:, :, None, :]
        norm = (1.0 / scale) @ square
        logdet = self.logdet[:, None, None] + np.log(scale).sum(axis=-1)
        return norm[GRID_INDEX], logdet[GRID_INDEX]


@lru_cache(maxsize=16)
def _bases(time: bytes) -> Bases:
    t = np.frombuffer(time)
    W, slow, logdet = [], [], []
    for a, tau in FASTS:
        L = np.linalg.cholesky(Shape(a, tau, 0.0, ELL).matrix(t))
        Linv = _inverse(L)
        pairs = [np.linalg.eigh(Linv @ _matern(time, ell) @ Linv.T) for ell in ELLS]
        W.append([V.T @ Linv for _, V in pairs])
        slow.append([np.maximum(values, 0.0) for values, _ in pairs])
        logdet.append(2.0 * np.sum(np.log(np.diag(L))))
    return Bases(np.array(W), np.array(slow), np.array(logdet))


def _inverse(L: NDArray[np.floating]) -> Array:
    """Of a lower triangle."""
    from scipy.linalg.lapack import dtrtri

    return np.asarray(dtrtri(L, lower=1)[0], float)


@lru_cache(maxsize=256)
def _whitener(time: bytes, shape: Shape) -> Array:
    return _inverse(np.linalg.cholesky(shape.matrix(np.frombuffer(time))))


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
        return Level(white, max(w * self.fast, USUAL["fast"] * m), self.tau, slow, self.ell)

    def shape(self) -> Shape:
        """Relative to white, rounded so that equal ones are recognised."""
        a, b = (float(f"{(part / self.white) ** 2:.3g}") for part in (self.fast, self.slow))
        return Shape(a, self.tau, b, self.ell)


START = Level(1.0 / 3.0, 0.0, TAU, 1.0, ELL)


@dataclass(frozen=True)
class Noise:
    """levels : per channel, in units of the segments' weight; `reserve` for channels that were never fitted.

    allow : share of what a model may be wrong by that the noise is never below; 0 for the residual's own noise
    trust : (test, channel) -> (n,) share of each whitened reading that counts; all of it where nothing is said
    """

    levels: Mapping[str, Level]
    reserve: Level = START
    allow: float = 1.0
    trust: Mapping[tuple[str, str], Array] = field(default_factory=dict)

    def at(self, segment: Segment) -> Level:
        return self.levels.get(segment.channel, self.reserve).at(segment, self.allow)

    def whiten(self, segment: Segment, columns: Array) -> Array:
        """Sigma^-1/2 applied to columns (n, k) of a segment."""
        level = self.at(segment)
        white = (_whitener(stamp(segment.time), level.shape()) @ columns) / level.white
        trust = self.trust.get((segment.test, segment.channel))
        return white if trust is None else trust[:, None] * white

    def robust(self, parts: Sequence[Segment]) -> Noise:
        """The same, under which readings that surprise a fit by more than OUTLYING deviations pull it no further.

        A deviation is what half of all readings are within, as a normal one has it: a single sensor that came loose, or
        heat that comes and goes between two readings, would outweigh hours. Source: Huber 1964.
        """
        each = {(s.test, s.channel): np.abs(self.whiten(s, s.r[:, None])[:, 0]) for s in parts}
        far = OUTLYING * max(float(np.median(np.concatenate([*each.values()]))) / MEDIAN, TINY)
        return replace(self, trust={at: np.sqrt(far / np.maximum(e, far)) for at, e in each.items()})

    def logdet(self, segment: Segment) -> float:
        """log|Sigma| of a segment."""
        level = self.at(segment)
        white = _whitener(stamp(segment.time), level.shape())
        return 2.0 * float(segment.time.size * np.log(level.white) - np.sum(np.log(np.diag(white))))

    def log_prior(self, parts: Sequence[Segment]) -> float:
        """Of the slow misfit per channel, where it is larger than a model of this kind is allowed (log-normal), and of
        the times of the shape."""
        over: dict[str, float] = {}
        for s in parts:
            ratio = self.at(s).slow / max(s.model_K, FLOOR_K)
            over[s.channel] = max(over.get(s.channel, 1.0), ratio)
        times = sum(self.levels.get(c, self.reserve).shape().log_prior() for c in over)
        return times - 0.5 * float(sum((np.log(x) / np.log(USUAL["misfit"])) ** 2 for x in over.values()))


# Every reading for itself, by the error that is usual for its record: whatever is slow is to be followed too
FOLLOWED = Noise({}, Level(1.0, 0.0, TAU, 0.0, ELL), allow=0.0)


def first_noise(parts: Sequence[Segment]) -> Noise:
    """Before any calibration: slow error of the usual size, white of a third of it."""
    return Noise({s.channel: START for s in parts})


def fit_noise(parts: Sequence[Segment]) -> Noise:
    """Maximum likelihood per channel, all its tests together, each in proportion to its weight."""
    channels = list(dict.fromkeys(s.channel for s in parts))
    square, logdet, count = (np.zeros((len(channels), k)) for k in (len(GRID), len(GRID), 1))
    for segments in _tests(parts):
        time = np.unique(np.concatenate([s.time for s in segments]))
        norms, ld = _bases(stamp(time)).judged(np.column_stack([_complete(s, time) for s in segments]))
        for s, norm in zip(segments, norms.T, strict=True):
            at = channels.index(s.channel)
            square[at] += norm
            logdet[at] += ld
            count[at] += time.size
    floor = np.array([FLOOR_K / max(s.weight for s in parts if s.channel == c) for c in channels])[:, None]
    variance = (square + FORM["readings"] * floor**2) / (count + FORM["readings"])
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
