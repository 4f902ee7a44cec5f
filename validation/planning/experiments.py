"""How far the candidate tests would set rivals apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from geom.errors import ThermoscopeError
from validation.comparison.linearisation import segments
from validation.inference.evidence import Evidence
from validation.inference.result import Experiment
from validation.inference.score import gram
from validation.planning.candidate_tests import candidate_tests
from validation.planning.competing_models import CompetingModels
from validation.planning.prediction import Plan, predicted_readings, refitted_gains, widened_error
from validation.planning.separability import separable_pairs, separation

Array = NDArray[np.float64]


def next_tests(evidence: Evidence, models: CompetingModels) -> list[Experiment]:
    """Tests that separate the group, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    """
    left = refitted_gains(evidence, models, _planned(evidence, models))
    return [Experiment("test", p.what, separable_pairs(evidence, p.gaps), p.gain, p.hours) for p in left]


def _planned(evidence: Evidence, models: CompetingModels) -> Iterator[Plan]:
    fit = evidence.fit
    p, columns = fit.theta.size, (*fit.unknowns.parameters, *(evidence.parameters[k] for k in models.group))
    for experiment, plan in candidate_tests(evidence.tests[-1], evidence.network):
        try:
            test = predicted_readings(models.best, plan)
            parts, error = segments(evidence.network, [test], fit.values, columns), widened_error(evidence, [test])
        except ThermoscopeError:  # a model that lacks what cools it runs away in a test that is longer than its own
            continue
        wide = [error.beside(s, p) for s in parts] if error else parts
        (more,) = gram(wide, fit.noise, p + (error.size if error else 0)).values()
        yield Plan(experiment.name, experiment.hours, [test], separation(evidence, models, more))
