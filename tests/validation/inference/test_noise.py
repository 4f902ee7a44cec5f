"""The noise model recovers known processes, and its whitener whitens."""

import numpy as np
import pytest

from validation.comparison.linearisation import Segment
from validation.noise import GRID, fit_noise

TIME = np.arange(0.0, 3600.0, 20.0)


def drawn(shape, scale, seeds):
    L = np.linalg.cholesky(shape.matrix(TIME))
    return [scale * L @ np.random.default_rng(s).standard_normal(TIME.size) for s in seeds]


def parts(series):
    return [Segment(f"t{i}", "a", TIME, r, np.zeros((TIME.size, 0)), 0.5) for i, r in enumerate(series)]


@pytest.mark.parametrize("index", [0, 40, len(GRID) - 1])
def test_whitened_residual_is_white(index):
    """Mean square 1 within 4 standard errors of 8 series, and no correlation of neighbours."""
    own = parts(drawn(GRID[index], 0.2, range(8)))
    noise = fit_noise(own)
    white = np.concatenate([noise.whiten(s, s.r[:, None])[:, 0] for s in own])
    n = white.size
    assert np.mean(white**2) == pytest.approx(1.0, abs=4 * np.sqrt(2 / n))
    assert abs(np.mean(white[1:] * white[:-1])) < 4 / np.sqrt(n)


def test_white_noise_is_not_taken_for_slow_error():
    noise = fit_noise(parts(drawn(GRID[0], 0.3, range(6))))
    level = noise.at(parts([np.zeros(TIME.size)])[0])
    assert np.hypot(level.white, np.hypot(level.fast, level.slow)) == pytest.approx(0.3, rel=0.1)
