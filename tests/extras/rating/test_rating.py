"""Ratings of one node against closed forms, and loss maps against their own numbers."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from extras.rating.commands.rate import holding_times
from extras.rating.envelope import Lap, rated, share_for_ever, time_to_limit, until
from extras.rating.loss_grid import loss_grid, with_losses
from extras.rating.operation import at_altitude, operation
from extras.rating.points import Duty, Model, hot_spots, mixed
from extras.rating.request import places
from extras.rating.rows import deratings
from geom.errors import InputError
from lumped.condensation.recovery import PartShape, Shapes
from lumped.integration.simulate import Record
from lumped.integration.steady import steady
from lumped.model.build import bare_network, node_link, node_source
from lumped.model.network import Link, Row
from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.laws import Fixed, InputPower, Linear
from lumped.transfer.thin_air import density

C, G, R, AIR = 1000.0, 2.0, 0.01, 20.0
TAU = C / G


def body(law=None, alpha=0.0):
    net = bare_network("body", {"body": C}, ("air",))
    film = node_link(net, "film", "film", "body", "air", law or Fixed(G))
    copper = InputPower(R, (("current_A", 1.0, 2.0),), Linear(alpha, AIR))
    loss = node_source(net, "loss:copper", "copper", {"body": 1.0}, copper)
    return net.extended([film], [loss])


def model(net=None):
    return Model(net or body(), {}, [Row(np.array([0]), np.ones(1))])


OP = operation(body(), {}, {"current_A": 50.0, "air": AIR})
LIMIT = {"body": 120.0}
REST = np.sqrt(G * 100.0 / R) / 50.0  # R I^2 = G (120 - 20)


def test_the_continuous_rating_is_the_balance():
    found = rated(model(), OP, LIMIT, "S1", None)
    assert found.at == "body"
    assert_allclose(found.load, REST, rtol=2e-3)
    assert_allclose(found.slope, 200.0 / REST, rtol=0.02)  # T - air ~ load^2


def test_a_limit_holds_at_the_hottest_point_and_that_of_a_mean_at_the_mean():
    """A coil whose one shape rises by P / k, all of it at its third point: P (1 / G + 1 / k) is the limit's rise."""
    k = 8.0
    net = replace(bare_network("coil", {"coil": C, "coil#1": 0.1 * C}, ("air",)), capacity_group=("coil", "coil"))
    own, at = Row(np.array([1]), np.ones(1)), np.array([1])
    shape = Link("shape", "conduction", ("coil", "coil"), at, at, np.ones(1), Fixed(k), own, own)
    loss = node_source(net, "loss:copper", "copper", {"coil": 1.0}, InputPower(R, (("current_A", 1.0, 2.0),)))
    loss = replace(loss, index=np.array([0, 1]), weights=np.ones(2))
    net = net.extended([node_link(net, "film", "film", "coil", "air", Fixed(G)), shape], [loss])
    V = np.column_stack([np.ones(3), [-1.0, 0.0, 1.0]])
    shapes = Shapes({"coil": PartShape(np.arange(3), None, V, np.array([0.25, 0.5, 0.25]), np.array([0, 1]))})
    net = replace(net, recovery=shapes)
    op = operation(net, {}, {"current_A": 50.0, "air": AIR})
    rows = {"coil": net.places["coil"].mean}
    for name, conductance in (("coil", 1.0 / (1.0 / G + 1.0 / k)), ("coil.mean", G)):
        limits = places({name: 120.0}, rows, net.identities)
        assert list(limits) == [name]
        spots = hot_spots(net, rows, limits)
        found = rated(Model(net, {}, spots), op, limits, "S1", None)
        assert found.at == name
        assert found.load * 50.0 == pytest.approx(np.sqrt(conductance * 100.0 / R), rel=2e-3)
        short = rated(Model(net, {}, spots), op, limits, "S2 60 min", None)
        assert short.load == pytest.approx(found.load, rel=5e-3)  # seven time constants


@pytest.mark.parametrize(("form", "seconds"), [("S2 10 s", 10.0), ("S2 60 s", 60.0), ("S2 60 min", 3600.0)])
@pytest.mark.parametrize("warm", [None, 0.6 * REST])
def test_short_times_follow_the_exponential_from_the_rest_of_a_load(form, seconds, warm):
    """load^2 = warm^2 + (rest^2 - warm^2) / (1 - e^(-t / tau)): a line through the squares."""
    begin = warm or 0.0
    expected = np.sqrt(begin**2 + (REST**2 - begin**2) / (1.0 - np.exp(-seconds / TAU)))
    assert_allclose(rated(model(), replace(OP, warm=warm), LIMIT, form, None).load, expected, rtol=3e-3)


