"""The observer who sets sizes and twins: its answers are the machine's, its noise is white."""

from dataclasses import replace

import numpy as np
import pytest
from hidden.kinds import KINDS
from hidden.truth.archetype import measured, truly
from hidden.truth.change import NOTHING, Change, for_a_while, only_in
from hidden.truth.draw import Draw
from hidden.truth.effects import draught, heating
from hidden.truth.oracle import CORRELATED_S, EVERY_S, MODEL_K, Seen, course, seen, unlike, whitened
from hidden.truth.profile import fine_times

SERVO = KINDS["servo"]
SHORT = replace(SERVO, plans=(replace(SERVO.plans[0], minutes=20.0), replace(SERVO.plans[2], minutes=20.0)))


def test_whitening_is_the_inverse_of_the_covariance():
    """W^T W of noise with exp(-|dt| / 10 min): the inverse matrix."""
    lag = np.abs(np.subtract.outer(np.arange(12), np.arange(12))) * EVERY_S
    W = whitened(np.eye(12)[:, None, :])
    np.testing.assert_allclose(W.T @ W, np.linalg.inv(MODEL_K**2 * np.exp(-lag / CORRELATED_S)), atol=1e-9)


def test_answers_are_differences_of_two_runs():
    """A little heat in the case; the machine run twice on the fine grid. Implicit Euler of a minute is good to 4 %."""
    plan, change = SHORT.plans[1], heating("case", 0.05)
    one = course(SHORT, plan, 3)
    at, _, driving = truly(SHORT, plan, 3, NOTHING)
    fine = fine_times(at, SHORT.logger.fine)
    start = np.full(one.machine.skeleton.C.size, driving["T_ambient"][0])
    still, moved = (SHORT.build(Draw(3), c).run(fine, driving, start) for c in (NOTHING, change))
    true = (moved - still)[:: round(EVERY_S / SHORT.logger.fine)][:, one.cells]
    answered = one.answer(one.added(change)[:, :, None])[:, :, 0]
    np.testing.assert_allclose(answered[-1], true[-1], rtol=0.04)


def test_what_calibration_moves_is_absorbed_and_other_things_are_not():
    """A joint of the drawing made better leaves little; a draught that no parameter describes is seen."""
    joint, wind = ("joint",), ("draught",)
    answers = seen(SHORT, 3, {joint: Change({"enamel": 1.1}), wind: draught("case", 0.1)}, ("calibrate",))
    V, raw = answers.left(), answers.E.T @ answers.E
    assert V[0, 0] < 0.15 * raw[0, 0]
    assert V[1, 1] / raw[1, 1] > V[0, 0] / raw[0, 0]


def test_an_explanation_of_the_wrong_sign_explains_nothing():
    V = np.array([[4.0, -2.0, 2.0], [-2.0, 1.0, 0.0], [2.0, 0.0, 1.0]])
    assert unlike(V, 0, 1) == 1.0
    assert unlike(V, 0, 2) == pytest.approx(0.0)


def test_in_one_test_alone_only_its_rows_count():
    E, J = np.arange(1.0, 5.0)[:, None], np.zeros((4, 1))
    answers = Seen((("a",),), J, E, {"one": slice(0, 2), "two": slice(2, 4)})
    assert answers.left()[0, 0] == pytest.approx(30.0)
    assert answers.left("two")[0, 0] == pytest.approx(25.0)


def test_a_condition_moves_its_test_alone_and_not_before_it_begins():
    names = [p.name for p in SHORT.plans]
    hot = heating("case", 5.0)
    changes = NOTHING, only_in(names[1], hot), for_a_while(names[1], hot, 600.0, 900.0)
    still, lasting, passing = (measured(SHORT, 5, c) for c in changes)
    for changed in (lasting, passing):
        np.testing.assert_array_equal(changed[0].readings["case"], still[0].readings["case"])
    moved = [c[1].readings["case"] - still[1].readings["case"] for c in (lasting, passing)]
    early, late = still[1].time < 590.0, still[1].time > 700.0
    assert np.nanmax(np.abs(moved[1][early])) == 0.0
    assert np.nanmin(moved[0][late]) > np.nanmin(moved[1][late]) > 0.3
