"""How far the tests of the menu would set rivals apart."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from validation.apart import separation, told_apart
from validation.evidence import Evidence
from validation.findings import NextTest
from validation.foretell import Plan, proven, read_by
from validation.menu import possible
from validation.rivals import Race
from validation.score import gram
from validation.sheet import segments

Array = NDArray[np.float64]


def next_tests(evidence: Evidence, found: Race, kappa: Array) -> list[NextTest]:
    """Tests that separate the race's group, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    """
    left = proven(evidence, found, _planned(evidence, found, kappa), kappa)
    return [NextTest(p.what, told_apart(evidence, p.gaps), p.gain, p.hours) for p in left]


def _planned(evidence: Evidence, found: Race, kappa: Array) -> Iterator[Plan]:
    fit = evidence.fit
    p, columns = fit.theta.size, (*fit.unknowns.parameters, *(evidence.parameters[k] for k in found.group))
    for experiment, plan in possible(evidence.tests[-1], evidence.network):
        test = read_by(found.best, plan)
        (more,) = gram(segments(evidence.network, [test], fit.values, columns), fit.noise, p).values()
        yield Plan(experiment.name, experiment.hours, [test], separation(evidence, found, more, kappa))
