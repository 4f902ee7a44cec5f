"""Where a comparison fails, on series and networks whose answer is known by hand."""

from dataclasses import replace

import numpy as np
import pytest
from one_body import LOSS, G, P, measured, one_node

from measured.case import Case, Model
from validation.comparison.compare import compare
from validation.comparison.uncertainty import uncertainties
from validation.discrepancy import dependence, discrepancies, ljung_box, periodogram

RNG = np.random.default_rng(0)
WHITE = RNG.standard_normal((200, 400))


def slow(x, keep=0.9):
    out = np.array(x)
    for i in range(1, len(out)):
        out[i] += keep * out[i - 1]
    return out


@pytest.mark.parametrize("test", [ljung_box, periodogram])
def test_white_noise_fails_as_often_as_it_should(test):
    """5 % of 200 series: 10 with a standard deviation of 3."""
    assert sum(test(x) < 0.05 for x in WHITE) <= 19


@pytest.mark.parametrize("test", [ljung_box, periodogram])
def test_correlated_noise_is_seen(test):
    assert all(test(slow(x)) < 1e-3 for x in WHITE[:20])


def test_independent_series_do_not_follow_each_other_however_slow():
    """21 lags at 5 % each, strongly alike: at most a quarter of the pairs passes the level of one lag."""
    pairs = zip(WHITE[:60], WHITE[60:120], strict=True)
    assert sum(dependence(slow(a), slow(b)) > 1.0 for a, b in pairs) <= 20


def test_a_residual_that_comes_from_an_input_follows_it():
    assert dependence(np.roll(WHITE[0], 5) + 0.5 * WHITE[1], WHITE[0]) > 5.0


def steady():
    """Long after the start, read exactly."""
    test = measured()
    late = np.full_like(test.time, 20.0 + P / G)
    return replace(test, initial=20.0 + P / G, channels=(replace(test.channels[0], y=late),))


def test_an_ambient_half_a_kelvin_off_is_half_a_kelvin():
    (row,) = uncertainties(one_node(LOSS), replace(steady(), initial=20.0 + P / G), {})
    n = np.exp(-steady().time * G / 4000.0)  # settles with C / G
    assert row.inputs["ambient"] == pytest.approx(0.5 * np.sqrt(np.mean((1 - n) ** 2)), rel=0.02)
    assert row.u_val_K**2 == pytest.approx(row.reading_K**2 + row.input_K**2 + row.numeric_K**2)
    assert row.explained


def test_an_error_beyond_all_uncertainty_is_said():
    off = steady()
    off = replace(off, channels=(replace(off.channels[0], y=off.channels[0].y + 5.0),))
    (row,) = uncertainties(one_node(LOSS), off, {})
    assert not row.explained
    assert row.error_K == pytest.approx(5.0, rel=0.01)


@pytest.mark.parametrize("every", [1, 5, 10])
def test_the_arithmetics_own_error_covers_what_it_is(every):
    """Against the exact solution, at steps of 100 to 1000 s."""
    test, keep = measured(), slice(None, None, every)
    time = test.time[keep]
    test = replace(
        test,
        time=time,
        boundaries={"ambient": np.full_like(time, 20.0)},
        channels=(replace(test.channels[0], y=test.channels[0].y[keep]),),
    )
    (row,) = uncertainties(one_node(LOSS), test, {})
    assert 0.0 < row.error_K <= row.numeric_K < 0.1


def test_all_tests_and_sensors_are_looked_at():
    """Where heat is missing is tested on a motor, in test_diagnose; here: held-out rows, heat for every node."""
    tests = (measured(loss=1.4), measured("other", "hold-out"))
    case = Case("one", Model(one_node(LOSS)), tests)
    judged = [u for test in compare(case).tests for u in test.uncertainty]
    assert [(u.test, u.explained) for u in judged] == [("warm", False), ("other", True)]
    found = discrepancies(case).document()
    assert [p["test"] for p in found["patterns"]] == ["warm", "other"]
    assert [h["place"] for h in found["where"]] == ["body"]
