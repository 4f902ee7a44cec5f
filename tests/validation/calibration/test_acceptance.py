"""The checks of an added effect: each passes where it should and fails where it must."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from one_body import LOSS, measured, one_node
from playground import Truth, wind

from lumped.model.network import Parameter
from measured.case import AddedEffect
from validation.calibration.calibrate import minimise
from validation.comparison.linearisation import segments
from validation.effects import effect
from validation.parameters.unknowns import Unknowns
from validation.revision.acceptance import checks, predicted_without
from validation.revision.revise import staged_fit, start

BIAS = Parameter(
    "bias of body", (("bias:body", 1.0),), value=0.0, low=-9, high=9, prior_sd=0.3, mapping="offset", neutral=0.0
)
RIGHT = "convection@flange.right"


@cache
def case():
    return Truth(10, wind("flange.right", 12.0)).case()


@cache
def checked(name):
    """Checks of one effect, by name."""
    one = effect(name)
    grown = replace(case(), model=replace(case().model, effects=(AddedEffect(one.kind, one.place),)))
    (fit,) = staged_fit(grown, grown.usable, start(grown))
    return fit, {c.check: c for c in checks(fit, name)}


def test_the_true_effect_passes_all():
    _, found = checked(RIGHT)
    assert {"bounds", "left out"} == set(found)
    assert all(c.passed for c in found.values()), found


def test_leaving_a_test_out_agrees_with_fitting_without_it():
    """A linear model: the deviance of each test as predicted by fits to the other, with and without the effect."""
    tests = [measured("one", shift=0.8), measured("two", shift=-0.3)]
    network = one_node(LOSS, BIAS)
    fit = minimise(network, tests, Unknowns((BIAS, LOSS)), np.zeros(2))
    found = predicted_without(fit, 1)
    for test in tests:
        others = [t for t in tests if t is not test]
        deviance = []
        for free in ((BIAS,), (BIAS, LOSS)):
            alone = minimise(network, others, Unknowns(free), np.zeros(len(free)), fit.noise)
            left = segments(network, [test], alone.values)
            deviance.append(sum(float(np.sum(fit.noise.whiten(s, s.r[:, None]) ** 2)) for s in left))
        assert found[test.name] == pytest.approx(deviance[0] - deviance[1], rel=1e-3, abs=1e-6)


def test_an_amplitude_at_its_bound_fails():
    fit, _ = checked(RIGHT)
    k = fit.unknowns.names.index(RIGHT)
    low = fit.unknowns.bounds[0]
    theta = np.array(fit.theta)
    theta[k] = low[k]
    stuck = {c.check: c for c in checks(replace(fit, theta=theta), RIGHT)}
    assert not stuck["bounds"].passed


@pytest.mark.parametrize(("loss", "better"), [(1.3, True), (0.7, False)])
def test_what_one_test_says_has_to_hold_in_the_other(loss, better):
    """30 % more loss in both tests, or 30 % more in one and 30 % less in the other; 25 K of rise, read to 0.3 K."""
    tests = [measured("one", loss=1.3), measured("two", loss=loss)]
    fit = minimise(one_node(LOSS, BIAS), tests, Unknowns((BIAS, LOSS)), np.zeros(2))
    assert {c.check: c.passed for c in checks(fit, "loss")}["left out"] == better
