"""What a step must stand up to: each check passes where it should and fails where it must."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from one_body import FILM, LOSS, measured, one_node
from playground import Truth, wind

from lumped.model.network import Parameter
from measured.case import AddedEffect, Case, Model
from validation.calibration.calibrate import minimise, with_model_error
from validation.calibration.staged_fit import fit_stages, measured_in
from validation.comparison.linearisation import segments
from validation.noise import FOLLOWED
from validation.parameters.unknowns import Unknowns, working
from validation.revision.acceptance import (
    FoldPrediction,
    bound_check,
    fold_prediction,
    folds,
    halves,
    middle_instant,
    prediction_checks,
)
from validation.revision.revise import add, calibrate, judge

BIAS = Parameter(
    "bias of body", (("bias:body", 1.0),), value=0.0, low=-9, high=9, prior_sd=0.3, mapping="offset", neutral=0.0
)
RIGHT = "convection@flange.right"


@cache
def added(name):
    return add(Truth(10, wind("flange.right", 12.0)).case(), name)


def test_the_true_effect_passes_all():
    assert added(RIGHT).accepted, added(RIGHT).why
    assert {"bounds", "left out", "no change", "other tests"} == {c.check for c in added(RIGHT).checks}


def test_a_wrong_effect_predicts_no_better():
    done = added("radiation@flange.left")
    (left_out,) = [c for c in done.checks if c.check == "left out"]
    assert not left_out.passed, left_out.words
    assert not done.accepted


def both(tests):
    """The fits of one body with and without a factor on its loss, model error in account."""
    for free in ((BIAS,), (BIAS, LOSS)):
        fit = minimise(one_node(*free), tests, Unknowns(free), np.zeros(len(free)))
        yield with_model_error(fit, tests, fit.values)


@pytest.mark.parametrize(("loss", "better"), [(1.3, True), (0.7, False)])
def test_what_one_test_says_has_to_hold_in_the_other(loss, better):
    """30 % more loss in both tests, or 30 % more in one and 30 % less in the other; 25 K of rise, read to 0.3 K."""
    tests = [measured("one", loss=1.3), measured("two", loss=loss)]
    fits = list(both(tests))
    before, after = ([fold_prediction(fit, f, {}) for f in folds(tests, ["one", "two"])] for fit in fits)
    noises = [fit.noise for fit in fits]
    checks = prediction_checks(before, after, noises, ["one", "two"])
    assert checks[0].passed == better
    assert not any(c.partial for c in checks)
    assert all(c.partial for c in prediction_checks(before, after, noises, ["one"])), (
        "a part of one test is no left-out error"
    )


def density(nats):
    """The log density of a fold, whatever its noise."""
    return lambda noise: nats


@pytest.mark.parametrize(("rise", "effect", "fault"), [(0.995, True, True), (1.005, True, False), (1.02, False, False)])
def test_a_sensor_that_is_always_wrong_has_to_lower_the_error_and_physics_may_leave_it(rise, effect, fault):
    """What is likelier by 20 nats, and its error `rise` times the one before: 1 % shows in no two digits."""
    was, now = (
        [FoldPrediction(density(nats), (k * 2.0) ** 2 * 3600, 1e6, 3600)] for nats, k in ((-50.0, 1.0), (-30.0, rise))
    )
    assert prediction_checks(was, now, [FOLLOWED], [])[0].passed == effect
    assert prediction_checks(was, now, [FOLLOWED], [], same=1.0)[0].passed == fault


def test_a_step_is_not_held_against_the_noise_of_a_model_without_it_alone():
    """Of two noises the readings may have either: one that is as large as what was missing hides it."""
    large, small = FOLLOWED, replace(FOLLOWED, allow=0.5)
    before = [FoldPrediction(lambda noise: -10.0 if noise is large else -500.0, 4e6, 1e7, 3600.0)]
    after = [FoldPrediction(lambda noise: -9.5 if noise is large else -4.0, 1e4, 1e7, 3600.0)]
    assert not prediction_checks(before, after, [large], ["one"])[0].passed
    check = prediction_checks(before, after, [large, small], ["one"])[0]
    assert check.passed
    assert check.value == pytest.approx(6.0, abs=0.01)


def test_a_test_left_out_is_predicted_by_a_fit_to_the_other():
    """Its error by the loss that follows the other alone, the sensor as it reads; its density, noise and all, by the
    most probable parameters and the whole covariance of readings."""
    tests = [measured("one", shift=0.8), measured("two", loss=1.2)]
    fit = replace(list(both(tests))[1], error=None)
    fold = folds(tests, ["one", "two"])[0]
    alone = minimise(fit.network, fold.fitted, fit.unknowns, np.zeros(2), fit.noise)
    (read,) = segments(fit.network, fold.predicted, alone.values, fit.unknowns.parameters)
    W = fit.noise.whiten(read, np.eye(read.r.size))
    S = np.linalg.inv(W.T @ W) + read.J @ alone.covariance @ read.J.T
    density = -0.5 * (read.r @ np.linalg.solve(S, read.r) + np.linalg.slogdet(S)[1])
    follows = minimise(fit.network, fold.fitted, Unknowns((LOSS,)), np.zeros(1), FOLLOWED)
    (left,) = segments(fit.network, fold.predicted, follows.values)
    found = fold_prediction(fit, fold, {})
    assert found.square_K2s / found.seconds == pytest.approx(np.mean(left.r**2), rel=1e-3)
    assert found.nats(fit.noise) == pytest.approx(density, rel=1e-3, abs=0.05)


def test_of_the_only_test_that_tells_the_second_half_is_predicted():
    tests = [measured("one"), measured("two")]
    (half,) = folds(tests, ["two"])
    assert [t.name for t in half.predicted] == ["two"]
    first, second = (t.channels[0].y for t in (half.fitted[1], half.predicted[0]))
    assert np.array_equal(np.where(np.isfinite(first), first, second), tests[1].channels[0].y)
    assert np.isfinite(second).sum() == pytest.approx(100, abs=2)
    assert [f.predicted[0].name for f in folds(tests[:1], ["one"])] == ["one"]


def test_no_change_is_the_first_reading_of_the_test_not_of_its_half():
    test = measured("one")
    second = halves(test)[1]
    (fit, _) = both([test])
    found = fold_prediction(fit, folds([test], [])[0], {})
    y = second.channels[0].y
    assert found.no_change_K2s / found.seconds == pytest.approx(np.nanmean((y - test.channels[0].y[0]) ** 2), rel=1e-6)


def at_rest(name, loss):
    """A body that has been warmed for long: ten readings of one state."""
    test = measured(name, loss=loss)
    (channel,) = test.channels
    y = np.full(test.time.size, 20.0 + 25.0 * loss)
    return replace(test, initial={"body": y[0]}, channels=(replace(channel, y=y),))


def test_of_one_steady_state_no_part_is_unseen():
    """Its later part repeats the earlier: a step that fits it is told so and not accepted, and no guess is beaten."""
    assert at_rest("one", 1.6).is_steady
    assert not measured("one").is_steady
    assert folds([at_rest("one", 1.6)], ["one"]) == []
    done = calibrate(Case("one", Model(one_node(LOSS)), (at_rest("one", 1.6),)))
    assert done.why.startswith("kept for the fitted tests only: one steady state")
    assert "no change" not in {c.check for c in done.checks}


def test_several_steady_states_are_left_out_in_turn_and_no_guess_of_no_change_is_asked():
    """It begins with what a steady test reads, and so leaves nothing that a prediction could beat."""
    tests = (at_rest("one", 1.6), at_rest("two", 1.6))
    done = calibrate(Case("one", Model(one_node(LOSS)), tests))
    assert done.accepted, done.why
    assert [c.check for c in done.checks] == ["left out", "fitted"]
    before, after = ([FoldPrediction(density(-n), 900.0 * n, 0.0, 3600.0)] * 2 for n in (9.0, 1.0))
    assert all(c.passed for c in prediction_checks(before, after, [FOLLOWED], ["one", "two"]))
    moving = [after[0], replace(after[1], no_change_K2s=800.0)]
    assert [c.passed for c in prediction_checks(before, moving, [FOLLOWED], ["one", "two"])] == [True, False]


def test_a_calibration_after_an_addition_is_told_what_it_costs_the_other_tests():
    """The addition was fitted to both tests; the calibration to one of them, whose film is half the other's."""
    odd = measured("odd", loss=1.6)
    case = Case("one", Model(one_node(FILM)), (odd, measured("usual", "validate")))
    grown = add(case, "mass@body").model
    assert set(grown.reference.tests) == {"odd", "usual"}
    done = calibrate(replace(case, model=grown))
    assert (done.accepted, done.worth_keeping) == (False, True)
    assert re.match(r"kept for the fitted tests only: [0-9.e-]+ -> [0-9.]+ K \(usual\); ", done.why)
    (check,) = [c for c in done.checks if c.check == "unseen"]
    assert check.value > 1.05 * check.limit


