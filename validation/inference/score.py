"""The nuisance-projected score: what each effect would explain once the calibration has taken what it can.

Everything follows from one Gram matrix G = [J Z r]' Sigma^-1 [J Z r], accumulated segment by segment, so memory does
not depend on the length of the record. Expected deviance drop u^2 / V, amplitude u / V, absorbed share 1 - V / Z'Z.
Source: Rao 1948 (score test); Sorbom 1989 (modification index); marginal form by the Woodbury identity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag
from scipy.special import log_ndtr, logsumexp

from geom.arrays import Array
from lumped.model.once import once
from measured.doubt import SIZES

if TYPE_CHECKING:
    from validation.calibration.calibrate import Fit
    from validation.calibration.model_error import ModelError
    from validation.comparison.linearisation import Segment
    from validation.noise import Noise

Signs = NDArray[np.int64]


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

    def subset(self, effects: Sequence[int]) -> Gram:
        """The same matrix with some of its effects only."""
        columns = list(effects)
        return replace(self, JZ=self.JZ[:, columns], ZZ=self.ZZ[np.ix_(columns, columns)], Zr=self.Zr[columns])

    def padded(self, before: int, after: int) -> Gram:
        """The same matrix with effects that do nothing before and after its own."""
        both = (before, after)
        return replace(self, JZ=np.pad(self.JZ, ((0, 0), both)), ZZ=np.pad(self.ZZ, both), Zr=np.pad(self.Zr, both))


class Whitened(NamedTuple):
    """What a segment says of the nuisances alone.

    at : nuisances that act in it, and -1;  X (n, at) : their whitened columns, and the residual;  XX : X'X
    """

    at: NDArray[np.int64]
    X: Array
    XX: Array

    @classmethod
    def of(cls, s: Segment, noise: Noise, p: int, error: ModelError | None) -> Whitened:
        J = np.column_stack([s.J[:, :p], error.of(s)]) if error else s.J[:, :p]
        # most columns are zero in most segments (a bias is of one sensor, a start of one test): whitening is what costs
        at = np.flatnonzero(J.any(axis=0))
        X = noise.whiten(s, np.column_stack([J[:, at], s.r]))
        return cls(np.append(at, -1), X, X.T @ X)


def gram(
    parts: Sequence[Segment],
    noise: Noise,
    p: int,
    error: ModelError | None = None,
    alone: Sequence[Whitened] | None = None,
) -> dict[str, Gram]:
    """One Gram matrix per test.

    Parameters: `parts` segments whose J has p nuisance columns, then the effects' (K per unit); `error` the model
    error, whose d columns count as further nuisances; `alone` the segments without effects, where that was worked out.
    Returns: test -> Gram of p + d nuisances.
    """
    q, out = p + (error.size if error else 0), dict[str, Array]()
    for s, (at, X, XX) in zip(parts, alone or [Whitened.of(s, noise, p, error) for s in parts], strict=True):
        size = q + s.J.shape[1] - p + 1
        G = out.setdefault(s.test, np.zeros((size, size)))
        G[np.ix_(at, at)] += XX
        if (k := p + np.flatnonzero(s.J[:, p:].any(axis=0))).size:
            Z, here = noise.whiten(s, s.J[:, k]), k + q - p
            G[np.ix_(here, here)] += Z.T @ Z
            G[np.ix_(at, here)] += (cross := X.T @ Z)
            G[np.ix_(here, at)] += cross.T
    return {
        test: Gram(G[:q, :q], G[:q, q:-1], G[q:-1, q:-1], G[:q, -1], G[q:-1, -1], float(G[-1, -1]))
        for test, G in out.items()
    }


def total(grams: Mapping[str, Gram]) -> Gram:
    """The Gram matrix of all tests together: an effect has one amplitude in all of them."""
    first, *rest = grams.values()
    for g in rest:
        first = first + g
    return first


def per_test(grams: Mapping[str, Gram]) -> Gram:
    """The Gram matrix with every effect in every test as an effect of its own, test by test in the order of `grams`."""
    each = list(grams.values())
    return Gram(
        np.sum([g.JJ for g in each], axis=0),
        np.hstack([g.JZ for g in each]),
        block_diag(*(g.ZZ for g in each)),
        np.sum([g.Jr for g in each], axis=0),
        np.concatenate([g.Zr for g in each]),
        sum(g.rr for g in each),
    )


@dataclass(frozen=True)
class Score:
    """u, V : (K,), (K, K) efficient score and its covariance under no effect;  raw : (K,) diagonal of Z'Sigma^-1 Z

    sign : (K,) what physics allows, 0 for both;  absorber : (K,) index of the nuisance that takes most of each effect
    """

    u: Array
    V: Array
    raw: Array
    sign: Signs
    absorber: Signs

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
        """(K,) best amplitude of each effect alone, by its tangent; 0 where it is invisible."""
        return np.where(self.visible, self.u / np.where(self.visible, np.diag(self.V), 1.0), 0.0)

    @property
    def sd(self) -> Array:
        """(K,) standard deviation of that amplitude; inf where it is invisible."""
        return np.where(self.visible, np.where(self.visible, np.diag(self.V), 1.0) ** -0.5, np.inf)

    @property
    def absorbed(self) -> Array:
        """(K,) share of each effect's trace that the calibration takes."""
        return 1.0 - np.diag(self.V) / np.maximum(self.raw, 1e-300)

    @property
    def cosine(self) -> Array:
        """How alike two effects look after projection, (K, K) in [-1, 1]."""
        d = np.where(self.visible, np.sqrt(np.maximum(np.diag(self.V), 1e-300)), np.inf)
        return self.V / np.outer(d, d)

    def log_bayes(self, scale: Array) -> Array:
        """(K,) log Bayes factor (nats) of each effect against nothing; 0 where nothing is visible.

        Parameters: `scale` (K,) usual size of each amplitude, in its unit.
        """
        return np.asarray(np.where(self.visible, average_size(self.u, np.diag(self.V), scale, self.sign), 0.0))


