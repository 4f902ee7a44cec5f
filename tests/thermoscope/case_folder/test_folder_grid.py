"""Averages onto the analysis grid, checked against sums by hand and conserved integrals."""

import numpy as np
import pytest

from geom.errors import InputError
from measured.recordings.grid import averaged, bridged, rms


def test_mean_of_what_lies_around_each_instant():
    """A ramp is read at the instant itself: readings halfway between two instants count half for each."""
    time = np.arange(0.0, 41.0)
    grid = np.array([0.0, 10.0, 20.0, 30.0, 40.0])
    mean = averaged(time, time, grid)
    assert mean[0] == pytest.approx((0 + 1 + 2 + 3 + 4 + 0.5 * 5) / 5.5)
    assert mean[1:4] == pytest.approx([10.0, 20.0, 30.0])


def test_alternating_current_keeps_its_heat():
    """The mean of a square wave of +-10 A is nothing; its heat is that of 10 A."""
    time = np.arange(0.0, 100.0)
    current = np.where(time.astype(int) % 2, 10.0, -10.0)
    assert np.abs(rms(time, current, np.arange(0.0, 91.0, 10.0))) == pytest.approx(10.0)


def test_anti_alias():
    """A ripple far above the grid's own frequency leaves less than a tenth of itself."""
    time = np.arange(0.0, 2000.0)
    ripple = np.sin(2 * np.pi * time / 7.0)
    seen = averaged(time, ripple, np.arange(0.0, 1980.0, 60.0))
    assert np.max(np.abs(seen[1:])) < 0.1


def test_empty_cells_stay_empty():
    time = np.concatenate([np.arange(0.0, 30.0), np.arange(60.0, 100.0)])
    mean = averaged(time, np.ones_like(time), np.arange(0.0, 100.0, 10.0))
    assert np.isnan(mean[4:6]).all()
    assert np.isfinite(np.delete(mean, [4, 5])).all()


def test_short_hole_is_a_straight_line_and_a_long_one_is_refused():
    grid = np.arange(0.0, 100.0, 10.0)
    values = np.where((grid > 30) & (grid < 60), np.nan, grid)
    assert bridged(grid, values, 60.0, "here") == pytest.approx(grid)
    with pytest.raises(InputError, match="from 30 s to 60 s"):
        bridged(grid, values, 20.0, "here")