def test_a_calibration_that_predicts_worse_than_no_change_is_said_so():
    """A fifth of the declared loss, and a film that may at most double: 20 K off before, 7.5 after, where the readings
    themselves rise by 5 K."""
    film = replace(FILM, low=0.5, high=2.0)
    done = calibrate(Case("one", Model(one_node(film)), (measured("one", loss=0.2), measured("two", loss=0.2))))
    (check,) = [c for c in done.checks if not c.passed]
    rise = measured(loss=0.2).channels[0].y - 20.0
    assert check.check == "no change"
    assert check.limit == pytest.approx(np.sqrt(np.mean(rise**2)), rel=0.01)
    assert check.value == pytest.approx(done.tests[0].after, rel=0.01)
    assert (done.accepted, done.worth_keeping) == (False, True)
    assert done.why.startswith(f"kept for the fitted tests only: {check.words}")


def test_the_hold_out_has_no_say():
    """The same words whatever the held-out test reads, but for the sentence about it."""

    def verdict(loss):
        tests = (measured("one", loss=1.6), measured("two", loss=1.6), measured("kept", "hold-out", loss=loss))
        done = calibrate(Case("one", Model(one_node(FILM)), tests))
        return done.accepted, [c.words for c in done.checks], done.model.values

    assert verdict(1.6) == verdict(0.4)
    assert verdict(1.6)[0]