def score(G: Gram, theta: Array, prior_sd: Array, sign: Signs) -> Score:
    """Efficient score of all effects of a Gram matrix.

    Parameters: `theta` (p,) where the nuisances stand, `prior_sd` (p,) of their priors about 0; `sign` (K,).
    """
    weight = prior_sd**-2.0
    H = G.JJ + np.diag(weight)
    take = np.linalg.solve(H, G.JZ)
    u = G.Zr - take.T @ G.Jr + take.T @ (weight * theta)  # the last term: the calibration may not stand at its optimum
    V = G.ZZ - G.JZ.T @ take
    size = np.abs(take) * np.sqrt(np.maximum(np.diag(G.JJ), 0.0))[:, None]
    return Score(u, 0.5 * (V + V.T), np.diag(G.ZZ).copy(), sign, np.argmax(size, axis=0))


def fit_gram(fit: Fit, parts: Sequence[Segment]) -> dict[str, Gram]:
    """test -> Gram of segments [calibrated parameters | effects] under a fit's noise, its model error a nuisance."""
    p = len(fit.unknowns.parameters)
    same = len(parts) == len(fit.parts) and all(
        np.array_equal(s.r, f.r) and np.array_equal(s.J[:, :p], f.J) for s, f in zip(parts, fit.parts, strict=True)
    )
    return gram(parts, fit.noise, p, fit.error, whitened(fit) if same else None)


@once
def whitened(fit: Fit) -> list[Whitened]:
    """A fit's own segments: they are asked for each time that further effects are scored about it."""
    return [Whitened.of(s, fit.noise, len(fit.unknowns.parameters), fit.error) for s in fit.parts]


def fit_prior(fit: Fit) -> tuple[Array, Array]:
    """(p + d,) coordinates and prior deviations of the calibrated parameters, then of the model error."""
    d = fit.error.size if fit.error else 0
    return np.concatenate([fit.theta, np.zeros(d)]), np.concatenate([fit.unknowns.sd, np.ones(d)])


def fit_score(fit: Fit, parts: Sequence[Segment], sign: Signs | None = None, each_test: bool = False) -> Score:
    """The efficient score of effects about a fit.

    Parameters: `parts` segments [calibrated parameters | K effects]; `sign` (K,), by default both are allowed;
    `each_test`: every effect in every test by itself, (tests times K,).
    """
    grams = fit_gram(fit, parts)
    G = per_test(grams) if each_test else total(grams)
    return score(G, *fit_prior(fit), np.zeros(G.Zr.size, int) if sign is None else sign)


def one_size(u: Array, V: Array, sd: Array, sign: Signs) -> Array:
    """Log Bayes factors (nats) of single effects with amplitudes of one usual size, half-normal where signed."""
    q = V + sd**-2.0
    return np.asarray(0.5 * u**2 / q - 0.5 * np.log(sd**2 * q) + log_sign_gain(u / np.sqrt(q), sign))


def average_size(u: Array, V: Array, sd: Array, sign: Signs) -> Array:
    """The same averaged over a decade of usual sizes, since nobody knows the usual size better."""
    sizes = [one_size(u, V, f * sd, sign) for f in SIZES]
    return np.asarray(logsumexp(sizes, axis=0) - np.log(len(SIZES)))


def log_sign_gain(z: Array, sign: Signs) -> Array:
    """log P(sign | readings) - log P(sign) of amplitudes z deviations from zero."""
    return np.where(sign == 0, 0.0, np.log(2.0) + log_ndtr(np.where(sign == 0, 1, sign) * z))
