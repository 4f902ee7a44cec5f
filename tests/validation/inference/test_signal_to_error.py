"""An effect is held against the error budget sensor by sensor."""

import numpy as np
import pytest

from lumped.condensation.error_budget import ErrorBudget, PlaceError
from validation.inference.decide import signal_to_error

BUDGET = ErrorBudget((PlaceError("winding", 1.0, 0.4, 0.1), PlaceError("flange", 0.1, None, None)))


def test_the_parts_of_a_budget_add_up_and_unknown_ones_count_nothing():
    assert BUDGET.total_K == pytest.approx({"winding": 1.5, "flange": 0.1})


def test_the_sensor_that_tells_most_decides_not_the_one_that_changes_most():
    found = signal_to_error({"winding": np.array([0.0, -1.2]), "flange": np.array([np.nan, 0.3])}, BUDGET.total_K)
    assert (found.sensor, found.above_budget) == ("flange", True)
    assert found.change_K == pytest.approx(0.3)


def test_an_effect_below_the_budget_everywhere_is_not_above_it():
    found = signal_to_error({"winding": 1.4, "flange": 0.05}, BUDGET.total_K)
    assert not found.above_budget
    assert found.sensor == "winding"


@pytest.mark.parametrize("change", [{}, {"winding": 0.0}, {"other": np.zeros(3)}])
def test_no_change_is_never_above_the_budget(change):
    assert not signal_to_error(change, BUDGET.total_K).above_budget


def test_a_sensor_without_budget_sees_any_change():
    assert signal_to_error({"other": 0.01}, BUDGET.total_K).above_budget


def test_the_worst_run_of_each_place_is_kept():
    other = ErrorBudget((PlaceError("winding", 0.5, 0.4, 0.2), PlaceError("flange", 0.3, None, None)))
    assert ErrorBudget.worst([BUDGET, other]).total_K == pytest.approx({"winding": 1.5, "flange": 0.3})
