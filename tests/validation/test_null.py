"""The simulated null on tests as they come."""

from dataclasses import replace

import numpy as np
from playground import Truth
from validation.disturb import USUAL
from validation.evidence import calibrated_case, scored
from validation.null import Null, Setting, data
from validation.verdict import CLEARLY

from validation import diagnose


def test_a_sensor_that_was_not_read_in_one_test_is_simulated_unread():
    """Its readings stay missing there, and the noise of the others stays theirs."""
    case = Truth(11).case()
    first, *rest = case.tests
    blind = replace(first.channels[0], y=np.full_like(first.channels[0].y, np.nan))
    case = replace(case, tests=(replace(first, channels=(blind, *first.channels[1:])), *rest))
    evidence = scored(case, (), calibrated_case(case))
    setting = Setting(evidence.fit, evidence.fit.network, evidence.tests, evidence.parts, np.array([], int), USUAL, 0)
    drawn = data(setting, np.random.default_rng(0))[0]
    assert np.isnan(drawn.channels[0].y).all()
    assert all(np.isfinite(c.y).all() for c in drawn.channels[1:])


def test_evidence_of_missing_heat_is_drawn_too():
    """What 95 % of the machines that lack none stay below; a case of that kind stays there too."""
    answer = diagnose(Truth(12).case(), draws=8, workers=1, plan=False, kinds=["convection"])
    assert 0.0 < answer.usual_nats < 100.0
    assert answer.where[0].evidence_nats < CLEARLY * answer.usual_nats


def test_a_threshold_from_few_draws_is_passed_one_time_in_twenty():
    """40 independent effects of unequal spread, 20 draws: fresh data scaled by the draws' kappa."""
    rng, sd, passed = np.random.default_rng(5), np.geomspace(0.5, 4.0, 40), []
    for _ in range(300):
        null = Null(sd * rng.standard_normal((20, 40)), np.zeros((20, 1)), np.zeros((20, 1)), np.zeros(20))
        passed.append(np.max(sd * rng.standard_normal((20, 40)) / null.kappa, axis=1) > null.threshold())
    assert 0.02 < np.mean(passed) < 0.08
