"""The checks of an added effect: each passes where it should and fails where it must."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from one_body import LOSS, measured, one_node
from playground import Truth, wind
from validation.evidence import calibrated_case, diagnosing, scored
from validation.gates import gates, left_out

from lumped.network import Parameter
from validation.calibrate import minimise, square_of
from validation.case import AddedEffect
from validation.effects import effect
from validation.fitting import Unknowns
from validation.revise import fitted, start
from validation.score import gram
from validation.sheet import segments

BIAS = Parameter("bias of body", (("bias:body", 1.0),), value=0.0, low=-9, high=9, prior_sd=0.3, mapping="offset",
                 neutral=0.0)  # fmt: skip
RIGHT = "convection@flange.right"


@cache
def case():
    return Truth(10, wind("flange.right", 12.0)).case()


@cache
def checked(name):
    """Gates of one effect, by gate."""
    one = effect(name)
    grown = replace(case(), model=replace(case().model, effects=(AddedEffect(one.kind, one.place),)))
    (fit,) = fitted(grown, diagnosing(grown), start(grown))
    return fit, {g.gate: g for g in gates(fit, name)}


def test_the_true_effect_passes_all():
    _, found = checked(RIGHT)
    assert {"bounds", "constancy", "left out", "relevance"} == set(found)
    assert all(g.passed for g in found.values()), found


def test_leaving_a_test_out_agrees_with_fitting_without_it():
    """A linear model: the deviance of each test as predicted by fits to the other, with and without the effect."""
    tests = [measured("one", shift=0.8), measured("two", shift=-0.3)]
    network = one_node(LOSS, BIAS)
    fit = minimise(network, tests, Unknowns((BIAS, LOSS)), np.zeros(2))
    found = left_out(fit, 1, gram(fit.parts, fit.noise, 1))
    for test in tests:
        others = [t for t in tests if t is not test]
        deviance = []
        for free in ((BIAS,), (BIAS, LOSS)):
            alone = minimise(network, others, Unknowns(free), np.zeros(len(free)), fit.noise)
            deviance.append(square_of(segments(network, [test], alone.values), fit.noise))
        assert found[test.name] == pytest.approx(deviance[0] - deviance[1], rel=1e-3, abs=1e-6)


def test_an_amplitude_at_its_bound_fails():
    fit, _ = checked(RIGHT)
    k = fit.unknowns.names.index(RIGHT)
    low = fit.unknowns.bounds[0]
    theta = np.array(fit.theta)
    theta[k] = low[k]
    stuck = {g.gate: g for g in gates(replace(fit, theta=theta), RIGHT)}
    assert not stuck["bounds"].passed
    assert not stuck["relevance"].passed


@pytest.mark.parametrize(("loss", "same"), [(1.3, True), (0.9, False)])
def test_one_amplitude_has_to_do_for_all_tests(loss, same):
    """30 % more loss in both tests, or 30 % more in one and 10 % less in the other; 25 K of rise, read to 0.3 K."""
    tests = [measured("one", loss=1.3), measured("two", loss=loss)]
    fit = minimise(one_node(LOSS, BIAS), tests, Unknowns((BIAS, LOSS)), np.zeros(2))
    assert {g.gate: g.passed for g in gates(fit, "loss")}["constancy"] == same


def test_what_matters_is_what_moves_a_reading_by_a_kelvin():
    """The wind does; a hundredth of it does not."""
    now = case()
    evidence = scored(now, [effect(RIGHT)], calibrated_case(now))
    assert evidence.matters.tolist() == [True]
    small = replace(evidence, score=replace(evidence.score, u=0.01 * evidence.score.u))
    assert small.matters.tolist() == [False]
