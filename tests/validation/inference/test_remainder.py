"""What is told of the readings that stay off with the best explanation in the model."""

from dataclasses import replace

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


def test_a_sensor_that_stays_off_is_told_first_with_its_error_and_no_more_excused_than_there_is():
    """A hidden wind; one thermometer also reads some kelvin more in the middle of every test, as no effect does."""
    case = Truth(10, wind("flange.right", 12.0)).case()
    row = diagnose(replace(case, tests=tuple(map(burst, case.tests))), plan=False).remainder[0]
    assert row.channel == "yoke"
    assert 0.0 <= row.model_K <= row.error_K
    assert 1.0 < row.error_K < BURST_K
    assert f"{row.error_K:.1f} K" in row.words
