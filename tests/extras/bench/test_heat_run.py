"""The heat run by hand: formulas, limits and corrections of the standard, duties and verdicts with known answers."""

from dataclasses import replace

import numpy as np
import pytest

from extras.bench.heat_run.duty import Operation, duty_of, equivalent_load, power_30_minutes
from extras.bench.heat_run.limits import Rating, corrections
from extras.bench.heat_run.rises import (
    K_OF,
    Rise,
    deciding,
    detector_rise,
    resistance_rise,
    resistance_rises,
    superposed_rise,
    winding_of,
)
from extras.bench.measuring.protocol import Cold, Hot
from thermoscope import InputError
from thermoscope.plugin import OHMMETER, Reading

F = Rating(7.0, "F")
COLD = Cold(20.0, 20.0, 0.5)


@pytest.mark.parametrize(("material", "rise"), [("copper", 97.0), ("aluminium", 93.0)])
def test_rise_by_resistance(material, rise):
    """(0.7 - 0.5) / 0.5 is 0.4; times 255 K or 245 K is 102 K or 98 K over 20 degC, 5 K less over 25 degC."""
    assert resistance_rise(0.5, 0.7, 20.0, 25.0, K_OF[material]) == pytest.approx(rise)


def test_winding_of_the_standard_is_its_formula():
    """What cools down is turned into temperatures by the same k."""
    for k in K_OF.values():
        T = winding_of(replace(COLD, machine_C=31.0), OHMMETER, k).temperature(0.7)
        assert pytest.approx(resistance_rise(0.5, 0.7, 31.0, 25.0, k)) == T - 25.0


@pytest.mark.parametrize(
    ("change", "limit"),
    [
        ({}, 105.0),
        ({"thermal_class": "A"}, 60.0),
        ({"thermal_class": "E"}, 75.0),
        ({"thermal_class": "B"}, 80.0),
        ({"thermal_class": "H"}, 125.0),
        ({"fan": False}, 110.0),
        ({"rated_kW": 0.5}, 110.0),
        ({"duty": "S2"}, 115.0),
        ({"site_C": 50.0, "test_C": 30.0}, 95.0),
        ({"site_C": 30.0}, 105.0),  # a cooler site gains nothing
        ({"site_m": 3000.0}, 105.0 * 0.8),
        ({"test_m": 2500.0}, 105.0 * 1.15),
        ({"site_m": 2000.0, "test_m": 3000.0}, 105.0 * 1.1),
        ({"site_m": 900.0, "test_m": 300.0}, 105.0),
        ({"site_C": 50.0, "test_C": 30.0, "site_m": 2000.0, "duty": "S2"}, (105.0 + 10.0 - 10.0) * 0.9),
        ({"site_m": 4500.0}, None),
        ({"site_C": 65.0, "test_C": 60.0}, None),
        ({"test_C": 8.0}, None),
        ({"standard": "IEC 60349"}, None),
        ({"standard": "IEC 60349", "agreed_K": 180.0, "site_m": 3000.0}, 180.0),
    ],
)
def test_limit_of_the_resistance_method(change, limit):
    """By hand: class, +10 K for S2, -10 K at 50 degC, 1 % for each 100 m between test and site above 1000 m."""
    last = corrections(replace(F, **change), "resistance")[-1].limit_K
    assert last == (None if limit is None else pytest.approx(limit))


@pytest.mark.parametrize(
    ("kW", "thermal_class", "limit"),
    [(100.0, "F", None), (1000.0, "F", 115.0), (1000.0, "B", 90.0), (6000.0, "H", 130.0), (1000.0, "A", None)],
)
def test_limit_of_detectors(kW, thermal_class, limit):
    assert corrections(Rating(kW, thermal_class), "ETD")[-1].limit_K == limit


def cooling(first_s, T0=120.0, swing=14.0, tau=180.0, tau_2=9000.0, step=15.0):
    """Resistances while a winding cools from T0 to its core, and with it to the room; no error."""
    t = np.arange(first_s, first_s + 301.0, step)
    T = (T0 - swing - 20.0) * np.exp(-t / tau_2) + swing * np.exp(-t / tau) + 20.0
    return tuple(zip(t, 0.5 * (235.0 + T) / 255.0, strict=True))


