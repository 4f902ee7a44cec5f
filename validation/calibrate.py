"""Maximum a posteriori calibration: Levenberg-Marquardt on whitened residuals with Gaussian priors and hard bounds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.network import Network, Parameter
from validation.case import Test
from validation.fitting import Unknowns
from validation.noise import Noise, first_noise, fit_noise
from validation.sheet import INSTANTS, Segment, segments

Array = NDArray[np.float64]
Progress = Callable[[str], None]
STATIONARY = 0.1  # of a posterior standard deviation


def silent(message: str) -> None:
    """No progress."""


@dataclass(frozen=True)
class Fit:
    """A calibrated state.

    theta : (p,) fitted coordinates;  H : (p, p) curvature of the posterior (J'Sigma^-1 J + prior);  parts : residual
    and Jacobian at theta;  gradient : largest |gradient| in units of the posterior sd (0 at the exact optimum)
    """

    network: Network
    unknowns: Unknowns
    theta: Array
    H: Array
    parts: tuple[Segment, ...]
    noise: Noise
    objective: float
    converged: bool
    gradient: float

    @property
    def values(self) -> dict[str, float]:
        return self.unknowns.values(self.theta)

    @property
    def covariance(self) -> Array:
        return np.asarray(np.linalg.inv(self.H), float)

    @property
    def sd(self) -> Array:
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def at_bound(self) -> NDArray[np.bool_]:
        low, high = self.unknowns.bounds
        return (self.theta <= low + 1e-9) | (self.theta >= high - 1e-9)


def normal(parts: Sequence[Segment], noise: Noise) -> tuple[Array, Array, float]:
    """J'Sigma^-1 J, J'Sigma^-1 r and r'Sigma^-1 r, summed over segments."""
    p = parts[0].J.shape[1]
    G = np.zeros((p + 1, p + 1))
    for s in parts:
        X = noise.whiten(s, np.column_stack([s.J, s.r]))
        G += X.T @ X
    return G[:p, :p], G[:p, p], float(G[p, p])


def bounded_step(H: Array, g: Array, theta: Array, low: Array, high: Array) -> Array:
    """Minimiser of the quadratic model inside the bounds: clip the worst offender and solve again for the others."""
    new, free = theta.copy(), np.ones(theta.size, bool)
    for _ in range(theta.size + 1):
        step = np.zeros_like(theta)
        step[~free] = new[~free] - theta[~free]
        rhs = g[free] - H[np.ix_(free, ~free)] @ step[~free]
        step[free] = np.linalg.solve(H[np.ix_(free, free)], rhs)
        over = np.maximum(theta + step - high, low - theta - step)
        if not free.any() or np.max(over[free]) <= 1e-12:
            return np.clip(theta + step, low, high)
        worst = np.flatnonzero(free)[np.argmax(over[free])]
        free[worst] = False
        new[worst] = high[worst] if theta[worst] + step[worst] > high[worst] else low[worst]
    return new


def minimise(
    network: Network,
    tests: Sequence[Test],
    unknowns: Unknowns,
    theta: Array,
    noise: Noise | None = None,
    fixed: Mapping[str, float] | None = None,
    iterations: int = 12,
    instants: int = INSTANTS,
    progress: Progress = silent,
) -> Fit:
    """Fit `unknowns` to the tests from `theta` under a given noise (by default that of uncalibrated sensors)."""
    low, high = unknowns.bounds
    weight, damping = unknowns.sd**-2.0, 0.0

    def look(x: Array, tangents: Sequence[Parameter]) -> list[Segment]:
        return segments(network, tests, {**(fixed or {}), **unknowns.values(x)}, tangents, instants)

    theta = np.clip(theta, low, high)
    parts = look(theta, unknowns.parameters)
    noise = noise or first_noise(parts)
    A, b, square = normal(parts, noise)
    objective, converged = 0.5 * (square + float(theta @ (weight * theta))), False
    for iteration in range(iterations):
        progress(f"calibration step {iteration + 1}, objective {objective:.4g}")
        H, g = A + np.diag(weight), b - weight * theta
        new = bounded_step(H + damping * np.diag(np.diag(H)), g, theta, low, high)
        predicted = float(g @ (new - theta) - 0.5 * (new - theta) @ H @ (new - theta))
        if predicted < 1e-3 * (1.0 + 1e-3 * objective):
            converged = True
            break
        trial = look(new, unknowns.parameters)
        A1, b1, square = normal(trial, noise)
        value = 0.5 * (square + float(new @ (weight * new)))
        if not value < objective:
            damping = max(10.0 * damping, 0.01)
            if damping > 1e6:
                break
            continue
        converged = objective - value < 1e-3 * (1.0 + 1e-3 * value)
        theta, parts, A, b, objective = new, trial, A1, b1, value
        damping = damping / 10.0 if damping > 1e-3 else 0.0
        if converged:
            break
    H, g = A + np.diag(weight), b - weight * theta
    inside = ~((theta <= low + 1e-9) & (g < 0) | (theta >= high - 1e-9) & (g > 0))
    slack = float(np.max(np.abs(g / np.sqrt(np.diag(H)))[inside], initial=0.0))
    return Fit(network, unknowns, theta, H, tuple(parts), noise, objective, converged or slack < STATIONARY, slack)


def calibrated(
    network: Network,
    tests: Sequence[Test],
    unknowns: Unknowns,
    values: Mapping[str, float],
    rounds: int = 2,
    progress: Progress = silent,
    noise: Noise | None = None,
) -> Fit:
    """Calibrate, estimate the noise from the residual, calibrate again under it; `rounds` times."""
    held = {p.name: values.get(p.name, p.value) for p in network.parameters}
    fit = minimise(network, tests, unknowns, unknowns.coordinates(values), noise, held, progress=progress)
    for _ in range(rounds):
        fit = minimise(network, tests, unknowns, fit.theta, fit_noise(fit.parts), held, 10, progress=progress)
    return fit
