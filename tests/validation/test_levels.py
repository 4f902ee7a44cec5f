"""A missing loss has its prior on the heat it gives in the tests, whatever its reference."""

from dataclasses import replace

import numpy as np
import pytest
from everything import machine, warm_test

from lumped.model.network import Parameter
from lumped.transfer.laws import InputPower
from validation.calibration.unknowns import at_level
from validation.effects import effect
from validation.effects.build import heat


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
    p = at_level(with_loss(reference), {"extra"}, [test]).parameters[-1]
    mean = float(np.mean(InputPower(1.0, (("speed_rpm", reference, 2.0),)).factor(test.inputs)))
    return p.prior_sd * mean, p.high * mean


@pytest.mark.parametrize("reference", [100.0, 1000.0, 30000.0])
def test_the_reference_does_not_matter(reference):
    assert heat_of_prior(reference) == pytest.approx((5.0, 200.0))


def test_others_are_left_alone():
    net = with_loss(100.0)
    assert at_level(net, set(), [warm_test(machine())]) == net


def test_a_temperature_coefficient_has_one_prior_whatever_the_current():
    """Copper's, 0.00393 1/K, at one deviation, in a winding of one watt as of a thousand."""
    net = effect("copper.feedback@copper.winding.field").extend(machine())
    p = at_level(net, {net.parameters[-1].name}, [warm_test(machine())]).parameters[-1]
    assert (p.prior_sd, p.high) == pytest.approx((0.00393, 0.0125))
