"""What a planned test is said to decide is what it decides when it is driven."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from playground import Truth, network, steps

from geom.errors import NoSolution
from measured.case import Case, Model
from validation.comparison.linearisation import segments
from validation.effects import effect
from validation.inference.evidence import calibrated_case, scored
from validation.inference.hypotheses import Weighed
from validation.inference.refit import laplace
from validation.planning import rivals
from validation.planning.candidate_tests import CANDIDATE_TESTS
from validation.planning.experiments import next_tests
from validation.planning.rivals import (
    DECISIVE,
    GAP,
    CompetingModels,
    deviance_difference,
    predicted_deviance,
    predicted_readings,
)

RIVALS = ("brush.friction@commutator", "loss.constant@commutator")


def rubbing(T, u, t):
    return {"commutator": 800.0 * abs(u["speed_rpm"]) / 1000.0}


def one_speed(time, rng):
    return {
        "current_A": steps(time, rng, 150.0, 250.0, 900.0),
        "vehicle_speed_mps": np.zeros_like(time),
        "speed_rpm": np.full_like(time, 900.0),
        "fan_flow_m3h": np.full_like(time, 138.0),
    }


def planned(name, test):
    return next(e for e in CANDIDATE_TESTS if e.name == name).modified(test, network())


@cache
def driven():
    """The true machine, and two tests at one and the same speed."""
    truth = Truth(10, rubbing)
    return truth, tuple(truth.test(name, "calibrate", one_speed) for name in ("first", "second"))


@cache
def raced(more=None):
    """Evidence and refits of the rivals; more: the candidate test that was driven besides."""
    truth, tests = driven()
    if more:
        plan = planned(more, tests[-1])
        tests = (*tests, truth.test(more, "calibrate", lambda time, rng: plan.inputs, hours=4.0))
    case = Case("rubbing", Model(network()), tests)
    evidence = scored(case, [effect(name) for name in RIVALS], calibrated_case(case))
    fits = tuple(laplace(evidence, Weighed((k,))).fit for k in (0, 1))
    return evidence, CompetingModels((0, 1), fits, evidence.fit.noise)


def test_a_plan_is_as_long_as_it_says_and_repeats_what_it_does_not_change():
    test = driven()[1][0]
    plan = planned("same current at two speeds", test)
    assert plan.time[-1] + 10.0 == pytest.approx(4.0 * 3600.0)
    assert np.ptp(np.diff(plan.time)) == 0.0
    assert np.ptp(plan.inputs["current_A"]) == 0.0
    kept = planned("fan flow halved midway", test).inputs["current_A"]
    assert np.ptp(test.inputs["current_A"]) > 0.0
    np.testing.assert_array_equal(kept[720:1080], test.inputs["current_A"])


def test_no_plan_is_faster_than_the_record():
    """A machine that only stood still may turn as fast as the plan says: nothing tells what it bears."""
    test = driven()[1][0]
    for name, speed in (("spin without current", 1000.0), ("same current at two speeds", 1500.0)):
        for top in (900.0, 1200.0, 3000.0):
            record = replace(test, inputs={**test.inputs, "speed_rpm": np.linspace(0.0, -top, test.time.size)})
            assert planned(name, record).inputs["speed_rpm"].max() == pytest.approx(min(top, speed))
        still = replace(test, inputs={**test.inputs, "speed_rpm": np.zeros(test.time.size)})
        assert planned(name, still).inputs["speed_rpm"].max() == speed


def test_tests_at_one_speed_cannot_tell():
    first, second = raced()[1].fits
    assert abs(deviance_difference(first, second)) < GAP


def test_a_model_reads_what_it_foretells():
    evidence, found = raced()
    test = predicted_readings(found.best, planned("same current at two speeds", evidence.tests[-1]))
    values = {p.name: p.value for p in found.best.network.parameters} | found.best.values
    assert max(np.max(np.abs(s.r)) for s in segments(found.best.network, [test], values)) < 1e-9


def test_the_same_again_decides_nothing():
    evidence, found = raced()
    assert predicted_deviance(evidence, found, [replace(evidence.tests[-1], name="again")], (0, 1)) < GAP


def test_two_speeds_are_said_to_decide():
    evidence, found = raced()
    said = {t.name: t for t in next_tests(evidence, found)}
    assert said["same current at two speeds"].predicted_gain > DECISIVE
    assert said["same current at two speeds"].separates
    assert not said["spin without current"].separates  # at one speed again


def test_driven_it_decides():
    _, found = raced("same current at two speeds")
    right, wrong = found.fits
    assert deviance_difference(wrong, right) > GAP


def test_a_rival_that_runs_away_in_a_planned_test_keeps_what_tangents_promise(monkeypatch):
    """A diagnosis does not end there: the plan is told by its tangents."""

    def run_away(*_):
        raise NoSolution("more heat than its links carry away")

    monkeypatch.setattr(rivals, "predicted_deviance", run_away)
    plan = rivals.Plan("longer", 2.0, [], {(0, 1): 3.0 * GAP})
    (told,) = rivals.refitted_gains(None, None, [plan])
    assert told.gain == 3.0 * GAP
