"""Round ends and marks for any range."""

import pytest

from viz.colours import decimals, marks, rounded


@pytest.mark.parametrize("span", [(14.2, 71.9), (0.5, 60.4), (-3.0, 3.0), (25.0, 25.0), (0.0, 299.0), (-0.04, 0.07)])
def test_ends_are_round_hold_the_range_and_stay(span):
    low, high = rounded(*span)
    assert low <= span[0] <= span[1] <= high
    assert rounded(low, high) == (low, high)
    at = marks(low, high)
    assert (at[0], at[-1]) == (low, high)
    assert 2 <= len(at) <= 11
    assert all(round(x, decimals(low, high)) == pytest.approx(x, abs=1e-9) for x in at)


def test_a_known_range():
    """The ends are those of the data, not 0 and 100 for 12 to 92 degC; what would touch them is left out."""
    assert marks(*rounded(14.2, 71.9)) == [14.0, 20.0, 30.0, 40.0, 50.0, 60.0, 72.0]
    assert rounded(12.0, 92.0) == (12.0, 92.0)


def test_a_range_even_about_zero_stays_even():
    low, high = rounded(-2.3, 2.3)
    assert low == -high
