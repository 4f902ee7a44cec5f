"""The network of the 100 kW motor, derived from its field: balances, limits, and the field itself as reference."""

import numpy as np
import pytest

from geom import load_machine
from geom.errors import InputError
from lumped.build.crosscheck import crosscheck, steady_state
from lumped.build.pipeline import build
from lumped.condensation.reduction import Recipe
from lumped.machine.settings import Losses, contact_coefficients, read
from lumped.transfer.terms_value import coefficient

POINT = {"current_A": 200.0, "speed_rpm": 1000.0, "fan_flow_m3h": 138.0}


@pytest.fixture(scope="module", params=[pytest.param("series-dc-100kw", marks=pytest.mark.heavy)])
def motor(request):
    return build(load_machine(request.param), 0.1, 36, Recipe(tolerance=0.03))


def test_network_agrees_with_its_field(motor):
    """Same mesh, same coefficients: means within 0.5 % and hot spots within 3 % of the part's own rise."""
    check = crosscheck(motor.field, motor.network, POINT)
    assert check.energy_balance < 1e-9
    assert check.worst.percent_of_rise < 3.0, check.worst
    mean_error = [abs(p.network_mean_C - p.fem_mean_C) / (p.fem_mean_C - 20.0) for p in check.parts]
    assert max(mean_error) < 0.005


def test_the_fan_takes_up_44_watts_per_kelvin(motor):
    """138 m3/h of an ideal gas, p / (R T), at 1 atm; the published 44 W/K lie between those of 20 and of 40 degC."""
    stream = next(link for link in motor.network.links if link.name == "stream:fan:air.left")
    rates = []
    for air_C in (20.0, 40.0):
        rate = coefficient(stream.law, {"fan_flow_m3h": np.array(138.0)}, air_C, 0.0) * stream.vals.max()
        density = 101_325.0 / (287.05 * (air_C + 273.15))
        assert rate == pytest.approx(density * 1006.5 * 138.0 / 3600.0, rel=5e-3)
        rates.append(rate)
    assert rates[1] < 44.0 < rates[0]


def test_a_point_beside_a_surface_reads_the_surface(motor):
    """A millimetre off the middle of an outer facet whose corners are further away than a reading may be moved."""
    network = motor.network
    shape, x = network.recovery.parts["yoke"], steady_state(network, POINT, 20.0)[: len(network.states)]
    facets = shape.xyz[shape.tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]]].reshape(-1, 3, 3)
    middle = facets.mean(axis=1)
    far = np.linalg.norm(facets - middle[:, None], axis=2).min(axis=1) > 0.005
    there = middle[far][np.argmax(np.hypot(*middle[far, :2].T))]
    beside = there + 0.001 * np.array([*(there[:2] / np.hypot(*there[:2])), 0.0])
    at, off = (network.recovery.row("yoke", xyz) for xyz in (there, beside))
    rise = np.ptp(network.recovery.of_part("yoke", x))
    assert off.weights @ x[off.index] == pytest.approx(at.weights @ x[at.index], abs=0.05 * rise)


def test_unknown_loss_is_refused_with_a_suggestion():
    with pytest.raises(InputError, match=r"unknown key 'windage'.*did you mean 'windage_W'"):
        read(Losses, {"windage": 3.0}, "motor [losses]")


@pytest.mark.parametrize("entry", [{"gap_mm": 0.0}, {"gap": 0.1}])
def test_a_contact_needs_a_positive_gap_or_coefficient(entry):
    with pytest.raises(InputError, match=r"is not a contact.*gap_mm"):
        contact_coefficients({"a|b": entry}, ["a|b"], "motor [contacts]")