def rises_of(readings, rating=F, thermometer_K=0.5):
    rises = resistance_rises(COLD, Hot(20.0, readings), OHMMETER, 235.0, thermometer_K, rating, ())
    return {r.method.removeprefix("resistance, "): r for r in rises}


@pytest.mark.parametrize("first_s", [20.0, 45.0])
def test_fitted_cool_down_gives_the_truth_at_switching_off(first_s):
    """The truth is 100 K; the exponentials find it within their uncertainty and a tenth of what cooled before."""
    found, gone = rises_of(cooling(first_s))["exponentials"], 14.0 * (1 - np.exp(-first_s / 180.0))
    assert found.at_s == 0.0
    assert found.rise_K == pytest.approx(100.0, abs=min(0.1 * gone, found.U95_K))


def test_delay_of_the_standard():
    """7 kW: 30 s count as none, from 45 s the line goes back to 30 s; 300 kW have 120 s; later is refused."""
    at_once, late = rises_of(cooling(20.0))["IEC 60034-1"], rises_of(cooling(45.0))["IEC 60034-1"]
    assert (at_once.at_s, late.at_s) == (20.0, 30.0)
    assert at_once.temperature_degC == pytest.approx(20.0 + 86 * np.exp(-20 / 9000) + 14 * np.exp(-20 / 180))
    assert rises_of(cooling(110.0), Rating(300.0, "F"))["IEC 60034-1"].at_s == 110.0
    with pytest.raises(InputError, match="61 s after switching off"):
        rises_of(cooling(61.0))


def test_uncertainty_of_a_rise_by_hand():
    """Root sum of squares of both resistances' limits and both thermometers', each evenly spread; 1.96 of it."""
    found = rises_of(cooling(20.0))["IEC 60034-1"]
    R2 = cooling(20.0)[0][1]
    limits = [0.25 / 100 * R + 0.002 for R in (0.5, R2)]
    parts = [limits[0] * R2 / 0.5**2 * 255.0, limits[1] / 0.5 * 255.0, 0.5 * R2 / 0.5, 0.5]
    scatter = 0.002 / np.sqrt(12.0) / 0.5 * 255.0
    sd = np.sqrt(sum(p**2 for p in parts) / 3.0 + scatter**2)
    assert pytest.approx(1.96 * sd, rel=0.01) == found.U95_K


@pytest.mark.parametrize(
    ("rise", "U95", "verdict", "in_hand"),
    [
        (97.0, 3.0, "passes", 5.0),
        (109.0, 3.0, "fails", -1.0),
        (106.0, 3.0, "cannot be judged", 0.0),
        (104.0, 3.0, "cannot be judged", 0.0),
        (105.0, 0.0, "passes", 0.0),
    ],
)
def test_verdict(rise, U95, verdict, in_hand):
    row = Rise("resistance", 0.0, 120.0, rise, U95, 105.0)
    assert (row.verdict, row.margin_K) == (verdict, in_hand)
    assert replace(row, limit_K=None).verdict == "cannot be judged"
    assert Rise("ETD", limit_K=115.0).verdict == "not measured"


def test_detectors_and_superposition():
    """The hottest detector over the coolant; 40 K + 70 K - 8 K with the root of 1 + 1 + 0.25 K2."""
    rating = Rating(1000.0, "F")
    hottest = detector_rise(Reading("detector", 121.5, 1.0), 21.5, 0.5, rating)
    assert (hottest.rise_K, hottest.limit_K) == (100.0, 115.0)
    assert pytest.approx(1.96 * np.sqrt((1.0 + 0.25) / 3.0), rel=1e-3) == hottest.U95_K
    both = superposed_rise([("open", 1, 40.0, 1.0), ("short", 1, 70.0, 1.0), ("no load", -1, 8.0, 0.5)], F)
    assert both.rise_K == 102.0
    assert pytest.approx(1.96 * 1.5, rel=1e-3) == both.U95_K


def test_what_decides():
    """The standard's own delays; for traction the fit back to switching off; else what was measured."""
    rises = list(rises_of(cooling(20.0)).values())
    assert deciding(rises, "IEC 60034-1").method == "resistance, IEC 60034-1"
    assert deciding(rises, "IEC 60349").method == "resistance, exponentials"
    only = [Rise("resistance"), Rise("ETD"), Rise("superposition", None, None, 90.0, 2.0, 105.0)]
    assert deciding(only, "IEC 60034-1").method == "superposition"


