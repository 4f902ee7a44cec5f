"""Temperatures from resistance and back-EMF: the published uncertainties, and three ways to state one."""

import numpy as np
import pytest
from hypothesis import given, strategies as st

from geom.errors import InputError
from measured.electrical.meters import OHMMETER, VOLTMETER, Meter, Range
from measured.electrical.propagation import Reading, propagate
from measured.electrical.readings import COPPER, NDFEB, Magnets, Saturation, Winding, magnet_rise, winding_rise

RISE = 80.0


def hot(R0, rise=RISE):
    return R0 * (1 + COPPER.value * rise)


def test_winding_is_known_to_4_kelvin_near_half_an_ohm():
    """Published: up to +-4 K of the meter at 80 K, worst case, near R0 = 0.5 ohm."""
    found = Winding(0.5, 20.0, OHMMETER).rise(hot(0.5))
    assert found.value == pytest.approx(RISE, abs=1e-9)
    low, high = found.worst
    assert high - RISE == pytest.approx(4.0, abs=0.3)
    assert RISE - low == pytest.approx(4.0, abs=0.3)


def test_coefficient_of_copper_is_no_major_problem():
    budget = Winding(0.5, 20.0, OHMMETER).rise(hot(0.5)).budget
    assert budget["beta"] < 0.1 * max(budget["resistance"], budget["cold resistance"])


def test_magnets_are_known_to_8_and_7_kelvin():
    """Published: 8 K from the meter and 7 K from alpha's range, at 80 K; the meter's share holds near 290 V."""
    cold = 290.0
    warm = cold * (1 + NDFEB.value * RISE)
    meter = (VOLTMETER.reading("cold", cold), VOLTMETER.reading("warm", warm))
    by_meter = propagate(lambda E0, E: magnet_rise(E, E0, NDFEB.value), meter).worst
    assert by_meter[1] - RISE == pytest.approx(8.0, abs=0.3)
    by_alpha = propagate(lambda a: magnet_rise(warm, cold, a), (NDFEB,)).worst
    assert by_alpha[1] - by_alpha[0] == pytest.approx(7.6, abs=0.1)
    at_low_alpha = magnet_rise(cold * (1 - 0.1e-2 * RISE), cold, -0.11e-2)
    assert at_low_alpha == pytest.approx(RISE - 7.0, abs=0.5)


@given(st.floats(0.4, 3.9), st.floats(5.0, 120.0))
def test_three_uncertainties_are_consistent(R0, rise):
    """The worst case holds the drawn interval, and first order and draws agree on so weak a curvature."""
    found = Winding(R0, 20.0, OHMMETER if hot(R0, rise) <= 4.0 else WIDE).rise(hot(R0, rise))
    assert found.worst[0] < found.interval[0] < found.value < found.interval[1] < found.worst[1]
    assert found.monte_carlo_sd == pytest.approx(found.sd, rel=0.03)
    assert np.hypot.reduce(list(found.budget.values())) == pytest.approx(found.sd, rel=1e-6)


WIDE = Meter("wide", "ohm", (Range(0.1, 40.0, 0.25, 2e-3, 2e-3),))


def test_uncertainty_of_a_sum_is_the_closed_form():
    """Two even errors of half-width 1 add to a triangle: sd sqrt(2/3), worst case +-2, 95 % at 2 - 2 sqrt(0.05)."""
    found = propagate(lambda a, b: a + b, (Reading("a", 1.0, 1.0), Reading("b", 2.0, 1.0)), draws=200_000)
    assert found.sd == pytest.approx(np.sqrt(2 / 3))
    assert found.worst == (1.0, 5.0)
    assert found.interval[1] == pytest.approx(3 + 2 - 2 * np.sqrt(0.05), abs=0.01)


def test_wrong_range_is_refused():
    with pytest.raises(InputError, match=r"range up to 40 ohm, resolution 0\.02"):
        OHMMETER.chosen(0.5, 40.0, "cold")
    assert OHMMETER.chosen(0.5, 4.0, "cold").resolution == 2e-3
    assert [OHMMETER.chosen(ohm, None, "cold").high for ohm in (0.5, 5.0)] == [4.0, 40.0]
    with pytest.raises(InputError, match="outside the ranges"):
        OHMMETER.range_for(0.1)
    with pytest.raises(InputError, match="no range up to 7"):
        OHMMETER.chosen(0.5, 7.0, "cold")
    with pytest.raises(InputError, match="ends below it"):
        OHMMETER.chosen(5.0, 4.0, "hot")


def test_scatter_of_single_readings_is_that_of_the_meters_steps():
    """2 mohm, evenly spread, over R0 beta."""
    assert Winding(0.5, 20.0, OHMMETER).reading_sd(0.6) == pytest.approx(2e-3 / np.sqrt(12.0) / (0.5 * COPPER.value))


def test_iec_constant_at_another_cold_temperature():
    """beta at 20 degC, cold reading at 30 degC: T = (R/R0)(T0 + K) - K with K = 1/beta - 20."""
    winding = Winding(0.5, 30.0, OHMMETER, COPPER, reference_C=20.0)
    K = 1 / COPPER.value - 20.0
    assert winding.temperature(0.65) == pytest.approx(0.65 / 0.5 * (30.0 + K) - K)


def test_saturation_curve():
    """A curve that is a line changes nothing; one that saturates makes the same fall of EMF a greater fall of B_r."""
    line = Saturation((200.0, 300.0), (0.8, 1.2))
    assert magnet_rise(270.0, 290.0, -1e-3, line) == pytest.approx(magnet_rise(270.0, 290.0, -1e-3))
    bent = Saturation((200.0, 250.0, 280.0, 300.0), (0.8, 1.0, 1.14, 1.28))
    assert magnet_rise(270.0, 290.0, -1e-3, bent) > magnet_rise(270.0, 290.0, -1e-3) + 5.0
    with pytest.raises(InputError, match="outside the saturation curve"):
        magnet_rise(310.0, 290.0, -1e-3, bent)
    with pytest.raises(InputError, match="two rising lists"):
        Saturation((200.0, 190.0), (0.8, 1.2))


def test_back_emf_at_another_speed():
    """Back-EMF is proportional to speed, and so is the limit of error it is known with."""
    magnets = Magnets(290.0, 21.0, 383.0, VOLTMETER)
    slow = magnets.temperature(290.0 * 0.92 * 200 / 383, 200.0)
    assert slow == pytest.approx(magnets.temperature(290.0 * 0.92, 383.0))
    assert magnets.rise(290 * 0.92 * 200 / 383, 200.0).sd > magnets.rise(290 * 0.92, 383.0).sd


def test_arrays_and_numbers_alike():
    R = np.array([0.5, 0.6])
    assert winding_rise(R, 0.5, 0.004)[1] == winding_rise(0.6, 0.5, 0.004) == pytest.approx(50.0)
