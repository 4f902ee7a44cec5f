"""The instant of switching off, from cooling curves whose beginning is known."""

import numpy as np
import pytest

from geom.errors import InputError
from measured.electrical.switch_off import Cooling, all_ways, allowed_delay, exponentials, rule_150, semilog, semilog_at

EVERY_15_S = np.arange(30.0, 301.0, 15.0)


def cooling(true, time=EVERY_15_S, ambient=20.0, sd=0.0, seed=0):
    noise = sd * np.random.default_rng(seed).standard_normal(time.size)
    return Cooling(time, true(time) + noise, ambient, max(sd, 1e-6))


def machine(t):
    """A winding that loses 8 K to its core within minutes while the core cools over an hour: falls 5 K, then 3 K."""
    return 20.0 + 70.0 * np.exp(-t / 3600.0) + 10.0 * np.exp(-t / 90.0)


def test_rule_is_exact_where_it_says_it_is():
    """Falls in the ratio 1.5 belong to exp(-t / tau) with tau = 60 s / ln 1.5."""
    tau = 60.0 / np.log(1.5)
    found = rule_150(cooling(lambda t: 70.0 + 12.0 * np.exp(-t / tau)))
    assert found.value == pytest.approx(82.0, abs=1e-9)


def test_rule_with_the_published_falls():
    """5 K in the first minute and 3 K more in the second are nearly 1.5 to 1: the rule misses by half a kelvin."""
    readings = Cooling(np.array([30.0, 60.0, 120.0, 150.0]), np.array([97.5, 95.0, 92.0, 91.0]), 20.0, 0.1)
    assert rule_150(readings).value == pytest.approx(100.0, abs=0.51)


def test_rule_propagates_the_readings_scatter():
    """Var = (2.5^2 + 1.5^2) sd^2 when readings fall on 60 s and 120 s."""
    assert rule_150(cooling(machine, sd=0.3)).sd == pytest.approx(0.3 * np.hypot(2.5, 1.5))


def test_semilog_is_exact_on_one_exponential_to_ambient():
    found = semilog_at(cooling(lambda t: 20.0 + 60.0 * np.exp(-t / 500.0)))
    assert found.value == pytest.approx(80.0, abs=1e-9)


@pytest.mark.parametrize(("rated", "delay"), [(7, 30), (50, 30), (51, 90), (200, 90), (201, 120), (5000, 120)])
def test_limits_of_time_by_rating(rated, delay):
    assert allowed_delay(rated) == delay


def test_early_reading_counts_as_it_is():
    early = cooling(machine, np.arange(25.0, 300.0, 15.0))
    found = semilog(early, 7.0)
    assert found.value == early.T[0]
    assert found.at_s == 25.0


def test_later_reading_is_extrapolated_to_the_limit_and_a_late_one_refused():
    found = semilog(cooling(lambda t: 20 + 60 * np.exp(-t / 500), np.arange(50.0, 300.0, 15.0)), 7.0)
    assert found.at_s == 30.0
    assert found.value == pytest.approx(20 + 60 * np.exp(-30 / 500))
    with pytest.raises(InputError, match="not later than 60 s"):
        semilog(cooling(machine, np.arange(61.0, 300.0, 15.0)), 7.0)
    assert semilog(cooling(machine, np.arange(61.0, 300.0, 15.0)), 75.0).at_s == 61.0


def test_rising_readings_give_their_highest():
    found = semilog(cooling(lambda t: 60 + 5 * (1 - np.exp(-t / 60)), np.arange(45.0, 300.0, 15.0)), 7.0)
    assert found.value == pytest.approx(65.0, abs=0.1)


def test_two_exponentials_are_found():
    found = exponentials(cooling(machine, sd=0.02))
    assert found.value == pytest.approx(machine(0.0), abs=3 * found.sd)
    assert "and" in found.words


def test_one_exponential_is_enough_where_there_is_one():
    found = exponentials(cooling(lambda t: 70.0 + 12.0 * np.exp(-t / 150.0), sd=0.05))
    assert "and" not in found.words
    assert found.value == pytest.approx(82.0, abs=3 * found.sd)


@pytest.mark.parametrize(
    ("way", "end", "size", "tau"), [(exponentials, 70.0, 12.0, 150.0), (semilog_at, 20.0, 62.0, 900.0)]
)
def test_stated_uncertainty_covers(way, end, size, tau):
    """One exponential and 0.3 K of scatter: the error over the stated sd is of size 1; 150 draws know that to 15 %."""
    errors = []
    for seed in range(150):
        found = way(cooling(lambda t: end + size * np.exp(-t / tau), sd=0.3, seed=seed))
        errors.append((found.value - 82.0) / found.sd)
    assert np.sqrt(np.median(np.square(errors)) / 0.455) == pytest.approx(1.0, abs=0.25)


def test_all_ways_agree_on_the_machine_of_the_paper():
    """Within the 1 to 2 K that they differ in print; the exponentials, which can follow it, come closest."""
    ways = {w.method: w for w in all_ways(cooling(machine, np.arange(20.0, 301.0, 15.0), sd=0.05), 7.0)}
    off = {name: abs(w.value - machine(0.0)) for name, w in ways.items()}
    assert set(ways) == {"IEC 60034-1", "semi-logarithmic", "150 % rule", "exponentials"}
    assert min(off, key=off.__getitem__) == "exponentials"
    assert max(off.values()) < 7.0


def test_what_cannot_be_extrapolated():
    with pytest.raises(InputError, match="3 or more readings"):
        Cooling(np.array([1.0, 2.0]), np.array([3.0, 2.0]), 20.0, 0.1)
    with pytest.raises(InputError, match="before 60 s"):
        rule_150(cooling(machine, np.arange(70.0, 300.0, 15.0)))
    with pytest.raises(InputError, match="above ambient"):
        semilog_at(cooling(lambda t: 19.0 - 0.01 * t))
    with pytest.raises(InputError, match="by agreement"):
        allowed_delay(6000.0)
