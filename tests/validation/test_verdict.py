"""A name is given only to what `add` would accept; that calibration is not at ease with it is told."""

import pytest
from playground import Truth, wind

from geom.errors import InputError
from validation import diagnose


def rub(T, u, t):
    """A seal on the left flange that rubs once the rotor is 8 K above the yoke."""
    return {"flange.left": 120.0 * u["speed_rpm"] / 1000.0 * max(T["rotor"] - T["yoke"] - 8.0, 0.0) / 10.0}


def bursts(T, u, t, watts=300.0):
    """A heater on the yoke that nobody knows of, on at odd minutes."""
    return {"yoke": watts if (t // 60) % 17 in (3, 4, 5, 11) else 0.0}


def found(kinds, hidden, **machine):
    return diagnose(Truth(10, hidden, **machine).case(), draws=8, workers=1, plan=False, kinds=kinds)


def test_what_sticks_to_its_bound_is_not_claimed():
    """Heat on a flange, to be explained by films that foul: more than 95 % of one would have to be gone."""
    answer = found(["fouling"], rub)
    assert answer.groups[0][0] == "fouling@flange.left"
    assert answer.verdict == "outside"
    assert "sticks to a bound" in answer.words


def test_heat_that_comes_and_goes_unexplained_is_told_though_the_error_is_small():
    """The whole catalogue; the error is below what simulated machines leave, so only the scan can tell."""
    answer = found(None, bursts)
    assert answer.rmse_K < answer.floor_K
    assert answer.verdict == "outside"
    assert "heat is missing or in excess at yoke" in answer.words


def windy_with(watts):
    air = wind("flange.right", 12.0)
    return found(["convection"], lambda T, u, t: air(T, u, t) | bursts(T, u, t, watts))


def test_what_is_found_does_not_hide_that_more_is_missing():
    answer = windy_with(1000.0)
    assert answer.groups == (("convection@flange.right",),)
    assert answer.verdict == "outside"
    assert "at yoke beside what convection@flange.right would explain" in answer.words


def test_beside_what_is_found_heat_that_moves_no_reading_is_no_doubt():
    """Bursts of 300 W move the readings by 0.4 K."""
    answer = windy_with(300.0)
    assert answer.verdict == "named"


def test_a_declared_value_that_stays_far_off_is_told():
    """Wind and nothing else is in the catalogue; a bearing with eight times the friction, 30 % believed, remains."""
    strained = {"change": {"": ("friction", "bearing.left", 8.0)}}
    answer = found(["convection"], wind("flange.right", 12.0), **strained)
    assert answer.groups[0][0] == "convection@flange.right"
    assert answer.verdict == "named"
    assert "loss.friction.bearing.left is still" in answer.words


@pytest.mark.parametrize(
    ("kinds", "words"), [(["wear"], "unknown effect 'wear'"), (["conduction.bench"], "no effect can")]
)
def test_kinds_that_are_not_there_are_told(kinds, words):
    with pytest.raises(InputError, match=words):
        found(kinds, None)
