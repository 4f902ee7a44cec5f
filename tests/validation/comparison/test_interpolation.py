"""Errors between sensors: closed forms of kriging, and simulated data sets whose truth is known."""

import numpy as np
import pytest

from validation.comparison.interpolation import interpolated


def test_one_doubt_and_one_sensor_is_the_textbook_shrinkage():
    """Rasmussen and Williams, eq. 2.25 for one point: mean k / (k + s^2) r, variance told the same share."""
    found = interpolated(np.array([[2.0], [1.0]]), np.array([[2.0]]), np.array([3.0]), np.array([1.0]))
    assert found.mean == pytest.approx([4 / 5 * 3, 2 / 5 * 3])
    assert found.explained == pytest.approx([4 / 5, 4 / 5])


def test_without_noise_it_passes_through_the_readings():
    rng = np.random.default_rng(0)
    here = rng.normal(size=(3, 8))
    found = interpolated(here, here, np.array([1.0, -2.0, 0.5]), np.full(3, 1e-6))
    assert found.mean == pytest.approx([1.0, -2.0, 0.5], abs=1e-6)
    assert found.explained == pytest.approx(1.0)


def test_what_is_left_has_the_variance_it_says():
    """4000 draws of the doubts: mean squares of the rest within 4 sigma (sqrt(2/4000) = 2.2 %) of (1 - told) prior."""
    rng = np.random.default_rng(1)
    there, here, sigma = rng.normal(size=(5, 6)), rng.normal(size=(3, 6)), np.full(3, 0.3)
    rest = []
    for _ in range(4000):
        d = rng.normal(size=6)
        found = interpolated(there, here, here @ d + sigma * rng.normal(size=3), sigma)
        rest.append(there @ d - found.mean)
    expected = (1 - found.explained) * (there**2).sum(axis=1)
    assert np.mean(np.square(rest), axis=0) == pytest.approx(expected, rel=0.09)
