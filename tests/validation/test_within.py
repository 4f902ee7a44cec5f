"""One sign, one rms, one rule: the same in the comparison, in the dots, in the curves."""

from dataclasses import replace

import numpy as np
import pytest
from one_body import measured

from validation.comparison.compare import channel_error
from validation.comparison.tolerance import limit_K, rise_K
from viz.colours import LIGHT, VERMILION
from viz.data import Comparison, sensors
from viz.figures.curves import wrongness


def channel(sigma):
    one = measured().channels[0]
    return replace(one, y=np.linspace(20.0, 60.0, len(one.y)), sigma_K=sigma)


@pytest.mark.parametrize(("sigma", "limit"), [(0.5, 1.6), (2.0, 4.0)])
def test_two_sigma_or_four_percent_of_the_rise(sigma, limit):
    """40 K of rise: 4 % are 1.6 K; two sigma of 2 K are 4 K."""
    one = channel(sigma)
    assert rise_K(one) == pytest.approx(40.0)
    assert limit_K(one) == pytest.approx(limit)


@pytest.mark.parametrize("off", [-3.0, -1.5, 1.5, 3.0])
def test_table_dot_and_curve_say_the_same(off):
    one = channel(0.5)
    test = replace(measured(), channels=(one,))
    model = {one.name: one.y - off}
    row = channel_error(one, model[one.name])
    comparison = Comparison(test, model)
    (dot,) = sensors(comparison, {one.name: (0.0, 0.0, 0.0)})
    assert row.bias_K == pytest.approx(off), "measured - model: positive where the machine is hotter"
    assert dot.residual_K == pytest.approx(off)
    assert comparison.rmse(one) == pytest.approx(row.rmse_K)
    assert (row.verdict == "within") == (dot.verdict == "within") == (abs(off) <= row.limit_K)
    colour = wrongness(comparison.residual(one), row.limit_K)
    assert (colour == LIGHT.faint) == (row.verdict == "within")
    if off > row.limit_K:
        assert dot.verdict == "hot"
        assert colour == VERMILION