TAU, RISE = 60.0, 60.0  # min, K


def warming(until, step=2.0, cycle=0.0, swing=8.0):
    t = np.arange(0.0, until + 0.1, step)
    ripple = 0.5 * swing * np.sin(2 * np.pi * t / cycle) * (1 - np.exp(-t / TAU)) if cycle else 0.0
    return list(zip(t, 20.0 + RISE * (1 - np.exp(-t / TAU)) + ripple, strict=True))


def test_steady_state_is_found():
    """1 K per half hour: 60 K (1 - exp(-0.5)) exp(-t / 60 min) = 1 K at 190 min; 95 % of the rise after 3 tau."""
    begin = TAU * np.log(RISE * (1 - np.exp(-30.0 / TAU)))
    found = duty_of(Operation("S1"), warming(400.0), 20.0)
    assert found.missing == ""
    assert found.steady_min == pytest.approx(begin, abs=2.0)
    assert found.drift_K_h == pytest.approx(2.0 * RISE * (np.exp(-370 / TAU) - np.exp(-400 / TAU)), rel=0.05)
    assert found.tau95_min == pytest.approx(3.0 * TAU, rel=0.1)
    short = duty_of(Operation("S1"), warming(200.0), 20.0)
    assert (short.steady_min, short.milder) == (None, True)
    assert "K/h" in short.missing
    assert duty_of(Operation("S1"), [], 20.0).missing == "no temperature was logged under load"


@pytest.mark.parametrize("duty", ["S3", "S4", "S5", "S6", "S7", "S8"])
def test_duty_by_cycle(duty):
    """The points where successive cycles are hottest settle like the mean, whatever the ripple."""
    begin = TAU * np.log((RISE + 4.0) * (1 - np.exp(-30.0 / TAU)))
    found = duty_of(Operation(duty, cycle_min=20.0), warming(500.0, 1.0, 20.0), 20.0)
    assert found.missing == ""
    assert found.steady_min == pytest.approx(begin, abs=20.0)
    assert "8.0 K from valley to peak" in found.words
    assert "K/h" in duty_of(Operation(duty, cycle_min=20.0), warming(160.0, 1.0, 20.0), 20.0).missing


def test_short_time_duty():
    done = duty_of(Operation("S2", rated_min=60.0), warming(60.0), 22.0)
    assert done.missing == ""
    short = duty_of(Operation("S2", rated_min=60.0), warming(50.0), 22.0)
    assert (short.missing, short.milder) == ("run for 50.0 min of 60 min", True)
    assert "6.0 K off the coolant" in duty_of(Operation("S2", rated_min=60.0), warming(60.0), 26.0).missing


@pytest.mark.parametrize("duty", ["S9", "S10"])
def test_duty_by_equivalent_load(duty):
    """sqrt((20 x 1 + 10 x 0.16 + 30 x 0.64) / 60) = sqrt(0.68)."""
    loads = ((20.0, 1.0), (10.0, 0.4), (30.0, 0.8))
    assert equivalent_load(loads) == pytest.approx(np.sqrt(0.68))
    covered = duty_of(Operation(duty, loads=loads, test_load=0.825), warming(400.0), 20.0)
    assert (covered.missing, covered.equivalent_load) == ("", pytest.approx(np.sqrt(0.68)))
    milder = duty_of(Operation(duty, loads=loads, test_load=0.8), warming(400.0), 20.0)
    assert "the equivalent load is 0.825" in milder.missing
    assert milder.milder
    harder = duty_of(Operation(duty, loads=loads, test_load=0.9), warming(400.0), 20.0)
    assert (harder.missing != "", harder.milder) == (True, False)


def test_power_of_30_minutes():
    """From 50 kW straight down to 48 kW: 49 kW, 4 % off its start; what comes after 30 min does not count."""
    seconds = np.arange(0.0, 2401.0, 60.0)
    found = power_30_minutes(list(zip(seconds, 50.0 - 2.0 * seconds / 1800.0, strict=True)))
    assert found == {"power_kW": pytest.approx(49.0), "largest_change_percent": pytest.approx(4.0), "valid": True}
    assert not power_30_minutes([(0.0, 50.0), (1800.0, 47.0)])["valid"]
    with pytest.raises(InputError, match="min of power"):
        power_30_minutes([(0.0, 50.0), (1200.0, 49.0)])
