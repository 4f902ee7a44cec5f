"""What further readings would decide between effects that the readings at hand cannot tell apart.

By tangents the wrong one of two would fit worse by a^2 V_kk (1 - c_kl^2); for the best plans the readings are those
that one candidate foretells, explained by another that is fitted anew.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from geom.errors import NoSolution
from lumped.model.multipliers import values_of
from measured.case import Test
from validation.calibration.calibrate import CachedSegments, Fit, minimise
from validation.calibration.model_error import ModelError, model_error
from validation.comparison.linearisation import segments
from validation.comparison.predict import predict
from validation.inference.evidence import Evidence, with_members
from validation.inference.score import Gram, fit_prior, score, total
from validation.noise import Noise
from validation.parameters.unknowns import Unknowns, nuisances

Gaps = dict[tuple[int, int], float]
GAP, DECISIVE = 10.0, 20.0  # deviance from which two begin to come apart, and from which a test decides
CHECKED = 2  # of the best plans are refitted: each costs as much as a refit of the diagnosis
STEPS, ENOUGH = 4, 1.0  # of a rival's refit, and the gain (nats) of one: gaps are told in tens


@dataclass(frozen=True)
class CompetingModels:
    """group : indices of effects, most probable first;  fits : with each in the model, all under one noise"""

    group: tuple[int, ...]
    fits: tuple[Fit, ...]
    noise: Noise

    @property
    def best(self) -> Fit:
        return self.fits[0]

    def fit(self, k: int) -> Fit:
        """The refit with effect k."""
        return self.fits[self.group.index(k)]


@dataclass(frozen=True)
class Plan:
    """Further readings.  tests : that have them, planned ones or those at hand with a sensor more;  gaps : between the
    rivals with them, for every pair"""

    what: str
    hours: float
    tests: Sequence[Test]
    gaps: Gaps

    @property
    def gain(self) -> float:
        """Deviance between the two that stay closest."""
        return min(self.gaps.values())

    @property
    def worth(self) -> float:
        """Gain per hour."""
        return self.gain / self.hours


def deviance_difference(fit: Fit, best: Fit) -> float:
    """Deviance by which a fit is worse."""
    return 2.0 * (fit.objective - best.objective)


def separation(evidence: Evidence, models: CompetingModels, more: Gram) -> Gaps:
    """For every pair of a group the gap with more readings than the evidence has, the smaller way."""
    group = models.group
    sign = evidence.score.sign[list(group)]
    s = score(total(evidence.grams).subset(group) + more, *fit_prior(evidence.fit), sign)
    V, c = np.diag(s.V), s.cosine
    size = [models.fit(k).values[evidence.names[k]] for k in group]
    strength = [a**2 * v for a, v in zip(size, V, strict=True)]
    return {
        (group[i], group[j]): float(min(strength[i], strength[j]) * (1.0 - c[i, j] ** 2))
        for i, j in combinations(range(len(group)), 2)
    }


def separable_pairs(evidence: Evidence, gaps: Gaps) -> tuple[str, ...]:
    """The pairs whose gap decides, by name."""
    return tuple(f"{evidence.names[k]} / {evidence.names[m]}" for (k, m), gap in gaps.items() if gap >= DECISIVE)


def predicted_readings(fit: Fit, test: Test) -> Test:
    """The test with the readings that a fitted model foretells."""
    y = predict(fit.network, test, values_of(fit.network, fit.values)).y
    return replace(test, channels=tuple(replace(c, y=y[:, j]) for j, c in enumerate(test.channels)))


def refitted_gains(evidence: Evidence, models: CompetingModels, promised: Iterable[Plan]) -> list[Plan]:
    """The plans with what is left of the gaps that tangents promise, best gain per hour first.

    Tangents promise too much: they do not know how far the rivals can bend. Refits show how much for the first CHECKED
    plans and, in each, the closest pair that might come apart: it is the gain of the plan. What was not refitted, and
    where a rival runs away in a longer test than its own, keeps the largest share that any of those kept.
    """
    plans = sorted(promised, key=lambda p: -p.worth)
    separations: list[Gaps] = [{} for _ in plans]
    for gaps, p in zip(separations[:CHECKED], plans, strict=False):
        for pair in closest_pair(p.gaps):
            with suppress(NoSolution):
                gaps[pair] = predicted_deviance(evidence, models, p.tests, pair)
    shares = [g / p.gaps[pair] for gaps, p in zip(separations, plans, strict=True) for pair, g in gaps.items()]
    share = float(np.clip(max(shares, default=1.0), 0.0, 1.0))
    left = [
        replace(p, gaps={pair: max(min(gap, gaps.get(pair, share * gap)), 0.0) for pair, gap in p.gaps.items()})
        for gaps, p in zip(separations, plans, strict=True)
    ]
    return sorted(left, key=lambda p: -p.worth)


def closest_pair(gaps: Gaps) -> list[tuple[int, int]]:
    """The pair with the smallest gap among those that might come apart; none if none does."""
    return sorted((pair for pair, gap in gaps.items() if gap >= GAP), key=lambda pair: gaps[pair])[:1]


def predicted_deviance(
    evidence: Evidence, models: CompetingModels, new: Sequence[Test], pair: tuple[int, int]
) -> float:
    """Deviance by which the wrong one of a pair would be behind with further readings, the smaller way.

    Unlike a gap in the tangents it counts what the tests at hand say already, and all that the wrong one may still
    bend: its own refit, with start and clock of a new test or bias and lag of a new sensor, meets noiseless readings of
    the right one.
    """
    return min(_difference(evidence, models, new, right, wrong) for right, wrong in (pair, pair[::-1]))


def _difference(evidence: Evidence, models: CompetingModels, new: Sequence[Test], right: int, wrong: int) -> float:
    read, rival = [predicted_readings(models.fit(right), t) for t in new], models.fit(wrong)
    network, unknowns, fixed = with_members(evidence, [wrong])
    names = {p.name for p in network.parameters}
    extra = tuple(p for p in nuisances(network, read) if p.name not in names)
    network, free = replace(network, parameters=(*network.parameters, *extra)), (*unknowns.parameters, *extra)
    here = {**fixed, **{p.name: p.value for p in extra}, **rival.values}
    near = [replace(s, J=np.pad(s.J, ((0, 0), (0, len(extra))))) for s in rival.parts]
    near += segments(network, read, here, free)
    theta, tests = np.concatenate([rival.theta, np.zeros(len(extra))]), (*evidence.tests, *read)
    error = widened_error(evidence, read)
    cache = CachedSegments(near)
    fit = minimise(network, tests, Unknowns(free), theta, models.noise, fixed, STEPS, cache, worth=ENOUGH, error=error)
    return deviance_difference(fit, models.fit(right))


def widened_error(evidence: Evidence, more: Sequence[Test]) -> ModelError | None:
    """The model error of the tests at hand and of further readings."""
    fit = evidence.fit
    if fit.error is None:
        return None
    new = model_error(fit.network, more, fit.values, sensed=evidence.tests)
    return ModelError({**fit.error.columns, **new.columns}, new.names)
