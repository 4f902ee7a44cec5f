"""Which candidates explain the residual as well as the best one: nonlinear refits under the sharpened noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2

from validation.calibrate import Fit, silent, square_of
from validation.effects import Effect
from validation.evidence import Evidence, polished, refit, sharpened
from validation.noise import Noise
from validation.score import per_test

Array = NDArray[np.float64]
GAP = 10.0
FAR_FETCHED = 2.0  # times GAP
COMPENSATED = 0.3
SILENT = 6.0
REFITS = 6


@dataclass(frozen=True)
class Race:
    """The refitted candidates, best first.

    index : candidates;  fits : their refits under `noise`;  gap : deviance behind the best over the best's kappa^2,
        alone or, where that tells them apart, beside it
    limit : gap from which each counts as told from the best
    group : the candidates that cannot be told from the best
    """

    index: tuple[int, ...]
    fits: tuple[Fit, ...]
    gap: tuple[float, ...]
    limit: tuple[float, ...]
    noise: Noise

    @property
    def group(self) -> tuple[int, ...]:
        return tuple(k for k, g, most in zip(self.index, self.gap, self.limit, strict=True) if g < most)

    @property
    def best(self) -> Fit:
        return self.fits[0]

    def fit(self, k: int) -> Fit:
        """The refit with candidate k."""
        return self.fits[self.index.index(k)]


def leading(
    evidence: Evidence, kappa: Array, level: float, progress: Callable[[str], None] = silent,
    known: Mapping[int, Fit] = MappingProxyType({}),
) -> dict[int, Fit]:  # fmt: skip
    """Refits of the candidates that score best, three at most and all above a level.

    known : refits of this evidence that were made before
    """
    scaled = evidence.score.z / kappa
    first = [int(k) for k in np.argsort(-scaled)[:3] if scaled[k] > level]
    if new := [evidence.names[k] for k in first if k not in known]:
        progress(f"refitting {', '.join(new)}")
    return {k: known[k] if k in known else polished(evidence, [k], refit(evidence, [k])) for k in first}


def race(
    evidence: Evidence, kappa: Array, threshold: float, progress: Callable[[str], None] = silent,
    known: Mapping[int, Fit] = MappingProxyType({}),
) -> Race:  # fmt: skip
    """Refit the most likely candidates, take the best one's residual as noise, and compare all under it.

    known : refits of this evidence that were made before
    """
    fits = leading(evidence, kappa, threshold, progress, known)
    leader = min(fits, key=lambda k: fits[k].objective)
    for _ in range(2):
        noise = sharpened(fits[leader])
        runners = shortlist(evidence, noise, kappa, leader)
        progress(f"comparing {evidence.names[leader]} with {len(runners) - 1} rivals")
        fits = compared(evidence, runners, noise, fits, kappa)
        best = min(runners, key=lambda k: fits[k].objective)
        if best == leader:
            break
        leader = best
    progress(f"setting {evidence.names[leader]} beside its rivals")
    leader, gap = sorted_out(evidence, fits, runners, leader, noise, kappa)
    runners.sort(key=lambda k: (k != leader, fits[k].objective))
    limit = tuple(needed(evidence.effects[leader], fits[leader], evidence.effects[k]) for k in runners)
    return Race(tuple(runners), tuple(fits[k] for k in runners), tuple(gap[k] for k in runners), limit, noise)


def needed(best: Effect, fit: Fit, rival: Effect) -> float:
    """Gap from which a rival is told from the best.

    A thermometer that would have to be further off than thermometers are has to explain clearly more than physics
    before that is dismissed.
    """
    beyond = best.fault and not best.whole and abs(fit.values[best.name]) > max(abs(t) for t in best.typical)
    return FAR_FETCHED * GAP if beyond and not rival.fault else GAP


def sorted_out(
    evidence: Evidence, fits: Mapping[int, Fit], runners: Sequence[int], leader: int, noise: Noise, kappa: Array
) -> tuple[int, dict[int, float]]:
    """The leader, and how far it is ahead of each runner: from the two alone, or from the two side by side.

    Of two that explain as much alone, one is told from the other if it gains beside the other more than machines with
    nothing missing let it, and the other beside it does not. An effect whose score scatters widely on such machines
    explains what every model gets wrong, and with it a good part of anything: it may fit best, and yet not be what is
    missing.
    """
    for last in (False, True):
        alone = {k: max(behind(fits[k], fits[leader], float(kappa[leader])), 0.0) for k in runners}
        near = [k for k in runners if k != leader and alone[k] < GAP]
        beside = {k: each_beside(evidence, fits, leader, k, noise, kappa) for k in near}
        over = [k for k, (ahead, own) in beside.items() if own >= GAP > ahead]
        if last or not over:
            break
        leader = max(over, key=lambda k: beside[k][1])
    told = {k: ahead for k, (ahead, own) in beside.items() if ahead >= GAP > own}
    return leader, alone | told


def each_beside(
    evidence: Evidence, fits: Mapping[int, Fit], one: int, other: int, noise: Noise, kappa: Array
) -> tuple[float, float]:
    """Deviance that each of two effects gains beside the other, each over its own kappa^2."""
    both = polished(evidence, [one, other], refit(evidence, [one, other], noise))
    return behind(fits[other], both, float(kappa[one])), behind(fits[one], both, float(kappa[other]))


def compared(
    evidence: Evidence, runners: Sequence[int], noise: Noise, known: Mapping[int, Fit], kappa: Array
) -> dict[int, Fit]:
    """The runners' refits under the race's noise; those that come near the best go on with a Jacobian of their own."""
    fits = {k: refit(evidence, [k], noise, known.get(k)) for k in runners}
    best = min(fits.values(), key=lambda fit: fit.objective)
    near = [k for k in runners if behind(fits[k], best, float(np.max(kappa[runners]))) < 2.0 * GAP]
    return fits | {k: polished(evidence, [k], fits[k]) for k in near}


def behind(fit: Fit, best: Fit, kappa: float) -> float:
    """Deviance by which a fit is worse, in units of the calibrated noise."""
    return 2.0 * (fit.objective - best.objective) / kappa**2


def shortlist(evidence: Evidence, noise: Noise, kappa: Array, leader: int) -> list[int]:
    """The leader and the candidates whose expected deviance comes closest to its own under this noise."""
    s = evidence.resharpened(noise)
    drop = np.where(s.z > 0, s.z, 0.0) ** 2
    near = [int(k) for k in np.argsort(-drop) if k != leader and s.visible[k]]
    slack = 4.0 * GAP * kappa[leader] ** 2 + 0.2 * drop[leader]
    return [leader, *(k for k in near[: REFITS - 1] if drop[k] > drop[leader] - slack)]


def constancy(evidence: Evidence, k: int, kappa: float) -> float:
    """Probability that an effect of one amplitude differs as much between tests as it seems to."""
    fit = evidence.fit
    G_JZ = sum(g.JZ for g in evidence.grams.values())
    a, var = per_test(evidence.grams, k, np.asarray(np.linalg.solve(fit.H, G_JZ), float))
    if a.size < 2:
        return 1.0
    mean = np.sum(a / var) / np.sum(1.0 / var)
    return float(chi2.sf(np.sum((a - mean) ** 2 / var) / kappa**2, a.size - 1))


def told_by_data(evidence: Evidence, found: Race) -> tuple[float, float]:
    """What the readings contribute to the best candidate's gain in deviance, and their share in it."""
    before, after = (square_of(fit.parts, found.noise) for fit in (evidence.fit, found.best))
    strain, eased = (float(np.sum((fit.theta / fit.unknowns.sd) ** 2)) for fit in (evidence.fit, found.best))
    gain = before - after + max(strain - eased, 0.0)
    return before - after, (before - after) / gain if gain > 0 else 0.0


def weak(evidence: Evidence, found: Race) -> bool:
    """Does the calibration explain the readings as well, against its priors only?"""
    best = found.index[0]
    if evidence.effects[best].fault:
        return False
    gain, share = told_by_data(evidence, found)
    return evidence.twins[best] is not None or (share < COMPENSATED and gain < SILENT)
