"""An interval of an amplitude holds what the refit leaves open and what the effect's own law gets wrong."""

import pytest

from geom.constants import NORMAL_95
from measured.doubt import TABLE
from validation.effects.registry import kinds
from validation.inference.say import interval


def test_what_is_exact_is_as_wide_as_the_refit_says():
    low, high = interval(10.0, 2.0)
    assert (high - low) / 2.0 == pytest.approx(NORMAL_95 * 2.0)
    assert (low + high) / 2.0 == pytest.approx(10.0)


def test_scatter_of_a_correlation_adds_in_squares():
    plain, wide = interval(10.0, 2.0), interval(10.0, 2.0, 0.15)
    added = (wide[1] - 10.0) ** 2 - (plain[1] - 10.0) ** 2
    assert added == pytest.approx((NORMAL_95 * 0.15 * 10.0) ** 2)


def test_what_is_not_there_has_no_scatter():
    assert interval(0.0, 2.0, TABLE["law"].sd) == interval(0.0, 2.0)


@pytest.mark.parametrize(
    ("kind", "empirical"),
    [
        ("convection", True),
        ("windage", True),
        ("iron", True),
        ("conduction.bench", False),
        ("contact", False),
        ("copper.feedback", False),
        ("sensor.gain", False),
        ("loss.factor", False),
    ],
)
def test_films_and_losses_follow_correlations_and_conduction_does_not(kind, empirical):
    assert kinds()[kind].empirical is empirical
