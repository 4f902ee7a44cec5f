"""What is told of the readings that stay off with the best explanation in the model."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from playground import Truth, wind

from validation import diagnose

pytestmark = pytest.mark.heavy

BURST_K = 8.0


def burst(test):
    middle = np.abs(test.time - np.mean(test.time)) < 0.15 * np.ptp(test.time)
    channels = [replace(c, y=c.y + BURST_K * middle) if c.name == "yoke" else c for c in test.channels]
    return replace(test, channels=tuple(channels))


@cache
def found(bursts):
    # A hidden wind; one thermometer also reads some kelvin more in the middle of every test, as no effect does
    case = Truth(10, wind("flange.right", 12.0)).case()
    return diagnose(replace(case, tests=tuple(burst(t) for t in case.tests)) if bursts else case, plan=False)


def test_what_is_explained_leaves_nothing_to_tell():
    assert found(False).remainder == ()


def test_a_sensor_that_stays_off_is_told_first():
    assert found(True).remainder[0].channel == "yoke"


def test_its_error_is_told_and_no_more_of_it_excused_than_there_is():
    row = found(True).remainder[0]
    assert 0.0 <= row.model_K <= row.error_K
    assert 1.0 < row.error_K < BURST_K
    assert f"{row.error_K:.1f} K" in row.words