@pytest.mark.parametrize("name", ["sensor.swap@flange.left|flange.right", "sensor.bias@yoke", "ambient.offset@ambient"])
def test_an_effect_on_the_measurement_is_free_in_the_fit_of_the_model_that_has_it(name):
    case = Truth(10).case()
    grown = replace(case, model=replace(case.model, effects=(AddedEffect(*name.split("@")),)))
    network, unknowns = working(grown)
    (stage,) = fit_stages(grown, grown.usable, unknowns)
    p = next(p for p in network.parameters if p.name == name)
    assert p.name in stage.free or measured_in(p, stage.tests)


def test_the_only_test_that_tells_is_cut_where_half_of_what_the_step_does_has_been_seen():
    """A lid opened late: in the first half of the record it has done nothing, so that says nothing of it."""
    tests = [measured("one"), measured("two")]
    fit = list(both(tests))[1]
    last = float(tests[1].time[-1])
    late = replace(fit, parts=tuple(replace(s, J=np.where(s.time[:, None] > 0.8 * last, s.J, 0.0)) for s in fit.parts))
    middle = middle_instant(late, [LOSS.name], "two")
    assert middle == pytest.approx(0.9 * last, rel=0.02)
    (cut,) = folds(tests, ["two"], middle)
    read = tests[1].time[np.isfinite(cut.fitted[1].channels[0].y)]
    assert read[-1] == pytest.approx(middle, rel=0.01)


def test_a_calibration_is_not_kept_if_its_own_tests_lose_by_it():
    """A heater that no input shows: what fits the noise of its blocks best may follow the readings worse."""
    done = calibrate(Case("one", Model(one_node(FILM)), (measured("odd", loss=1.6), measured("usual", "validate"))))
    assert (done.accepted, done.worth_keeping) == (False, True), "the other test, which was right before, is worse"
    (own,) = [c for c in done.checks if c.check == "fitted"]
    (change,) = [t for t in done.tests if t.name == "odd"]
    assert own.passed
    assert (own.limit, own.value) == (pytest.approx(change.before), pytest.approx(change.after))
    worse = replace(own, passed=False)
    assert not replace(done, checks=(worse, *(c for c in done.checks if c != own))).worth_keeping
    assert judge("calibrate", done.tests, (), (worse,), {"odd"})[1].startswith(worse.words)


def test_a_room_or_an_input_further_off_than_any_reading_is_refused():
    """A body 15 K too warm for its room; the room may be off by 10 K. A film at its bound may still predict; the same
    number by the name of a meter's error may not."""
    far = Parameter(
        "ambient.offset@ambient",
        (("boundary:ambient", 1.0),),
        value=0.0,
        low=-10,
        high=10,
        prior_sd=90.0,
        mapping="offset",
        neutral=0.0,
        unit="K",
    )
    narrow = replace(FILM, name="convection@body", low=0.8, high=1.25)
    meter = replace(narrow, name="input.offset@flow_l_min")
    for p, passes in ((far, False), (narrow, True), (meter, False)):
        test = measured("one", shift=15.0)
        fit = minimise(one_node(p), [test], Unknowns((p,)), np.zeros(1))
        assert fit.at_bound[0]
        assert bound_check(fit, p.name).passed == passes


def test_of_a_test_with_an_event_of_its_own_the_later_part_is_left_out():
    """Left out whole, it would be predicted without its event, and no step could be judged beside that error."""
    tests = [measured("one"), measured("two"), measured("three")]
    time = float(tests[1].time[50])
    one, two, three = folds(tests, ["one", "two", "three"], lone={"two": time})
    for fold, name in ((one, "one"), (three, "three")):
        assert [t.name for t in fold.predicted] == [name]
        assert name not in [t.name for t in fold.fitted]
    assert {t.name for t in two.fitted} == {"one", "two", "three"}
    seen, unseen = (next(t for t in part if t.name == "two") for part in (two.fitted, two.predicted))
    assert np.isnan(seen.channels[0].y[60:]).all()
    assert np.isnan(unseen.channels[0].y[:40]).all()
