"""The story of the road test: calibrated on the stand, wrong on the road, effect added, error down."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from playground import Truth, wind

from geom.errors import InputError
from validation import add, calibrate, remove
from validation.comparison.linearisation import rmse, segments
from validation.parameters.unknowns import standing
from validation.revision.acceptance import Check
from validation.revision.revise import Change, judge

EFFECT = "convection@flange.right"


@cache
def stand():
    case = Truth(3, wind("flange.right", 40.0)).case()
    return case, calibrate(case)


@cache
def added():
    case, first = stand()
    return add(replace(case, model=first.model), EFFECT)


def channel(comparison, test, name):
    (t,) = [t for t in comparison.tests if t.name == test]
    return next(c for c in t.channels if c.channel == name)


def test_a_calibration_is_judged_by_the_tests_it_was_fitted_to():
    """What another test shows is told; that of the road is where the missing effect shows."""
    changes = (Change("stand", "calibrate", 1.0, 0.3), Change("road", "validate", 1.0, 2.0))
    accepted, why = judge("calibrate", changes, (), (), {"stand"})
    assert accepted
    assert "1.00 -> 0.30 K; other tests 1.00 -> 2.00 K: road got worse" in why
    assert not judge("calibrate", changes, (), (), {"stand", "road"})[0]


def test_road_fails_at_the_right_flange():
    _, first = stand()
    road = next(t for t in first.after.tests if t.name == "road-1")
    assert max(road.channels, key=lambda c: c.rmse_K).channel in ("flange.right", "bearing.right")


def test_held_out_error_falls():
    done = added()
    sides = [channel(c, "road-2", "flange.right").rmse_K for c in (done.before, done.after)]
    assert sides[1] < 0.5 * sides[0]
    assert done.accepted, done.why


def test_an_effect_far_larger_than_usual_is_not_shrunk():
    """Three times the prior's deviation: what it takes away must not go into iron and copper instead."""

    def stray(T, u, t):
        return {"rotor": 120.0 * (u["speed_rpm"] / 1000.0) ** 2 * (u["current_A"] / 100.0) ** 2}

    case = Truth(3, stray).case()
    done = add(replace(case, model=calibrate(case).model), "loss.rotor.load@rotor")
    (found,) = [p for p in done.parameters if p.name == "loss.rotor.load@rotor"]
    assert found.value == pytest.approx(120.0, rel=0.15)


def test_removing_brings_the_error_back():
    case, _ = stand()
    gone = remove(replace(case, model=added().model), EFFECT)
    assert not gone.accepted
    assert gone.model.effects == ()
    assert gone.model.revision == 3
    assert not any(v.startswith(EFFECT) for v in gone.model.values), "neither it nor its exponents"


def test_what_the_data_cannot_tell_is_said():
    rows = {p.name: p for p in added().parameters}
    assert rows[EFFECT].identified
    assert not all(p.identified for p in rows.values())


def test_calibration_leaves_less_than_the_sensors_are_sure_of():
    """Sensors with 0.4 K of bias (1 sigma, told as 0.5 K), noise of 0.05 K and 0.1 K steps: below half of 0.4 K."""
    case, first = stand()
    assert first.converged
    network = standing(case)
    tests = [t for t in case.tests if t.role == "calibrate"]
    assert rmse(segments(network, tests, first.model.values)) < 0.2


def test_a_step_that_cannot_be_is_refused():
    case, _ = stand()
    grown = replace(case, model=added().model)
    steps = (
        (remove, case, EFFECT),
        (add, case, "convection@mars"),
        (add, case, "phlogiston@yoke"),
        (add, grown, EFFECT),
    )
    for act, some, name in steps:
        with pytest.raises(InputError):
            act(some, name)


def test_a_frozen_channel_does_not_bend_the_calibration(monkeypatch):
    """The same to 0.02 (factors, K) as without its readings; fitted to them it is far off."""
    case, _ = stand()
    (first, *others) = case.tests
    y, half = first.channels[0].y, first.time.size // 2

    def values(late):
        read = replace(first.channels[0], y=np.where(np.arange(y.size) < half, y, late))
        test = replace(first, channels=(read, *first.channels[1:]))
        found = calibrate(replace(case, tests=(test, *others))).model.values
        return {name: value for name, value in found.items() if not name.startswith(("lag of ", "clock of "))}  # s

    gone, frozen = values(np.nan), values(y[half])
    assert frozen == pytest.approx(gone, abs=0.02)
    monkeypatch.setattr("validation.revision.revise.broken_channels", lambda tests: [])
    bent = values(y[half])
    assert max(abs(bent[k] - gone[k]) for k in gone) > 0.2


@pytest.mark.parametrize(("passed", "after", "accepted"), [(True, 2.0, True), (False, 2.0, False), (True, 4.0, False)])
def test_an_effect_has_to_predict_and_its_own_tests_must_not_be_told_worse(passed, after, accepted):
    changes = (Change("stand", "calibrate", 3.0, after),)
    checks = (Check("left out", passed, 40.0, 0.0, "5.9 -> 2.9 K"),)
    assert judge("add", changes, (), checks, {"stand"})[0] is accepted
