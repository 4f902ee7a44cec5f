"""A missing loss has its prior on the heat it gives in the tests, whatever its reference."""

from dataclasses import replace

import numpy as np
import pytest
from everything import machine, warm_test

from lumped.model.network import Parameter
from lumped.transfer.laws import InputPower
from validation.comparison.predict import predict
from validation.effects import effect
from validation.effects.build import heat
from validation.parameters.reference import reference_of
from validation.parameters.unknowns import at_level


def at_test(net, names, test):
    """With priors for what a test records."""
    return at_level(net, names, reference_of(net, [test], names))


def with_loss(reference: float):
    net = machine()
    place = next(p.name for p in net.places.values() if p.kind == "node")
    law = InputPower(1.0, (("speed_rpm", reference, 2.0),))
    net = net.extended(sources=[heat(net, "extra", "iron", place, law)])
    extra = Parameter("extra", (("extra", 1.0),), unit=f"W at {reference:g} rpm", prior_sd=5.0, high=200.0)
    return replace(net, parameters=(*net.parameters, extra))


def heat_of_prior(reference: float) -> tuple[float, float]:
    """Mean heat (W) in the test at one prior deviation and at the bound."""
    test = warm_test(machine())
    p = at_test(with_loss(reference), {"extra"}, test).parameters[-1]
    mean = float(np.mean(InputPower(1.0, (("speed_rpm", reference, 2.0),)).factor(test.inputs)))
    return p.prior_sd * mean, p.high * mean


@pytest.mark.parametrize("reference", [100.0, 1000.0, 30000.0])
def test_the_reference_does_not_matter(reference):
    assert heat_of_prior(reference) == pytest.approx((5.0, 200.0))


def test_a_temperature_coefficient_has_one_prior_whatever_the_current():
    """Copper's, 0.00393 1/K, at one deviation, in a winding of one watt as of a thousand."""
    net = effect("copper.feedback@copper.winding.field").extend(machine())
    p = at_test(net, {net.parameters[-1].name}, warm_test(machine())).parameters[-1]
    assert (p.prior_sd, p.high) == pytest.approx((0.00393, 0.0125))


@pytest.mark.parametrize("scale", [0.1, 10.0])
def test_an_input_offset_has_its_prior_on_the_level_of_the_input(scale):
    test = warm_test(machine())
    louder = replace(test, inputs={**test.inputs, "current_A": scale * test.inputs["current_A"]})
    net = effect("input.offset@current_A").extend(machine())
    p = at_test(net, {net.parameters[-1].name}, louder).parameters[-1]
    assert p.unit == "A"
    level = scale * float(np.sqrt(np.mean(test.inputs["current_A"] ** 2)))
    assert (p.prior_sd, p.low, p.high) == pytest.approx((0.05 * level, -0.5 * level, 0.5 * level))


def test_an_input_offset_is_what_the_input_itself_does():
    """A current that is 2 A larger in truth, by the law's own run and by the effect."""
    net, test = machine(), warm_test(machine())
    grown = effect("input.offset@current_A").extend(net)
    more = replace(test, inputs={**test.inputs, "current_A": test.inputs["current_A"] + 2.0})
    told = predict(grown, test, {grown.parameters[-1].name: 2.0}).y
    assert told == pytest.approx(
        predict(net, more, {}).y, abs=0.05 * float(np.ptp(told - predict(net, test, {}).y)) + 1e-6
    )


def test_an_effect_that_finds_nothing_left_to_act_on_is_left_alone():
    """Such as conduction to a bench beside the same for a while: every bed has its link."""
    net = machine()
    bare = replace(net, parameters=(*net.parameters, Parameter("extra", (), unit="W/K", prior_sd=1.0)))
    assert at_test(bare, {"extra"}, warm_test(net)) == bare
