"""Channels that are plainly broken are told without a model, and those that only rest are left alone."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth

from measured.sensors.faults import broken_channels, fault

N = 200
RISE = 20.0 + 40.0 * (1.0 - np.exp(-np.arange(N) / 60.0))


@pytest.fixture(scope="module")
def bench():
    """A test of four channels that warm up by 40 K with a tenth of a kelvin of noise."""
    test = Truth(12).case().tests[0]
    rng = np.random.default_rng(3)
    own = [replace(c, y=np.round(RISE + 0.1 * rng.standard_normal(N), 1)) for c in test.channels[:4]]
    return replace(test, channels=tuple(own))


def with_first(bench, y):
    return replace(bench, channels=(replace(bench.channels[0], y=y), *bench.channels[1:]))


def stuck(bench, first, last):
    y = bench.channels[0].y.copy()
    y[first : last + 1] = y[first]
    return with_first(bench, y)


def test_nothing_is_wrong_with_a_warm_up(bench):
    assert broken_channels([bench]) == []


@pytest.mark.parametrize(("first", "last"), [(20, 50), (30, 69), (60, 140), (120, 199)])
def test_a_channel_that_stuck_for_a_while_is_told_with_its_readings(bench, first, last):
    """For a sixth of the test and longer; what stuck for less than a quarter is known by the jump that ends it."""
    found = fault(stuck(bench, first, last), stuck(bench, first, last).channels[0])
    assert found is not None
    assert np.flatnonzero(found.bad)[[0, -1]] == pytest.approx([first, min(last + 1, N - 1)], abs=3)


def test_equal_readings_that_averaging_rounds_are_equal(bench):
    y = stuck(bench, 60, 140).channels[0].y + 1e-14 * np.arange(N)
    assert fault(with_first(bench, y), replace(bench.channels[0], y=y)) is not None


def test_a_body_far_off_that_warms_late_is_not_stuck(bench):
    """In steps of 0.1 K it reads the same for 40 instants, and then moves on as it always does."""
    y = np.round(20.0 + 2.0 * np.clip(np.arange(N) - 40, 0, None) / N, 1)
    late = with_first(bench, y)
    assert fault(late, late.channels[0]) is None


def test_while_the_others_rest_a_channel_may_rest(bench):
    """All wait for twenty instants before the load comes, which moves them within two."""
    y = np.where(np.arange(N) < 20, 20.0, RISE + 10.0)
    for all_ in (y, np.full(N, 20.0)):
        rest = replace(bench, channels=tuple(replace(c, y=all_) for c in bench.channels))
        assert broken_channels([rest]) == []
