"""How the residual of a calibrated model is correlated, per sensor, and the whitener that follows from it.

    r = s [ white + sqrt(a) OU(tau) + sqrt(b) Matern-3/2(ell) ]

White is reading noise, OU the fast and Matern-3/2 the slow model error.
The shape (a, b, tau, ell) is chosen by maximum likelihood on a grid with log-normal priors around tau = 2 min and
ell = 20 min; the scale s has a closed form. A grid instead of an optimiser: the Cholesky factors of all shapes are made
once per time grid, so the hundreds of simulated data sets of the null are whitened in milliseconds each.
Source: Rasmussen and Williams 2006, chapters 4.2 and 5.4.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular

from validation.sheet import Segment

Array = NDArray[np.float64]
FLOOR_K = 0.03
PRIOR_COUNT = 4.0


@dataclass(frozen=True)
class Shape:
    """Correlation of a residual, up to its scale: variances a (OU) and b (Matern-3/2) relative to white; times in s."""

    a: float
    tau: float
    b: float
    ell: float

    def log_prior(self) -> float:
        fast = np.log(self.tau / 120.0) / 0.8 if self.a else 0.0
        slow = np.log(self.ell / 1200.0) / 0.8 if self.b else 0.0
        return -0.5 * float(fast**2 + slow**2)

    def matrix(self, time: Array) -> Array:
        gap = np.abs(time[:, None] - time[None, :])
        d = np.sqrt(3.0) * gap / self.ell
        return np.eye(time.size) + self.a * np.exp(-gap / self.tau) + self.b * (1.0 + d) * np.exp(-d)


def shapes() -> tuple[Shape, ...]:
    """The grid: white alone, with OU, with Matern, with both."""
    fast = [(0.0, 120.0), *product((1.0, 10.0, 100.0), (60.0, 240.0))]
    slow = [(0.0, 1200.0), *product((1.0, 10.0, 100.0, 1000.0, 10000.0), (600.0, 1200.0, 2400.0))]
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
    return _factors(np.round(time - time[0], 3).tobytes())


@dataclass(frozen=True)
class Noise:
    """shape : index into GRID per channel;  scale : s (K) per channel."""

    shape: Mapping[str, int]
    scale: Mapping[str, float]
    reserve: tuple[int, float] = field(default=(0, 1.0))

    def whiten(self, segment: Segment, columns: Array) -> Array:
        """Sigma^-1/2 applied to columns (n, k) of a segment."""
        inverse, _ = factors(segment.time)
        k, s = self.shape.get(segment.channel, self.reserve[0]), self.scale.get(segment.channel, self.reserve[1])
        return (inverse[k] @ columns) / s

    def rms(self, channel: str) -> float:
        """Standard deviation (K) of the whole residual of a channel."""
        g = GRID[self.shape[channel]]
        return self.scale[channel] * float(np.sqrt(1.0 + g.a + g.b))


def first_noise(parts: Sequence[Segment]) -> Noise:
    """Before any calibration: slow error of the sensor's own size, white of a third of it."""
    start = GRID.index(Shape(0.0, 120.0, 10.0, 1200.0))
    slow = np.sqrt(GRID[start].b)
    sigma = {s.channel: max(s.sigma_K / 3.0, s.model_K / slow, FLOOR_K) for s in parts}
    return Noise({c: start for c in sigma}, sigma)


def fit_noise(parts: Sequence[Segment], floor: float = FLOOR_K) -> Noise:
    """Maximum likelihood per channel, all its tests together; the slow part is at least the channel's model_K."""
    channels = list(dict.fromkeys(s.channel for s in parts))
    square, logdet, count = (np.zeros((len(channels), k)) for k in (len(GRID), len(GRID), 1))
    for own in _same_grid(parts):
        inverse, ld = factors(own[0].time)
        white = np.tensordot(inverse, np.column_stack([s.r for s in own]), axes=(2, 0))
        for s, norm in zip(own, np.einsum("kns,kns->sk", white, white), strict=True):
            at = channels.index(s.channel)
            square[at] += norm
            logdet[at] += ld
            count[at] += s.r.size
    free = (square + PRIOR_COUNT * floor**2) / (count + PRIOR_COUNT)
    variance = np.maximum(free, _least(channels, parts))
    prior = np.array([g.log_prior() for g in GRID])
    fit = count * (np.log(variance) + free / variance) + logdet
    best = np.argmin(np.where(np.isfinite(variance), fit, np.inf) - 2.0 * prior, axis=1)
    scale = np.sqrt(np.maximum(variance[np.arange(len(channels)), best], floor**2))
    return Noise(dict(zip(channels, best.tolist(), strict=True)), dict(zip(channels, scale.tolist(), strict=True)))


def _least(channels: Sequence[str], parts: Sequence[Segment]) -> Array:
    """(n_channel, n_shape) smallest scale variance at which the slow part of a shape reaches the channel's model_K."""
    model = np.array([max(s.model_K for s in parts if s.channel == c) for c in channels])
    slow = np.array([g.b for g in GRID])
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(model[:, None] > 0, model[:, None] ** 2 / slow, 0.0)


def _same_grid(parts: Sequence[Segment]) -> list[list[Segment]]:
    """Segments by time grid; those of one grid are whitened in one product."""
    out: dict[bytes, list[Segment]] = {}
    for s in parts:
        out.setdefault(s.time.tobytes(), []).append(s)
    return list(out.values())