def test_a_duty_repeats_itself():
    """Load for 240 s of 600 s, then none: T_max = rise (1 - e^(-on/tau)) / (1 - e^(-period/tau))."""
    share = (1.0 - np.exp(-240.0 / TAU)) / (1.0 - np.exp(-600.0 / TAU))
    assert_allclose(rated(model(), OP, LIMIT, "S3 40 %", None).load, REST / np.sqrt(share), rtol=3e-3)
    always = model().repeated(OP, REST, None, Duty(share=0.999999))
    assert_allclose(always, 120.0, atol=0.3)


def test_how_long_at_half_as_much_again():
    """exp(-t / tau) = 1 - 1 / 1.5^2 from cold; from rest at 75 % the rise begins at 0.75^2 of the limit."""
    cold = -TAU * np.log(1.0 - 1.0 / 2.25)
    warm = -TAU * np.log((2.25 - 1.0) / (2.25 - 0.75**2))
    assert_allclose(until(model(), OP, [120.0], 1.5 * REST, None, None), cold, rtol=5e-3)
    assert_allclose(until(model(), OP, [120.0], 1.5 * REST, None, 0.75 * REST), warm, rtol=5e-3)
    assert until(model(), OP, [120.0], 0.9 * REST, None, None) == np.inf


def test_derating_over_ambient_and_altitude():
    """Load ~ sqrt(limit - ambient); still air thins as density^0.5, so the load as its root."""
    found = {(d.where.of, d.where.value): d.load / REST for d in deratings(model(), OP, LIMIT)}
    assert_allclose(found["ambient", 60.0], np.sqrt(0.6), rtol=3e-3)
    assert_allclose(found["altitude", 4000.0], density(4000.0) ** 0.25, rtol=3e-3)
    assert_allclose(density(4000.0), 61660.0 / 101325.0, rtol=1e-4)  # at one temperature: US Standard Atmosphere 1976


@pytest.mark.parametrize("moving", ["speed_rpm", "vehicle_speed_mps", "fan_flow_m3h", "flow_percent"])
def test_blown_films_thin_more(moving):
    blown = InputPower(G, ((moving, 1000.0, 0.8),))
    thin = at_altitude(body(blown), 2000.0)
    T = steady(thin, {"current_A": 100.0, moving: 1000.0}, {"air": AIR})["body"]
    assert_allclose(T - AIR, R * 100.0**2 / (G * density(2000.0) ** 0.8), rtol=1e-6)


def test_a_limit_below_the_surroundings_is_refused():
    with pytest.raises(InputError, match=r"limit of 'body', 15 degC, is exceeded without any load \(20.0 degC\)"):
        rated(model(), OP, {"body": 15.0}, "S1", None)


def test_a_model_that_no_heat_leaves_is_refused_as_such():
    with pytest.raises(InputError, match="does not come to rest even without any load"):
        rated(model(body(Fixed(0.0))), OP, LIMIT, "S1", None)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"current_A": 5.0}, "nothing says how warm 'air' is"),
        ({"air": 20.0}, "nothing says what 'current_A' is"),
        ({"current_A": 0.0, "air": 20.0}, "the load is zero"),
        ({"amps": 1.0}, "'amps' is not an input or boundary"),
    ],
)
def test_what_is_not_known_is_asked_for(given, message):
    with pytest.raises(InputError, match=message):
        operation(body(), {}, given)


def grid(torques=(0.0, 50.0, 100.0), speeds=(0.0, 2000.0), T=(20.0,)):
    """Copper 0.02 T^2 (1 + 0.004 (T - 20)) W and its input power."""
    m, n, t = np.array([(m, n, t) for t in T for n in speeds for m in torques]).T
    copper = 0.02 * m**2 * (1.0 + 0.004 * (t - 20.0))
    columns = {"torque_Nm": m, "speed_rpm": n, "temperature_degC": t, "copper_W": copper}
    return {**columns, "input_W": m * n * np.pi / 30.0 + copper}


def test_a_map_takes_the_place_of_the_losses():
    net = with_losses(body(), loss_grid(grid(T=(20.0, 120.0)), "map.csv"), "map.csv")
    at = steady(net, {"torque_Nm": 100.0, "speed_rpm": 1000.0}, {"air": AIR})["body"]
    assert_allclose(at - AIR, 200.0 / (G - 0.8), rtol=1e-6)  # G dT = 200 (1 + 0.004 dT)


