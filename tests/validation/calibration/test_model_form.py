"""Form nuisances: neutral at zero, and what they bend is what their name says."""

from dataclasses import replace

import numpy as np
import pytest
from playground import Truth, network

from lumped.integration.compiled import compiled
from lumped.integration.signals import Signals
from lumped.integration.simulate import Record
from lumped.model.build import bare_network, node_link
from lumped.model.network import Parameter
from lumped.transfer.exchanger import Exchanger, Flow
from lumped.transfer.laws import Fixed, InputPower, Law, Power, WithTemperature
from lumped.transfer.reversal import Direction
from validation.comparison.predict import predict
from validation.effects import effect, extended
from validation.effects.sensors.input_fault import Shift
from validation.parameters.model_form import ExponentError, exponent_derivative, tells_exponent, with_model_form
from validation.parameters.reference import reference_of, value_counts


def formed(net, tests, added=()):
    """With the exponents that these tests tell of."""
    return with_model_form(net, reference_of(net, tests).levels, value_counts(tests), added=added)


@pytest.fixture(scope="module")
def case():
    return Truth(3).case()


def test_neutral_at_zero(case):
    grown, names = formed(network(), case.tests)
    assert names
    for test in case.tests[1:3]:
        np.testing.assert_allclose(predict(grown, test, {}).y, predict(network(), test, {}).y, atol=1e-9)


def test_exponent_of_an_input_is_the_derivative_of_the_power():
    """Central difference of (u / 138)^n at the reference 100, with the level at the reference held."""
    u, h = {"fan_flow_m3h": np.array([60.0, 100.0, 140.0])}, 1e-4
    law = InputPower(9.0, (("fan_flow_m3h", 138.0, 1.0),))
    level = {"fan_flow_m3h": 100.0}
    found = ExponentError(law, "fan_flow_m3h", level).factor(u)

    def powered(n):
        q = u["fan_flow_m3h"] / 100.0
        return 9.0 * 100.0 / 138.0 * q**n

    np.testing.assert_allclose(found, (powered(1 + h) - powered(1 - h)) / (2 * h), rtol=1e-6, atol=1e-9)


def test_the_chord_of_a_straight_law_has_no_exponent():
    """It is the same everywhere but for rounding, of which a run would make knots without end."""
    offset = Shift(InputPower(24.1, (("flow_l_min", 10.13, 1.0),)), "flow_l_min")
    u = {"flow_l_min": np.random.default_rng(0).uniform(4.0, 8.0, 1000)}
    assert not ExponentError(offset, "flow_l_min", {"flow_l_min": 7.4}).factor(u).any()
    assert Signals(u, 1000).curve("offset", offset).value.ndim == 0


def test_a_link_between_bodies_that_follows_an_input_may_bend():
    """A gap declared between two nodes, and a constant joint beside it, each with a parameter of its own."""
    net = bare_network("gap", dict.fromkeys(("rotor", "stator"), 100.0), ("air",))
    gap = node_link(net, "gap", "link", "rotor", "stator", InputPower(2.0, (("speed_rpm", 1000.0, 0.8),)))
    joint = node_link(net, "joint", "link", "rotor", "stator", Fixed(1.0))
    own = [Parameter(x.name, ((x.name, 1.0),), prior_sd=0.3) for x in (gap, joint)]
    _, names = with_model_form(
        replace(net, links=[gap, joint], parameters=tuple(own)), {"speed_rpm": 1000.0}, {"speed_rpm": 9}
    )
    assert names == ("gap^speed_rpm",)


def test_one_input_of_two_is_bent_alone():
    """Iron loss ~ I n^1.5: the speed's exponent leaves the dependence on current as it was."""
    law = InputPower(2.0, (("current_A", 10.0, 1.0), ("speed_rpm", 1000.0, 1.5)))
    bend = ExponentError(law, "speed_rpm", {"current_A": 20.0, "speed_rpm": 500.0})
    current = np.array([5.0, 50.0])
    relative = bend.factor({"current_A": current, "speed_rpm": np.full(2, 800.0)}) / current
    assert relative[0] == pytest.approx(relative[1])


def test_difference_is_right_where_it_settles():
    law = WithTemperature(Fixed(3.0), exponent_derivative(Power(0.25)))
    table = dict(zip(law.temperature.difference, law.temperature.value))
    assert table[40.0] == 0.0
    assert table[80.0] == pytest.approx(80.0**0.25 * np.log(2.0))


@pytest.mark.parametrize("exponent", [0.25, 0.5, 1.0])
def test_no_exponent_turns_a_film_into_a_heat_pump(exponent):
    """A duct's air has no film but such: below a kelvin they would drive it away from its walls, and no step be small
    enough."""
    bend, difference = exponent_derivative(Power(exponent)), np.geomspace(1e-4, 200.0, 200)
    for moved in (-0.25, 0.25):  # the bounds of a fit: 2.5 deviations
        film = difference**exponent + moved * np.interp(difference, bend.difference, bend.value)
        assert np.all(film > 0.0)


