"""The motors together: a mean, a spread and a drift for every parameter, and the motors that are not of it.

    theta_i(t) = a_i + b_i (t - t0) ,    a_i ~ N(mean, spread^2) ,    b_i ~ N(drift, drift spread^2)

The mean has the prior of the network's parameters: temperatures alone do not fix a common factor of all of them.

Empirical Bayes: mean and spread by expectation and maximisation, each motor weighted as Student's t would, so that one
broken motor does not widen the spread of the others. Sources: Gelman et al. 2013, chapter 5; Lange, Little and Taylor
1989 (t weights); Self and Liang 1987 (test of a variance at its bound).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import norm

from extras.monitor.fleet.unit import UnitHistory
from thermoscope import plugin as th

FREEDOM = 4.0  # of Student's t: a motor at four deviations counts half
ROUNDS, TOLERANCE = 300, 1e-4  # of the iteration: it ends far sooner or turns in a circle; a tenth of NARROW
NARROW = 1e-3  # smallest spread (of the logarithm): a per mille is not a difference
OUTLIER = 0.01  # probability that a fleet without one has a motor that far off: over all motors and parameters
DIFFERS = 0.01  # probability of as much spread where all motors are equal
LOWEST, FIRST = 1e-8, 0.1  # variance of nothing, and where the search begins (10 %)


@dataclass(frozen=True)
class Outlier:
    """A motor and the parameter that sets it apart.  change, sd : of the parameter's logarithm against the fleet

    z : deviations;  probability : of as much in a fleet without an outlier;  instead : parameters that explain nearly
    as much
    """

    unit: str
    parameter: str
    change: float
    sd: float
    z: float
    probability: float
    instead: tuple[str, ...]


@dataclass(frozen=True)
class Population:
    """names (p,);  mean, mean_sd, spread (p,) of the logarithm at t0;  spread_probability (p,) if all were equal

    drift, drift_sd, drift_spread (p,) per year; None where no motor was recorded at two dates. All motors of one date
    share its loads, and with them what the model gets wrong under these: of the drift they tell no more than one motor
    units, posterior (u, p), posterior_sd (u, p), unit_drift, unit_drift_sd : motor by motor
    """

    names: tuple[str, ...]
    mean: th.Array
    mean_sd: th.Array
    spread: th.Array
    spread_probability: th.Array
    units: tuple[str, ...]
    posterior: th.Array
    posterior_sd: th.Array
    outliers: tuple[Outlier, ...]
    year: float
    drift: th.Array | None = None
    drift_sd: th.Array | None = None
    drift_spread: th.Array | None = None
    unit_drift: th.Array | None = None
    unit_drift_sd: th.Array | None = None


@dataclass(frozen=True)
class _Moments:
    """H (u, k, k), eta (u, k) of every motor;  prior_sd (k,) of the mean;  mean, variance (k,) of the population"""

    H: th.Array
    eta: th.Array
    prior_sd: th.Array
    mean: th.Array
    variance: th.Array

    def with_mean(self, weights: th.Array) -> "_Moments":
        """With the mean that is likeliest under these variances."""
        bare = replace(self, mean=np.zeros_like(self.mean))
        M, u = bare.outside()
        return replace(self, mean=np.asarray(np.linalg.solve(self.precision(M, weights), weights @ u), float))

    def precision(self, M: th.Array, weights: th.Array) -> th.Array:
        """(k, k) of the mean."""
        return np.asarray(np.einsum("u,uij->ij", weights, M) + np.diag(self.prior_sd**-2.0), float)

    def posterior(self) -> tuple[th.Array, th.Array]:
        """Mean (u, k) and covariance (u, k, k) of every motor."""
        P = np.linalg.inv(self.H + np.diag(1.0 / self.variance))
        return np.einsum("uij,uj->ui", P, self.eta + self.mean / self.variance), np.asarray(P, float)

    def outside(self) -> tuple[th.Array, th.Array]:
        """S^-1 (u, k, k) of how far each motor may lie from the mean, and S^-1 r (u, k) of how far it does."""
        P = np.linalg.inv(self.H + np.diag(1.0 / self.variance))
        M = self.H - self.H @ P @ self.H
        r = self.eta - self.H @ self.mean
        return M, r - np.einsum("uij,ujk,uk->ui", self.H, P, r)

    def weights(self) -> th.Array:
        """(u,) by Student's t; twins of the mean count fully."""
        m, P = self.posterior()
        away = (m - self.mean) ** 2 + np.einsum("uii->ui", P)
        square = np.sum(away / self.variance, axis=1)
        return np.minimum((FREEDOM + self.mean.size) / (FREEDOM + square), 1.0)

    def log_likelihood(self, weights: th.Array) -> float:
        """Up to what does not depend on the variances."""
        inner = self.H + np.diag(1.0 / self.variance)
        r = self.eta - self.H @ self.mean
        fit = np.einsum("ui,uij,uj->u", r, np.linalg.inv(inner), r)
        size = np.linalg.slogdet(inner)[1] + np.sum(np.log(self.variance))
        return float(0.5 * weights @ (fit - size))


