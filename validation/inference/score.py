"""The nuisance-projected score: what each effect would explain once the calibration has taken what it can.

Everything follows from one Gram matrix G = [J Z r]' Sigma^-1 [J Z r], accumulated segment by segment, so memory does
not depend on the length of the record. Expected deviance drop u^2 / V, amplitude u / V, absorbed share 1 - V / Z'Z.
Source: Rao 1948 (score test); Sorbom 1989 (modification index); marginal form by the Woodbury identity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag
from scipy.special import log_ndtr

from validation.comparison.linearisation import Segment
from validation.noise import Noise

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Gram:
    """[J Z r]' Sigma^-1 [J Z r] in blocks: p nuisances, K effects, one residual."""

    JJ: Array
    JZ: Array
    ZZ: Array
    Jr: Array
    Zr: Array
    rr: float

    def __add__(self, other: Gram) -> Gram:
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Gram(*(a + b for a, b in pairs))

    def of(self, few: Sequence[int]) -> Gram:
        """With some of its effects only."""
        columns = list(few)
        return replace(self, JZ=self.JZ[:, columns], ZZ=self.ZZ[np.ix_(columns, columns)], Zr=self.Zr[columns])


def gram(parts: Sequence[Segment], noise: Noise, p: int) -> dict[str, Gram]:
    """One Gram per test; the first p columns of each segment's J are nuisances, the rest effects."""
    return grams([(s, (s.J,)) for s in parts], noise, p)


def grams(parts: Sequence[tuple[Segment, Sequence[Array]]], noise: Noise, p: int) -> dict[str, Gram]:
    """The same of segments with their columns in blocks (n, k) side by side, in place of J.

    Most columns are zero in most segments: a bias is of one sensor, a start of one test. Those are left out.
    """
    out: dict[str, Array] = {}
    for s, blocks in parts:
        columns = [*blocks, s.r[:, None]]
        nonzero = [np.flatnonzero(X.any(axis=0)) for X in columns]
        first = np.cumsum([0, *(X.shape[1] for X in columns)])
        X = noise.whiten(s, np.column_stack([X[:, k] for X, k in zip(columns, nonzero, strict=True)]))
        at = np.concatenate([k + begin for k, begin in zip(nonzero, first)])
        G = out.setdefault(s.test, np.zeros((first[-1], first[-1])))
        G[np.ix_(at, at)] += X.T @ X
    return {
        test: Gram(G[:p, :p], G[:p, p:-1], G[p:-1, p:-1], G[:p, -1], G[p:-1, -1], float(G[-1, -1]))
        for test, G in out.items()
    }


def total(grams: Mapping[str, Gram]) -> Gram:
    first, *rest = grams.values()
    for g in rest:
        first = first + g
    return first


@dataclass(frozen=True)
class Score:
    """u, V : (K,), (K, K) efficient score and its covariance under no effect;  raw : (K,) diagonal of Z'Sigma^-1 Z

    sign : (K,) what physics allows;  absorber : (K,) index of the nuisance that takes most of each effect
    """

    u: Array
    V: Array
    raw: Array
    sign: NDArray[np.int64]
    absorber: NDArray[np.int64]

    @property
    def visible(self) -> NDArray[np.bool_]:
        """Effects that leave any trace outside the calibrated parameters' span."""
        return np.diag(self.V) > 1e-7 * np.maximum(self.raw, 1e-300)

    @property
    def z(self) -> Array:
        """Signed significance: positive is the direction physics allows; where it allows both, |z|."""
        z = np.where(self.visible, self.u / np.sqrt(np.where(self.visible, np.diag(self.V), 1.0)), 0.0)
        return np.where(self.sign == 0, np.abs(z), self.sign * z)

    @property
    def amplitude(self) -> Array:
        return np.where(self.visible, self.u / np.where(self.visible, np.diag(self.V), 1.0), 0.0)

    @property
    def sd(self) -> Array:
        return np.where(self.visible, np.where(self.visible, np.diag(self.V), 1.0) ** -0.5, np.inf)

    @property
    def absorbed(self) -> Array:
        return 1.0 - np.diag(self.V) / np.maximum(self.raw, 1e-300)

    @property
    def cosine(self) -> Array:
        """How alike two effects look after projection, (K, K) in [-1, 1]."""
        d = np.where(self.visible, np.sqrt(np.maximum(np.diag(self.V), 1e-300)), np.inf)
        return self.V / np.outer(d, d)


def score(G: Gram, theta: Array, prior_sd: Array, sign: NDArray[np.int64]) -> Score:
    """Efficient score of all effects at theta (prior mean 0). The last term corrects for an imperfect optimum."""
    weight = prior_sd**-2.0
    H = G.JJ + np.diag(weight)
    take = np.linalg.solve(H, G.JZ)
    u = G.Zr - take.T @ G.Jr + take.T @ (weight * theta)
    V = G.ZZ - G.JZ.T @ take
    size = np.abs(take) * np.sqrt(np.maximum(np.diag(G.JJ), 0.0))[:, None]
    return Score(u, 0.5 * (V + V.T), np.diag(G.ZZ).copy(), sign, np.argmax(size, axis=0))


def per_test(grams: Mapping[str, Gram]) -> Gram:
    """Every effect in every test as an effect of its own: test by test, in the order of the tests."""
    each = list(grams.values())
    return Gram(
        np.sum([g.JJ for g in each], axis=0),
        np.hstack([g.JZ for g in each]),
        block_diag(*(g.ZZ for g in each)),
        np.sum([g.Jr for g in each], axis=0),
        np.concatenate([g.Zr for g in each]),
        sum(g.rr for g in each),
    )


def one_size(u: Array, V: Array, sd: Array, sign: NDArray[np.int64]) -> Array:
    """Log Bayes factors of single effects with amplitudes of one usual size."""
    q = V + sd**-2.0
    return np.asarray(0.5 * u**2 / q - 0.5 * np.log(sd**2 * q) + log_sign_gain(u / np.sqrt(q), sign))


def log_sign_gain(z: Array, sign: NDArray[np.int64]) -> Array:
    """log P(sign | readings) - log P(sign) of amplitudes z deviations from zero."""
    return np.where(sign == 0, 0.0, np.log(2.0) + log_ndtr(np.where(sign == 0, 1, sign) * z))
