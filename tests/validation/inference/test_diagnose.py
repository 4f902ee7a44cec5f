"""The verdicts on machines whose truth is known, made by formulas that the model does not share."""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from playground import Truth, network, wind

from geom.errors import InputError
from measured.sensors.faults import broken_channels
from validation import diagnose

pytestmark = pytest.mark.heavy


def brush(T, u, t):
    return {"commutator": 3.0 * abs(u["current_A"])}


@dataclass(frozen=True)
class Exchanged:
    """A machine with nothing missing whose plugs a and b were exchanged."""

    a: str
    b: str

    def case(self):
        case = Truth(10).case()
        return replace(case, tests=tuple(self.test(t) for t in case.tests))

    def test(self, test):
        y, other = {c.name: c.y for c in test.channels}, {self.a: self.b, self.b: self.a}
        return replace(test, channels=tuple(replace(c, y=y[other.get(c.name, c.name)]) for c in test.channels))


WIND = 16.0  # W/K at 10 m/s
TRUTHS = {
    "nothing": lambda: Truth(11),
    "wind": lambda: Truth(10, wind("flange.right", WIND)),
    "brush": lambda: Truth(10, brush),
    "bias": lambda: Truth(10, bias={"yoke": 4.0}),
    "exchanged": lambda: Exchanged("winding.field", "yoke"),
}


@cache
def answer(name, plan=False):
    return diagnose(TRUTHS[name]().case(), plan=plan)


def test_a_case_of_held_out_tests_alone_is_refused():
    case = Truth(10).case()
    held_out = replace(case, tests=tuple(replace(test, role="hold-out") for test in case.tests))
    with pytest.raises(InputError, match="only held-out tests"):
        diagnose(held_out)


def test_nothing_missing_is_adequate():
    assert answer("nothing").verdict == "adequate"


def test_hidden_wind_is_named():
    found = answer("wind", plan=True)
    assert found.verdict == "named"
    assert found.named == ("convection@flange.right",)
    assert found.remainder == ()
    for before, after in (found.candidates[0].rmse_K, found.candidates[0].holdout_rmse_K):
        assert after < before


def test_amplitude_of_the_wind_is_covered():
    """16 W/K at 10 m/s with Re^0.63, told as Re^0.8: the two laws agree within 20 % over the speeds driven."""
    low, high = answer("wind", plan=True).candidates[0].ci95
    assert low < 1.2 * WIND
    assert high > WIND / 1.2


def test_missing_heat_is_located():
    assert answer("wind", plan=True).where[0].place == "flange.right"


def test_confounded_effects_are_a_group():
    """Heat at the commutator: from the brush drop, or any other that follows the current as well on these tests."""
    found = answer("brush", plan=True)
    assert found.verdict in ("group", "named")
    assert "brush.drop@commutator" in found.groups[0]
    gains = [t.predicted_gain / t.hours for t in found.next_tests]
    assert found.verdict == "named" or (gains and gains == sorted(gains, reverse=True))


@pytest.mark.parametrize(
    ("name", "effect"), [("bias", "sensor.bias@yoke"), ("exchanged", "sensor.swap@yoke|winding.field")]
)
def test_faults_of_sensors_are_data(name, effect):
    found = answer(name)
    assert found.verdict == "data"
    assert effect in found.groups[0]


def test_odds_sum_to_one_and_lead_to_the_verdict():
    found = answer("wind", plan=True)
    assert sum(o.probability for o in found.odds) == pytest.approx(1.0)
    assert found.odds[0].effects[:1] == found.named
    assert found.p_nothing < 0.01


def test_held_out_tests_have_no_say():
    """Other held-out readings, the same answer but for the error on them."""
    case = TRUTHS["wind"]().case()
    spoilt = [
        replace(t, channels=tuple(replace(c, y=c.y + 30.0) for c in t.channels)) if t.role == "hold-out" else t
        for t in case.tests
    ]
    other = diagnose(replace(case, tests=tuple(spoilt)), plan=False)
    assert other.odds == answer("wind", plan=True).odds
    assert other.candidates[0].holdout_rmse_K != answer("wind", plan=True).candidates[0].holdout_rmse_K


def test_what_it_buys_is_told_test_by_test():
    """The tests' errors make up the whole, weighted with their records; the held-out one is marked and falls."""
    case, first = TRUTHS["wind"]().case(), answer("wind", plan=True).candidates[0]
    told = {name: (before, after, held) for name, before, after, held in first.tests}
    assert set(told) == {t.name for t in case.tests}
    assert {n for n, (*_, held) in told.items() if held} == {t.name for t in case.tests if t.role == "hold-out"}
    used = [(b, a) for b, a, held in told.values() if not held]
    assert min(b for b, _ in used) <= first.rmse_K[0] <= max(b for b, _ in used)
    assert min(a for _, a in used) <= first.rmse_K[1] <= max(a for _, a in used)
    assert all(after < before for before, after, held in told.values() if held)


def test_effects_that_tests_cannot_show_are_listed():
    """No channel sits on the shaft, and nothing but its neighbours' calibration feels its mass."""
    assert "mass@shaft" in {h.effect for h in answer("wind", plan=True).cannot_see}


def with_frozen(case, index):
    """One channel shows from half an hour on, in one test, what it showed then."""
    test = case.tests[index]
    stuck = np.interp(1800.0, test.time, test.channels[0].y)
    y = np.where(test.time > 1800.0, stuck, test.channels[0].y)
    broken = replace(test, channels=(replace(test.channels[0], y=y), *test.channels[1:]))
    return replace(case, tests=tuple(broken if t is test else t for t in case.tests)), test.channels[0].name


def test_frozen_channel_is_seen_without_a_model():
    case = Truth(0).case(network())
    broken, name = with_frozen(case, 0)
    assert not broken_channels(case.tests[:1])
    (found,) = broken_channels(broken.tests[:1])
    assert found.name == f"frozen@{name}"
    time = broken.tests[0].time
    assert found.bad[time > 1800.0].all()
    assert not found.bad[time < 1740.0].any()


def test_what_is_missing_is_found_beside_a_frozen_channel():
    broken, name = with_frozen(TRUTHS["wind"]().case(), 0)
    found = diagnose(broken, plan=False)
    assert found.verdict == "data"
    assert found.named == ("convection@flange.right",)
    assert found.odds[0].hypothesis == f"frozen@{name} + convection@flange.right"
    assert found.odds[0].effects == (f"frozen@{name}", "convection@flange.right")
    assert found.odds[0].causes == ("convection@flange.right",)
    assert f"{name} in" in found.words
