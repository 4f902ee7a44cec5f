"""Smallest detectable sizes: where all is linear, where a conductance saturates, beyond what physics allows."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth
from validation.detectable import Left, Search, followed, readings_with, smallest, smallest_sizes, told
from validation.evidence import calibrated_case, candidates, scored

from validation.calibrate import minimise

LEVEL = 4.0
KINDS = ("convection", "loss.constant", "contact", "convection.constant", "sensor.bias")


@pytest.fixture(scope="module")
def evidence():
    case = Truth(11).case()
    return scored(case, candidates(case, KINDS), calibrated_case(case))


def search(evidence):
    return Search(evidence, np.ones(len(evidence.effects)), LEVEL, small=0.0)


def test_heat_in_a_linear_path_has_the_linear_size(evidence):
    """A constant loss of some watts bends nothing: threshold times deviation, within the accuracy of the search."""
    k = evidence.names.index("loss.constant@housing")
    assert smallest(search(evidence), k) == pytest.approx(LEVEL * evidence.score.sd[k], rel=0.1)


def test_a_conductance_that_saturates_needs_more(evidence):
    """G added to what a body has already: heat G dT / (1 + G R) is less than G dT."""
    k = evidence.names.index("convection.constant@flange.right")
    assert smallest(search(evidence), k) > 1.05 * LEVEL * evidence.score.sd[k]


def test_at_the_size_found_a_calibration_of_its_own_leaves_the_level(evidence):
    """By another way: fresh Jacobians throughout, prior centred by shifting the priors' mean."""
    k = evidence.names.index("convection.constant@flange.right")
    size = smallest(search(evidence), k)
    fit, hidden = evidence.fit, readings_with(evidence, {k: size})
    held = {p.name: p.value for p in fit.network.parameters} | fit.values
    anew = minimise(fit.network, hidden, fit.unknowns, fit.theta, fit.noise, held, centre=fit.theta)
    assert np.sqrt(2.0 * anew.objective) == pytest.approx(LEVEL, rel=0.1)


def test_nothing_hidden_leaves_nothing(evidence):
    assert followed(evidence, 0, 0.0, evidence.fit.theta)[0].deviance == pytest.approx(0.0, abs=1e-6)


def test_more_hidden_leaves_more(evidence):
    k = evidence.names.index("convection@flange.right")
    left = [followed(evidence, k, a, evidence.fit.theta)[0].deviance for a in (0.5, 1.0, 2.0)]
    assert left == sorted(left)


def test_what_physics_does_not_allow_is_never_seen(evidence):
    """A joint can lose its conductance once, not twice; asked for a score that this does not reach."""
    k = evidence.names.index("contact@flange.left|housing")
    most = np.sqrt(followed(evidence, k, 0.98 * abs(evidence.parameters[k].low), evidence.fit.theta)[0].deviance)
    assert smallest(replace(search(evidence), level=2.0 * most), k) == np.inf


def test_sizes_are_kept(evidence, tmp_path):
    few = scored(Truth(11).case(), evidence.effects[:3], evidence.fit)
    first, again = [], []
    sizes = [smallest_sizes(few, np.ones(3), 3.0, 1, tmp_path, told.append) for told in (first, again)]
    np.testing.assert_array_equal(*sizes)
    assert len(first) == 3
    assert not again


def test_what_only_strains_priors_is_not_told():
    """Of a deviance of 100 the readings tell 31: enough. They tell 2: the rest is priors, and sqrt 2 is too little."""
    assert told(Left(100.0, 31.0)) == np.inf
    assert told(Left(100.0, 2.0)) == pytest.approx(2.0**0.5 / (6.0**0.5 + 0.842))
