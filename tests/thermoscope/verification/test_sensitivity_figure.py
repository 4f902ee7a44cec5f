"""What one prior deviation of a parameter moves, against a difference of two runs."""

import numpy as np
import pytest

from thermoscope.case_folder.folder import load_case
from validation.calibration.unknowns import to_value, working
from validation.comparison.predict import predict
from viz.live import sensitivity
from viz.live.influence import influence


def test_influence_is_the_difference_of_two_runs(case):
    """A hundredth of a deviation each way: the error of a central difference is of the order 1e-4."""
    opened = load_case(case).case
    test = opened.tests[0]
    chosen, size = influence(opened, test)
    assert len(chosen) >= 4
    network = working(opened)[0]
    for p, row in zip(chosen, size, strict=True):
        up, down = (predict(network, test, {p.name: to_value(p, s * 0.01 * p.prior_sd)}).y for s in (1.0, -1.0))
        expected = np.sqrt(np.mean(((up - down) / 0.02) ** 2, axis=0))
        assert row == pytest.approx(expected, rel=5e-3, abs=1e-4)


def test_the_largest_influence_comes_first(case):
    opened = load_case(case).case
    z = np.array(sensitivity(opened, opened.tests[0]).data[0].z, float)
    assert (np.diff(z.max(axis=1)) <= 1e-12).all()
