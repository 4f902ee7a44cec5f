"""Warming curves: the published coefficients come back, equilibrium is found where it is, runs repeat or do not."""

import numpy as np
import pytest

from extras.bench.measuring.curves import assemblies, assembly, worst
from extras.bench.measuring.warming import eq8, equilibrium, fit_eq8, normalised_error, pooled_curves, repeats
from geom.errors import InputError
from measured.case import Channel, Test as CaseTest

MINUTES = np.arange(0.0, 60.1, 1.0)
PUBLISHED = (85.0, -0.652, -0.08)


def test_published_coefficients_are_recovered():
    found = fit_eq8(MINUTES, eq8(MINUTES, *PUBLISHED))
    assert (found.a, found.b, found.c) == pytest.approx(PUBLISHED, rel=1e-6)
    assert found.start == pytest.approx(44.3, abs=0.05)
    assert found.time_to_share_min() == pytest.approx(31.8, abs=0.05)
    assert found(found.time_to_share_min()) == pytest.approx(0.95 * 85.0)
    assert not found.warnings
    assert found(found.rise_min()) == pytest.approx(found.start + 0.95 * (85.0 - found.start))


def test_intervals_cover_the_published_ones():
    """0.5 K of scatter, as thermocouples have: a 95 % interval holds its coefficient in 90 to 99.5 % of 200 draws."""
    held = np.zeros(3)
    for seed in range(200):
        noise = 0.5 * np.random.default_rng(seed).standard_normal(MINUTES.size)
        found = fit_eq8(MINUTES, eq8(MINUTES, *PUBLISHED) + noise)
        held += [lo <= v <= hi for v, (lo, hi) in zip(PUBLISHED, found.ci95.values())]
    assert np.all(held / 200 > 0.90)
    assert np.all(held / 200 < 0.995)


def test_extrapolated_end_is_said():
    short = np.arange(0.0, 20.1, 0.5)
    assert "after the record's end" in fit_eq8(short, eq8(short, *PUBLISHED)).warnings[0]


@pytest.mark.parametrize("T", [np.full(MINUTES.size, 40.0), MINUTES - 30.0])
def test_nothing_to_fit(T):
    """That does not warm, or is below 0 degC, where the formula has no logarithm."""
    with pytest.raises(InputError, match="above 0 degC that warm by more than"):
        fit_eq8(MINUTES, T)


def test_equilibrium_by_the_sensors_resolution():
    """T = 80 - 40 exp(-t / 10): a window of 10 min moves by 0.5 K when 40 (1 - 1/e) exp(-t / 10) = 0.5."""
    minutes = np.arange(0.0, 120.1, 0.5)
    found = equilibrium(minutes, 80.0 - 40.0 * np.exp(-minutes / 10.0), 0.5)
    assert found.reached
    assert found.from_min == pytest.approx(10 * np.log(40 * (1 - np.exp(-1)) / 0.5), abs=0.5)
    assert found.T_e == pytest.approx(80.0, abs=0.5)


def test_no_equilibrium_while_it_drifts():
    found = equilibrium(MINUTES, 20.0 + 0.5 * MINUTES, 0.5)
    assert not found.reached
    assert found.drift_K_h == pytest.approx(30.0)
    with pytest.raises(InputError, match="longer than"):
        equilibrium(np.arange(5.0), np.arange(5.0), 0.5)


def test_equilibrium_rejects_one_late_disturbance():
    T = np.full(MINUTES.size, 60.0)
    T[-3] += 2.0
    assert not equilibrium(MINUTES, T, 0.5).reached


def test_rule_of_3_to_4_percent():
    verdicts = [assembly("flange", (80.0, True), T, 20.0).verdict for T in (82.0, 83.0, 84.0, 86.0)]
    assert verdicts == ["calibrated", "allowed", "correct the model", "beyond 7 %"]
    row = assembly("flange", (80.0, True), 82.0, 20.0, 0.6)
    assert row.U95_percent == pytest.approx(1.5)
    assert (row.percent, row.percent_of_rise) == (pytest.approx(2.5), pytest.approx(100 * 2 / 60))


def test_assemblies_of_a_test():
    """Two sensors of one place count together; each place has its own verdict."""
    minutes = np.arange(0.0, 121.0)
    warm = 80.0 - 60.0 * np.exp(-minutes / 10.0)
    channels = tuple(
        Channel(n, p, None, warm + d) for n, p, d in (("a", "flange", -1), ("b", "flange", 1), ("c", "yoke", 0))
    )
    test = CaseTest("t", "validate", 60 * minutes, {}, {"ambient": np.full(minutes.size, 20.0)}, channels)
    predicted = np.column_stack([warm, warm, 1.1 * warm])
    rows = {row.place: row for row in assemblies(test, predicted)}
    assert rows["flange"].verdict == "calibrated"
    assert rows["yoke"].verdict == "beyond 7 %"
    assert rows["yoke"].percent == pytest.approx(10.0, abs=0.1)
    assert worst(list(rows.values()))["calibrated"] is False


def test_three_runs_pooled():
    found = repeats([61.0, 60.0, 62.0], u=1.0)
    assert (found.mean, found.sd, found.spread) == (pytest.approx(61.0), pytest.approx(1.0), pytest.approx(2.0))
    assert found.repeat
    assert found.limit == pytest.approx(2.77, abs=0.01)
    assert not repeats([61.0, 60.0, 72.0], u=1.0).repeat
    with pytest.raises(InputError, match="2 or more runs"):
        repeats([61.0], 1.0)


def test_repeatability_is_refused_as_often_as_stated():
    """Equal machines, 3 runs, true uncertainty: 5 % of 2000 experiments are called different, within 4 sd = 2 %."""
    random = np.random.default_rng(1)
    wrong = np.mean([not repeats(random.normal(60, 0.8, 3), 0.8).repeat for _ in range(2000)])
    assert wrong == pytest.approx(0.05, abs=0.02)


def test_curves_pooled_on_common_times():
    minutes, mean, sd = pooled_curves([MINUTES, MINUTES[:50], MINUTES], [MINUTES, MINUTES[:50] + 1, MINUTES + 2])
    assert minutes[-1] == 49.0
    assert mean == pytest.approx(minutes + 1)
    assert sd == pytest.approx(np.ones(50))


def test_two_machines_within_their_uncertainty():
    assert abs(normalised_error(62.0, 60.0, 2.0, 2.0)) < 1 < abs(normalised_error(66.0, 60.0, 2.0, 2.0))