def population(units: Sequence[UnitHistory]) -> Population:
    """From the statistics of all motors."""
    names = units[0].parts[0].names
    years = np.array([y for u in units for y in u.years])
    middle = float(np.mean(years))
    drifts = any(len(set(u.years)) > 1 for u in units)
    H, eta = zip(*(_of_unit(u, middle, drifts) for u in units), strict=True)
    first = units[0].parts[0]
    prior = np.concatenate([first.sd, first.drift_sd]) if drifts else first.sd
    moments, weights = _converged_moments(np.array(H), np.array(eta), prior)
    p, (m, P) = len(names), moments.posterior()
    sd = np.sqrt(np.einsum("uii->ui", P))
    error = _mean_sd(moments, weights)
    error[p:] = _mean_sd(moments, weights / weights.sum())[p:]
    labels, spread = tuple(u.name for u in units), np.sqrt(moments.variance)
    first_p = (moments.mean[:p], error[:p], spread[:p], _equal(moments, weights, p))
    outliers = tuple(_outliers(moments, labels, names))
    out = Population(names, *first_p, labels, m[:, :p], sd[:, :p], outliers, middle)
    if not drifts:
        return out
    out = replace(out, drift=moments.mean[p:], drift_sd=error[p:], drift_spread=spread[p:])
    return replace(out, unit_drift=m[:, p:], unit_drift_sd=sd[:, p:])


def _of_unit(unit: UnitHistory, middle: float, drifts: bool) -> tuple[th.Array, th.Array]:
    """H and eta over [a, b], or over a alone where nothing can drift."""
    p = len(unit.parts[0].names)
    k = 2 * p if drifts else p
    H, eta = np.zeros((k, k)), np.zeros(k)
    for year, part in zip(unit.years, unit.parts, strict=True):
        X = np.hstack([np.eye(p), (year - middle) * np.eye(p)])[:, :k]
        H += X.T @ part.H @ X
        eta += X.T @ part.eta
    return H, eta


def _converged_moments(H: th.Array, eta: th.Array, prior_sd: th.Array) -> tuple[_Moments, th.Array]:
    """Mean and variance that no longer move, and the weights of the motors."""
    k, weights = eta.shape[1], np.ones(len(H))
    now = _Moments(H, eta, prior_sd, np.zeros(k), np.full(k, FIRST**2)).with_mean(weights)
    for _ in range(ROUNDS):
        m, P = now.posterior()
        around = (m - now.mean) ** 2 + np.einsum("uii->ui", P)
        variance = np.maximum(np.average(around, axis=0, weights=weights), LOWEST)
        change = float(np.max(np.abs(np.log(variance / now.variance))))
        now = replace(now, variance=variance).with_mean(weights)
        weights = now.weights()
        if change < TOLERANCE:
            break
    return now, weights


def _mean_sd(of: _Moments, weights: th.Array) -> th.Array:
    """(k,) how sure the population's mean is."""
    M, _ = of.outside()
    return np.sqrt(np.diag(np.linalg.inv(of.precision(M, weights))))


def _equal(of: _Moments, weights: th.Array, p: int) -> th.Array:
    """(p,) probability of as much spread where all motors have one value: half a chi-square of one degree."""
    best, out = of.log_likelihood(weights), np.ones(p)
    for k in range(p):
        if of.variance[k] > NARROW**2:
            none = of.variance.copy()
            none[k] = LOWEST
            gain = 2.0 * (best - replace(of, variance=none).log_likelihood(weights))
            out[k] = float(norm.sf(np.sqrt(max(gain, 0.0))))
    return out


def _outliers(of: _Moments, units: Sequence[str], names: Sequence[str]) -> list[Outlier]:
    """Motors of which one parameter alone lies outside the fleet; the likeliest parameter names the outlier."""
    M, u = of.outside()
    p = len(names)
    information = np.einsum("uii->ui", M)[:, :p]
    z = np.where(information > 0.0, u[:, :p] / np.sqrt(np.maximum(information, 1e-300)), 0.0)
    out = []
    for i in np.argsort(-np.abs(z).max(axis=1)):
        k = int(np.argmax(np.abs(z[i])))
        chance = min(2.0 * float(norm.sf(abs(z[i, k]))) * z.size, 1.0)
        if chance < OUTLIER:
            near = [n for j, n in enumerate(names) if j != k and z[i, k] ** 2 - z[i, j] ** 2 < 10.0]
            change, sd = float(u[i, k] / information[i, k]), float(information[i, k] ** -0.5)
            out.append(Outlier(units[i], names[k], change, sd, float(z[i, k]), chance, tuple(near)))
    return out