def test_a_map_heats_the_parts_of_one_loss_by_their_resistance():
    net, parts = body(), (("bottom", 1.0), ("opening", 3.0))
    laws = {name: CopperLoss(R * share, ("current_A",)) for name, share in parts}
    pieces = [node_source(net, f"loss:copper:in:{name}", "copper", {"body": 1.0}, law) for name, law in laws.items()]
    mapped = with_losses(replace(net, sources=tuple(pieces)), loss_grid(grid(), "map.csv"), "map.csv")
    at = {"torque_Nm": np.array([100.0]), "speed_rpm": np.array([0.0])}
    assert_allclose([float(s.law.factor(at)[0]) for s in mapped.sources], [50.0, 150.0])


def without(columns, k):
    return {n: np.delete(c, k) for n, c in columns.items()}


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(grid(), 1), "holes or doubles: 1 of 6 points are missing, the first at 50 Nm, 0 1/min"),
        ({n: np.append(c, c[0]) for n, c in grid().items()}, "1 points are given twice"),
        (grid() | {"copper_W": grid()["copper_W"] * 30.0}, "the powers do not balance: at 100 Nm, 0 1/min"),
        ({"torque_Nm": np.zeros(1)}, "column 'speed_rpm' is missing"),
        ({n: c for n, c in grid().items() if n != "copper_W"}, "no losses"),
        (grid() | {"voltage_V": np.array([1.0, 1, 1, 2, 2, 2])}, "the map has 2 voltages"),
    ],
)
def test_maps_that_cannot_be(columns, message):
    with pytest.raises(InputError, match=message):
        loss_grid(columns, "map.csv")


def test_a_loss_that_the_network_lacks():
    columns = {**grid(), "iron_W": np.zeros(6)}
    with pytest.raises(InputError, match="'iron_W' is not a loss of the network; known: copper"):
        with_losses(body(), loss_grid(columns, "map.csv"), "map.csv")


def test_a_load_without_rest_reaches_its_limit_in_time():
    """Resistance that grows faster than the film takes: T runs off as e^(t/tau'), tau' = C / (R alpha I^2 - G)."""
    hot = body(alpha=0.004)
    load = 10.0
    P, k = R * (50.0 * load) ** 2, 0.004 * R * (50.0 * load) ** 2 - G
    expected = C / k * np.log(1.0 + 100.0 * k / P)
    assert k > 0.0
    assert_allclose(until(model(hot), OP, [120.0], load, None, None), expected, rtol=5e-3)


def test_the_map_holds_times_and_for_ever():
    times = holding_times(model(), OP, LIMIT, (0.9 * REST, 1.5 * REST), (0.0, 1000.0))
    assert np.all(np.isinf(times[:, 0]))
    assert_allclose(times[:, 1], -TAU * np.log(1.0 - 1.0 / 2.25), rtol=5e-3)


# 100 A for 240 s of 600 s
LAP = Record(np.array([0.0, 240.0, 240.0, 600.0]), {"current_A": np.array([100.0, 100.0, 0.0, 0.0])}, {"air": AIR})


def test_a_cycle_may_be_repeated_at_a_share_of_its_load():
    """The same closed form as of S3, at 100 A where load counts as 1."""
    share, at = share_for_ever(model(), OP, LIMIT, Lap(LAP, ("current_A",)))
    most = 50.0 * REST / np.sqrt((1.0 - np.exp(-240.0 / TAU)) / (1.0 - np.exp(-600.0 / TAU)))
    assert at == "body"
    assert_allclose(share, most / 100.0, rtol=3e-3)


def test_a_cycle_reaches_its_limit_in_a_later_lap():
    """2 R I^2 in the first 240 s of every lap; laps are added up by hand until 120 degC."""
    T, t, rise = AIR, 0.0, R * 200.0**2 / G
    while True:
        end = AIR + rise + (T - AIR - rise) * np.exp(-240.0 / TAU)
        if end >= 120.0:
            t += -TAU * np.log((100.0 - rise) / (T - AIR - rise))
            break
        T, t = AIR + (end - AIR) * np.exp(-360.0 / TAU), t + 600.0
    fine = np.linspace(0.0, 240.0, 121)
    time = np.append(fine, [240.0, 600.0])
    record = Record(time, {"current_A": np.append(np.full(121, 200.0), [0.0, 0.0])}, LAP.boundaries)
    assert_allclose(time_to_limit(model(), OP, LIMIT, Lap(record, ("current_A",))), t, atol=0.5)
    assert time_to_limit(model(), OP, {"body": 500.0}, Lap(record, ("current_A",))) == np.inf


def test_mixing_finds_where_a_linear_map_repeats():
    """x = A x + b in two unknowns: two differences say all of A."""
    A, b = np.array([[0.99, 0.0], [0.1, 0.5]]), np.array([1.0, 2.0])
    pairs = [(x, A @ x + b) for x in (np.zeros(2), np.ones(2), np.array([1.0, -1.0]))]
    assert_allclose(mixed(pairs), np.linalg.solve(np.eye(2) - A, b), rtol=1e-8)
