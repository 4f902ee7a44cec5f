"""Our cubic spline against SciPy's."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

from measured.sensors.operators import through


@pytest.mark.parametrize("n", [2, 3, 4, 5, 50])
@pytest.mark.parametrize("shape", [(), (3,), (2, 4)])
def test_is_the_spline_of_scipy(n, shape):
    """Uneven times, any number of columns, between the points, at them and a little beyond the ends."""
    rng = np.random.default_rng(n)
    time, y = np.cumsum(rng.uniform(0.5, 2.0, n)), rng.standard_normal((n, *shape))
    at = np.sort(np.concatenate([time, rng.uniform(time[0] - 0.3, time[-1] + 0.3, 40)]))
    expected = make_interp_spline(time, y, min(3, n - 1))(at)
    np.testing.assert_allclose(through(time, y, at), expected, rtol=1e-9, atol=1e-11)


def test_a_cubic_is_itself():
    time = np.array([0.0, 1.0, 1.5, 4.0, 7.0, 7.5])
    at = np.linspace(-0.5, 8.0, 30)
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 0.25])
    np.testing.assert_allclose(through(time, cubic(time), at), cubic(at), rtol=1e-11, atol=1e-11)
