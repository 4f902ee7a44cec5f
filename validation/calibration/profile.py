"""Intervals by profile likelihood: each end is where the best fit with the parameter held there is 1.92 nats worse.

Where the model is curved the interval is lopsided, and where a parameter runs into its bound before the data object the
end is called open. The other unknowns are fitted anew at every point, with the Jacobian of the optimum.
Source: Venzon and Moolgavkar 1988; Raue et al. 2009.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.constants import NORMAL_95
from measured.case import Test
from validation.calibration.calibrate import LAST_STEPS, CachedSegments, Fit, Progress, minimise, no_progress
from validation.calibration.intervals import Profile
from validation.parameters.unknowns import Unknowns, to_value

CLOSE = 0.03  # of the deviance of a 95 % interval: moves its end by less than 2 %
LOOKS = 8  # at a curve that is near a parabola; each is a fit


def profiles(
    fit: Fit, tests: Sequence[Test], fixed: Mapping[str, float], names: Sequence[str], progress: Progress = no_progress
) -> dict[str, Profile]:
    """Name -> profile interval at 95 %; `fixed` are the values of what is not free."""
    if not names:
        return {}
    values, here = {**fixed, **fit.values}, CachedSegments(fit.parts, nearby=False)
    start = (fit.network, tests, fit.unknowns, fit.theta, fit.noise, values, LAST_STEPS, here)
    fit, out = minimise(*start, progress=progress, error=fit.error), {}  # where it is most probable
    for name in names:
        progress(f"profile of {name}")
        i = fit.unknowns.names.index(name)
        p, line = fit.unknowns.parameters[i], Line(fit, tests, fixed, i)
        low, high = (end(line, side) for side in (-1.0, 1.0))
        out[name] = Profile(to_value(p, low[0]), to_value(p, high[0]), (low[1], high[1]))
    return out


@dataclass(frozen=True)
class Line:
    """The best objective along one coordinate."""

    fit: Fit
    tests: Sequence[Test]
    fixed: Mapping[str, float]
    i: int

    @property
    def others(self) -> list[int]:
        return [j for j in range(self.fit.theta.size) if j != self.i]

    def worse(self, at: float) -> float:
        """Square root of the deviance by which the best fit with the coordinate held there is worse."""
        fit, i, rest = self.fit, self.i, self.others
        p = fit.unknowns.parameters[i]
        follow = fit.covariance[rest, i] / fit.covariance[i, i]
        start = fit.theta[rest] + follow * (at - fit.theta[i])
        near = [replace(s, J=s.J[:, rest]) for s in fit.parts]
        values = {**self.fixed, **fit.values, p.name: to_value(p, at)}
        free = Unknowns(tuple(fit.unknowns.parameters[j] for j in rest))
        best = minimise(
            fit.network, self.tests, free, start, fit.noise, values, cache=CachedSegments(near), error=fit.error
        )
        objective = best.objective + 0.5 * (at / p.prior_sd) ** 2
        return float(np.sqrt(max(2.0 * (objective - fit.objective), 0.0)))


def end(line: Line, side: float) -> tuple[float, bool]:
    """Coordinate of one end, and whether it is only the bound. The root of the deviance is nearly straight: secants."""
    fit, i = line.fit, line.i
    bound = float(fit.unknowns.bounds[1 if side > 0 else 0][i])
    start, target = float(fit.theta[i]), NORMAL_95
    inner, outer = (start, 0.0), (bound, np.inf)
    at = start + side * target * float(fit.sd[i])
    for _ in range(LOOKS):
        at = min(at, bound) if side > 0 else max(at, bound)
        rise = line.worse(at)
        if abs(rise - target) < CLOSE * target:
            return at, False
        if rise < target and at == bound:
            return bound, True
        inner, outer = ((at, rise), outer) if rise < target else (inner, (at, rise))
        at = _next(inner, outer, target, start, side * float(fit.sd[i]))
    return at, False


def _next(inner: tuple[float, float], outer: tuple[float, float], target: float, start: float, sd: float) -> float:
    """By a straight line between the two nearest points, or outwards in proportion while nothing lies beyond."""
    if np.isfinite(outer[1]):
        share = (target - inner[1]) / (outer[1] - inner[1])
        return inner[0] + float(np.clip(share, 0.05, 0.95)) * (outer[0] - inner[0])
    growth = target / inner[1] if inner[1] > 0 else 2.0
    reach = inner[0] - start if inner[0] != start else 2.0 * sd
    return start + min(1.05 * growth, 3.0) * reach
