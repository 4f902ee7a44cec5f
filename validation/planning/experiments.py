"""How far the tests of the menu would set rivals apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from geom.errors import ThermoscopeError
from validation.comparison.linearisation import segments
from validation.diagnosis.result import NextTest
from validation.inference.evidence import Evidence
from validation.inference.score import gram
from validation.planning.candidate_tests import possible
from validation.planning.competing_models import Contenders
from validation.planning.prediction import Plan, proven, read_by, widened_error
from validation.planning.separability import separation, told_apart

Array = NDArray[np.float64]


def next_tests(evidence: Evidence, found: Contenders) -> list[NextTest]:
    """Tests that separate the group, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    """
    left = proven(evidence, found, _planned(evidence, found))
    return [NextTest(p.what, told_apart(evidence, p.gaps), p.gain, p.hours) for p in left]


def _planned(evidence: Evidence, found: Contenders) -> Iterator[Plan]:
    fit = evidence.fit
    p, columns = fit.theta.size, (*fit.unknowns.parameters, *(evidence.parameters[k] for k in found.group))
    for experiment, plan in possible(evidence.tests[-1], evidence.network):
        try:
            test = read_by(found.best, plan)
            parts, error = segments(evidence.network, [test], fit.values, columns), widened_error(evidence, [test])
        except ThermoscopeError:  # a model that lacks what cools it runs away in a test that is longer than its own
            continue
        wide = [error.beside(s, p) for s in parts] if error else parts
        (more,) = gram(wide, fit.noise, p + (error.size if error else 0)).values()
        yield Plan(experiment.name, experiment.hours, [test], separation(evidence, found, more))