@pytest.mark.parametrize(("exponent", "holds"), [(0.0, 1), (0.25, 0), (-0.25, 0)])
def test_a_blocked_film_with_another_exponent_promises_no_maximum_principle(exponent, holds):
    """Of a film that is blocked to a twentieth its exponent takes more than there is left, near its air: a run that has
    to keep the principle there takes ever smaller steps, without end."""
    net = bare_network("duct", {"wall": 100.0, "duct": 6.0}, ("air",))
    wall = node_link(net, "wall", "film", "wall", "duct", WithTemperature(Fixed(2.0), Power(0.25)))
    film = node_link(net, "film", "film", "duct", "air", WithTemperature(Fixed(3.0), Power(0.5)))
    own = tuple(Parameter(x.name, ((x.name, 1.0),), prior_sd=0.3) for x in (wall, film))
    net, _ = with_model_form(replace(net, links=[wall, film], parameters=own), {}, {})
    net = replace(net, parameters=(*net.parameters, Parameter("blockage", (("film", 1.0),), prior_sd=0.3)))
    record, time = {"wall": 25.0, "duct": 25.0}, np.arange(0.0, 3600.0, 60.0)
    air = np.full(time.size, 27.0)
    core = compiled(net, Record(time, {}, {"air": air}, record), {"film^dT": exponent, "blockage": 0.05})
    assert core.control.principle[0] == holds


@pytest.mark.parametrize(("kind", "counts"), [("still", 1), ("switched", 2), ("stepped", 3), ("ramped", 3)])
def test_an_input_of_two_values_has_no_exponent(case, kind, counts):
    """Nor has the speed of a law that a switch multiplies. A switch passes through what lies between in few samples."""
    t = case.tests[0]
    n = np.arange(t.time.size)
    on = (n // 40) % 2
    u = {
        "still": np.full(n.size, 100.0),
        "switched": 100.0 * on,
        "stepped": 50.0 * ((n // 40) % 3),
        "ramped": np.linspace(0.0, 100.0, n.size),
    }[kind]
    if kind == "switched":
        u[np.flatnonzero(np.diff(on))[:1]] = 30.0
    tests = [replace(t, inputs={**t.inputs, "fan_flow_m3h": u})]
    assert value_counts(tests)["fan_flow_m3h"] == counts
    assert ("fan.flow^fan_flow_m3h" in formed(network(), tests)[1]) == (counts == 3)


def test_a_switch_takes_the_exponents_of_its_product_along():
    level, counts = {"on": 0.7, "speed_rpm": 900.0}, {"on": 2, "speed_rpm": 3}
    product = InputPower(2.0, (("on", 1.0, 1.0), ("speed_rpm", 1000.0, 0.8)))
    alone = InputPower(2.0, (("speed_rpm", 1000.0, 0.8),))
    assert not tells_exponent([product], "speed_rpm", counts, level)
    assert tells_exponent([product], "speed_rpm", {**counts, "on": 1}, level)
    assert tells_exponent([alone], "speed_rpm", counts, level)
    assert tells_exponent([SumOfTwo()], "speed_rpm", counts, level)


def test_a_cooler_that_nothing_runs_through_backwards_has_no_exponent():
    """A closed circuit's heat exchanger is two laws of its flow: that of the other way is nothing."""
    forwards = Direction(Exchanger(60.0, Flow(28.0, "oil_l_min"), Flow(130.0)), "oil_l_min", 1)
    level, flow = {"oil_l_min": 8.0}, {"oil_l_min": np.array([4.0, 8.0, 12.0])}
    assert np.all(np.isfinite(ExponentError(forwards, "oil_l_min", level).factor(flow)))
    assert ExponentError(forwards, "oil_l_min", level).at_work
    assert not ExponentError(replace(forwards, way=-1), "oil_l_min", level).at_work


class SumOfTwo(Law):
    """No product: a fan's share beside that of a switch."""

    reads = ("on", "speed_rpm")

    def factor(self, inputs):
        return inputs["on"] + (inputs["speed_rpm"] / 1000.0) ** 0.8


def test_an_added_effect_brings_its_own_exponent(case):
    """Wind to the 0.8 may be wind to another power; while there is none that changes nothing."""
    wind = effect("convection@flange.right")
    grown, names = formed(extended(network(), [wind]), case.tests, {wind.name})
    own = f"{wind.name}^vehicle_speed_mps"
    assert own in names
    assert own not in formed(extended(network(), [wind]), case.tests)[1]
    road = next(t for t in case.tests if t.name == "road-1")
    still, bent = (predict(grown, road, {own: e}).y for e in (0.0, 0.2))
    np.testing.assert_allclose(still, bent, atol=1e-9)
    here = {wind.name: 5.0}
    assert np.max(np.abs(predict(grown, road, {**here, own: 0.2}).y - predict(grown, road, here).y)) > 0.01
