"""How far the tests of the menu would set rivals apart."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from validation.apart import separation, told_apart
from validation.evidence import Evidence
from validation.findings import NextTest
from validation.foretell import proven, read_by
from validation.menu import possible
from validation.rivals import Race
from validation.score import gram
from validation.sheet import segments

Array = NDArray[np.float64]


def next_tests(
    evidence: Evidence, found: Race, amplitude: Mapping[int, float], kappa: Array
) -> list[NextTest]:  # fmt: skip
    """Tests that separate the race's group, best gain per hour first.

    Gain: the smallest deviance, over all pairs, by which the wrong one would fit worse with the new test added.
    """
    fit, base = evidence.fit, evidence.tests[-1]
    p, columns = fit.theta.size, (*fit.unknowns.parameters, *(evidence.parameters[k] for k in found.group))
    promised = []
    for experiment, plan in possible(base):
        test = read_by(found.best, plan)
        (more,) = gram(segments(evidence.network, [test], fit.values, columns), fit.noise, p).values()
        promised.append((experiment, [test], separation(evidence, more, found.group, amplitude, kappa)))
    promised.sort(key=lambda row: -min(row[2].values()) / row[0].hours)
    left = proven(evidence, found, [(new, gaps) for _, new, gaps in promised], kappa)
    out = [
        NextTest(e.name, told_apart(evidence, gaps), min(gaps.values()), e.hours)
        for (e, _, _), gaps in zip(promised, left, strict=True)
    ]
    return sorted(out, key=lambda t: -t.predicted_gain / t.hours)
