"""What simpler ways of looking at the same residual would say, on the same case and the same calibrated model.

    largest residual   the node whose sensor is worst, if its rms exceeds the sensor's sigma
    correlation        the effect whose trace correlates best with the residual, calibration ignored
    forward BIC, LRT   least squares with white noise: the effect that lowers the deviance most, if by log n, or by 3.84
    AIC refit          the same effect if by 2, after refitting the best five with all parameters

Deviance drops of BIC and LRT are those of the linearised refit (Wald's form of the likelihood ratio); AIC's are refits.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from measured.case import Case
from validation.comparison.linearisation import Segment
from validation.inference.evidence import Evidence, calibrated_case, candidates, scored
from validation.inference.hypotheses import Weighed
from validation.inference.refit import laplace

Array = NDArray[np.float64]
SIGMA_K, LRT, AIC = 0.5, 3.84, 2.0


@dataclass(frozen=True)
class White:
    """Least squares with white noise: residual, nuisance and effect columns over each channel's rms."""

    r: Array
    J: Array
    Z: Array
    channels: dict[str, float]


@dataclass(frozen=True)
class WhiteNoise:
    """Readings independent of one another: rms (K) per channel."""

    rms: dict[str, float]

    def whiten(self, segment: Segment, columns: Array) -> Array:
        return columns / self.rms[segment.channel]


def white(evidence: Evidence) -> White:
    p, rms = len(evidence.fit.unknowns.parameters), {}
    for c in dict.fromkeys(s.channel for s in evidence.parts):
        own = np.concatenate([s.r for s in evidence.parts if s.channel == c])
        rms[c] = float(max(np.sqrt(np.mean(own**2)), 0.03))
    r = np.concatenate([s.r / rms[s.channel] for s in evidence.parts])
    X = np.concatenate([s.J / rms[s.channel] for s in evidence.parts])
    return White(r, X[:, :p], X[:, p:], rms)


def signed(evidence: Evidence, z: Array) -> Array:
    """Positive in the direction physics allows."""
    sign = evidence.score.sign
    return np.where(sign == 0, np.abs(z), sign * z)


def correlation(evidence: Evidence, w: White) -> tuple[str, bool]:
    """Best correlation; it fires beyond the 5 % level of independent readings, Bonferroni over the candidates."""
    size = np.sqrt(np.sum(w.Z**2, axis=0) * np.sum(w.r**2))
    z = signed(evidence, w.Z.T @ w.r / np.where(size > 0, size, np.inf)) * np.sqrt(w.r.size)
    return evidence.names[int(np.argmax(z))], bool(z.max() > np.sqrt(2.0 * np.log(z.size / 0.05)))


def deviance_drops(evidence: Evidence, w: White) -> Array:
    """What each effect would lower the deviance by, white noise, all nuisances free within their priors."""
    fit = evidence.fit
    weight = fit.unknowns.sd**-2.0
    H = w.J.T @ w.J + np.diag(weight)
    take = np.linalg.solve(H, w.J.T @ w.Z)
    u = w.Z.T @ w.r - take.T @ (w.J.T @ w.r) + take.T @ (weight * fit.theta)
    raw = np.sum(w.Z**2, axis=0)
    V = raw - np.sum((w.J.T @ w.Z) * take, axis=0)
    z = np.where(1e-6 * raw < V, u / np.sqrt(np.where(V > 0, V, 1.0)), 0.0)
    return np.asarray(np.maximum(signed(evidence, z), 0.0) ** 2)


def aic(evidence: Evidence, w: White, drop: Array) -> tuple[str, bool]:
    """The best of five refits under white noise."""
    plain = replace(evidence, fit=replace(evidence.fit, noise=WhiteNoise(w.channels), error=None))
    none = laplace(plain, Weighed()).fit
    refits = {k: laplace(plain, Weighed((int(k),))).fit for k in np.argsort(-drop)[:5]}
    fits = {k: fit for k, fit in refits.items() if fit is not None}  # with some the model runs away
    best = min(fits, key=lambda k: fits[k].objective)
    return evidence.names[int(best)], bool(2.0 * (none.objective - fits[best].objective) > AIC)


def peers(case: Case, with_refits: bool = True) -> dict[str, list]:
    """name -> [what it would name, whether it claims it]."""
    evidence = scored(case, candidates(case), calibrated_case(case))
    w = white(evidence)
    worst = max(w.channels, key=lambda c: w.channels[c])
    drop = deviance_drops(evidence, w)
    best, n = evidence.names[int(np.argmax(drop))], w.r.size
    out = {
        "largest residual": [worst, w.channels[worst] > SIGMA_K],
        "correlation": list(correlation(evidence, w)),
        "forward BIC": [best, bool(drop.max() > np.log(n))],
        "forward LRT": [best, bool(drop.max() > LRT)],
    }
    return {**out, "AIC refit": list(aic(evidence, w, drop))} if with_refits else out
