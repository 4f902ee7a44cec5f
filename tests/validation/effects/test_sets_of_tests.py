"""What held in some of the tests, with one amplitude in all of them."""

import numpy as np
import pytest
from one_body import measured

from validation.effects import effect
from validation.effects.time_window import event, holds, lasts, odd_tests
from validation.inference.conditions import set_condition, set_score, whole_test_sets
from validation.inference.score import Score


def test_every_set_of_some_but_not_all_tests():
    assert whole_test_sets(3) == [(0,), (1,), (2,), (0, 1), (0, 2), (1, 2)]
    assert whole_test_sets(7) == [(k,) for k in range(7)]  # of so many each stands for itself


def test_one_amplitude_in_several_tests_adds_scores_and_all_covariances():
    """Two effects in three tests: J'r and J'J of the summed column."""
    rng = np.random.default_rng(0)
    J, r = rng.standard_normal((40, 6)), rng.standard_normal(40)
    every = Score(J.T @ r, J.T @ J, np.diag(J.T @ J), np.tile([1, 0], 3), np.zeros(6, int))
    own, seen = set_score(every, 2, (0, 2))
    both = J[:, [0, 1]] + J[:, [4, 5]]
    assert own.u == pytest.approx(both.T @ r)
    assert np.diag(own.V) == pytest.approx(np.sum(both**2, axis=0))
    assert own.sign.tolist() == [1, 0]
    assert seen.all()


def test_what_one_of_the_tests_does_not_show_is_no_candidate():
    every = Score(np.ones(4), np.diag([1.0, 1.0, 1.0, 0.0]), np.ones(4), np.zeros(4, int), np.zeros(4, int))
    assert set_score(every, 2, (0, 1))[1].tolist() == [True, False]


TESTS = [measured(name) for name in ("day", "night", "dawn", "dusk")]


def test_several_whole_tests_are_an_event_that_lasts_all_of_each():
    assert set_condition(TESTS, (0,)) == "day"
    found = event(set_condition(TESTS, (0, 1)))
    assert found is not None
    assert found.spans == {t.name: ((t.time[0], t.time[-1]),) for t in TESTS[:2]}


def test_what_held_in_most_tests_is_told_by_the_others_and_holds_in_one_to_come():
    condition = set_condition(TESTS, (0, 1, 3))
    assert condition == "all but dawn"
    heat = effect(f"loss.constant@core in {condition}")
    assert heat.when == "in all but dawn"
    assert [heat.can_act(t.name) for t in TESTS] == [True, True, False, True]
    unseen = measured("road")
    assert heat.can_act("road")
    assert lasts(condition, unseen)
    assert holds(condition, unseen).tolist() == [1.0] * unseen.time.size
    assert not holds(condition, TESTS[2]).any()
    for name in (condition, "all but dawn & dusk"):
        assert odd_tests(name) == tuple(name.removeprefix("all but ").split(" & "))
