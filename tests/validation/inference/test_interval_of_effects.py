"""An interval of an amplitude holds what the refit leaves open and what the effect's own law gets wrong."""

from math import log, sqrt

import pytest

from geom.constants import NORMAL_95
from validation.effects.registry import kinds
from validation.inference.result import Candidate
from validation.inference.say import impossible_words, interval


def test_what_is_exact_is_as_wide_as_the_refit_says():
    low, high = interval(10.0, 2.0)
    assert (high - low) / 2.0 == pytest.approx(NORMAL_95 * 2.0)
    assert (low + high) / 2.0 == pytest.approx(10.0)


def test_scatter_of_a_correlation_adds_in_squares():
    plain, wide = interval(10.0, 2.0), interval(10.0, 2.0, 0.15)
    added = (wide[1] - 10.0) ** 2 - (plain[1] - 10.0) ** 2
    assert added == pytest.approx((NORMAL_95 * 0.15 * 10.0) ** 2)


@pytest.mark.parametrize(
    ("kind", "value", "half", "told"),
    [
        ("copper.feedback", 0.0077, 0.0010, True),
        ("copper.feedback", 0.0077, 0.0040, False),  # copper's 0.0039 is within it
        ("copper.feedback", 0.0039, 0.0001, False),
        ("convection", 400.0, 1.0, False),  # a film is not a property of a material
    ],
)
def test_a_size_that_no_material_has_is_told(kind, value, half, told):
    row = Candidate(f"{kind}@x", 50.0, 6.0, value, "1/K", (value - half, value + half), "named")
    assert bool(impossible_words(kinds()[kind]("x"), row)) is told


def test_what_is_probably_there_is_no_nothing():
    """A size that a wide law leaves at a third of itself from zero, and odds of twenty to one that it is there."""
    low, high = interval(3.0, 3.0, probability=0.95)
    assert low == pytest.approx(3.0 - 1.96 * 3.0 / sqrt(2.0 * log(19.0)), rel=1e-3)
    assert 0.0 < low < 3.0
    assert high == interval(3.0, 3.0)[1]
    assert interval(-3.0, 3.0, probability=0.95) == (-high, -low)
    assert interval(3.0, 3.0, probability=0.3) == interval(3.0, 3.0)
