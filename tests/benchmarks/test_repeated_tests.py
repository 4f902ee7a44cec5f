"""Pairs of tests that are drawn equal are called equal, and a drift is seen."""

import pytest
from drawn.repeated_tests import DRIFTS, pair


@pytest.mark.parametrize("kind", DRIFTS)
def test_drawn_drifts(kind):
    """Of four pairs: with 5 % false alarms two or more come once in 70 seeds; a drift of five uncertainties is seen."""
    changed = sum(pair(seed, kind).verdict == "changed" for seed in range(4))
    assert changed <= 1 if kind == "nothing" else changed == 4
