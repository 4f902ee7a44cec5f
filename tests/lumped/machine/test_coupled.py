"""The permanent-magnet machine against closed forms, and drives coupled to their temperatures."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_networks import two_masses

from geom.errors import ThermoscopeError
from lumped.drives.coupled import coupled, pm_drive, series_drive
from lumped.drives.drive import Controller, SeriesMachine, Vehicle
from lumped.drives.permanent_magnet import PMMachine
from lumped.integration.simulate import Record
from lumped.integration.steady import steady
from lumped.model.build import bare_network, node_link, node_source
from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.laws import Fixed, InputPower, Linear

MOTOR = PMMachine(4, 4.67e-3, 0.1e-3, 0.25e-3, 0.07, current_limit=400.0, voltage_limit=200.0)


def test_without_saliency_the_current_is_torque_over_flux():
    round_rotor = PMMachine(4, 4.67e-3, 0.2e-3, 0.2e-3, 0.07, 400.0, 200.0)
    i_d, i_q = round_rotor.currents(np.array([-80.0, 0.0, 80.0]), 1000.0)
    assert_allclose(i_d, 0.0, atol=1e-9)
    assert_allclose(i_q, np.array([-80.0, 0.0, 80.0]) / (6 * 0.07), atol=1e-6)


def random_machine(rng):
    """Without saliency, with either one; psi / Ld below and above the current limit; up to eight times base speed."""
    amperes, volts, pairs = 10 ** rng.uniform(0.5, 2.8), 10 ** rng.uniform(1.3, 2.8), int(rng.integers(1, 9))
    Ld = 1e-3 * volts / amperes / pairs * 10 ** rng.uniform(-0.7, 0.5)
    Lq = Ld * rng.choice([1.0, rng.uniform(1.0, 5.0), rng.uniform(0.3, 1.0)])
    psi, R = Ld * amperes * 10 ** rng.uniform(-1.0, 0.7), rng.uniform(0.0, 0.08) * volts / amperes
    base = volts / pairs / (psi + Ld * amperes) * 30 / np.pi
    machine = PMMachine(pairs, R, Ld, Lq, psi, amperes, volts)
    return machine, base * 10 ** rng.uniform(-1.0, 0.9) * rng.choice([-1.0, 1.0]), rng.choice([-1.0, 1.0])


def allowed(machine, i_d, i_q, speed):
    kept = np.hypot(i_d, i_q) <= machine.current_limit * (1 + 1e-9)
    return kept & (machine.voltage(i_d, i_q, speed) <= machine.voltage_limit * (1 + 1e-9))


def test_the_most_torque_is_that_of_a_grid_over_both_currents():
    """Within 0.5 %, driving and braking; a grid of 0.3 % of the current limit can only miss some of it."""
    rng, compared = np.random.default_rng(48), 0
    radius, angle = np.sqrt(np.linspace(0.0, 1.0, 300))[:, None], np.linspace(0.0, 2 * np.pi, 600)
    for _ in range(120):
        machine, speed, way = random_machine(rng)
        d, q = machine.current_limit * radius * np.cos(angle), machine.current_limit * radius * np.sin(angle)
        torque = way * machine.torque(d, q)[allowed(machine, d, q, speed)]
        i_d, i_q = machine.currents(way * 1e9, speed)
        if torque.size < 1000:
            continue  # the limits allow next to nothing: a grid says little
        assert allowed(machine, i_d, i_q, speed), machine
        assert allowed(machine, *machine.currents(0.0, speed), speed), machine  # no torque, where only braking is
        found, compared = way * float(machine.torque(i_d, i_q)), compared + 1
        assert found >= torque.max() - 5e-3 * np.abs(torque).max(), (machine, speed, way)
    assert compared > 60


def test_a_torque_within_reach_is_given_by_the_least_current():
    """Against every i_d of a fine grid at the same torque."""
    rng, compared = np.random.default_rng(4), 0
    for _ in range(200):
        machine, speed, way = random_machine(rng)
        most = machine.torque(*machine.currents(way * 1e9, speed))
        torque = rng.uniform(0.02, 1.0) * most
        if way * most <= 0.0:
            continue
        d = np.linspace(-machine.current_limit, machine.current_limit, 20001)
        q = torque / machine.torque(d, 1.0)
        kept = allowed(machine, d, q, speed)
        if not kept.any():
            continue  # between two of the grid, or less than what braking there makes at least
        i_d, i_q = machine.currents(torque, speed)
        compared += 1
        assert machine.torque(i_d, i_q) == pytest.approx(torque, rel=1e-6)
        assert allowed(machine, i_d, i_q, speed)
        assert np.hypot(i_d, i_q) <= np.hypot(d, q)[kept].min() * (1 + 1e-6)
    assert compared > 120


@pytest.mark.parametrize(("torque", "speed"), [(136.0, 3000.0), (60.0, 9000.0), (-60.0, 9000.0), (60.0, -9000.0)])
def test_electrical_power_is_mechanical_power_and_copper(torque, speed):
    i_d, i_q = MOTOR.currents(torque, speed, 120.0, 90.0)
    copper = 1.5 * MOTOR.resistance(120.0) * (i_d**2 + i_q**2)
    mechanical = MOTOR.torque(i_d, i_q, 90.0) * speed * np.pi / 30
    assert MOTOR.power(i_d, i_q, speed, 120.0, 90.0) == pytest.approx(mechanical + copper, rel=1e-12)


def pm_network():
    net = bare_network("pm", {"winding": 3700.0, "stator": 5600.0, "magnet": 5300.0}, ("ambient",))
    links = [
        node_link(net, "ws", "link", "winding", "stator", Fixed(70.0)),
        node_link(net, "sr", "link", "stator", "magnet", Fixed(3.0)),
        node_link(net, "sa", "link", "stator", "ambient", Fixed(20.0)),
    ]
    copper = CopperLoss(4.67e-3, ("id_A", "iq_A"), 1.5)
    iron = InputPower(300.0, (("speed_rpm", 4000.0, 1.5),))
    sources = [
        node_source(net, "copper", "copper", {"winding": 1.0}, copper),
        node_source(net, "iron", "iron", {"stator": 0.6, "magnet": 0.4}, iron),
    ]
    return net.extended(links, sources)


def test_coupled_run_ends_where_a_steady_solution_stands():
    """At rest winding and magnet temperatures and the currents they need fit together."""
    net, time = pm_network(), np.linspace(0.0, 20000.0, 401)
    drive = pm_drive(MOTOR, np.full(401, 100.0), np.full(401, 2000.0))
    found = coupled(net, Record(time, {}, {"ambient": 30.0}), drive, {"winding": "winding", "magnet": "magnet"})
    assert found.residuals[-1] < 1e-3 < found.residuals[0]
    end = {k: float(v[-1]) for k, v in found.inputs.items()}
    rest = steady(net, end, {"ambient": 30.0})
    assert found.run.z[-1, :3] == pytest.approx(rest.z[:3], abs=0.01)
    again = MOTOR.currents(100.0, 2000.0, rest["winding"], rest["magnet"])
    assert (end["id_A"], end["iq_A"]) == pytest.approx(tuple(float(x) for x in again), rel=1e-4)


def test_runaway_is_an_error_that_shows_the_last_changes():
    net = bare_network("hot", {"winding": 500.0}, ("ambient",))
    net = net.extended(
        [node_link(net, "out", "link", "winding", "ambient", Fixed(1.0))],
        [node_source(net, "loss", "copper", {"winding": 1.0}, InputPower(1.0, (("P", 1.0, 1.0),)))],
    )
    time = np.linspace(0.0, 1500.0, 51)
    record = Record(time, {}, {"ambient": 20.0})
    with pytest.raises(ThermoscopeError, match="do not agree"):
        coupled(net, record, lambda T: {"P": 2.0 * T["winding"]}, {"winding": "winding"}, most=3)


def test_runaway_in_a_round_is_said_as_such():
    net = bare_network("hot", {"winding": 50.0}, ("ambient",))
    link = node_link(net, "out", "link", "winding", "ambient", Fixed(1.0))
    loss = node_source(
        net, "loss", "copper", {"winding": 1.0}, InputPower(300.0, (("P", 1.0, 1.0),), Linear(0.01, 20.0))
    )
    record = Record(np.linspace(0.0, 5000.0, 51), {}, {"ambient": 20.0})
    with pytest.raises(ThermoscopeError, match=r"runaway at t = .* 'winding'"):
        coupled(net.extended([link], [loss]), record, lambda T: {"P": np.ones(51)}, {"winding": "winding"})


def test_a_warm_series_machine_takes_the_current_the_load_asks_and_more_voltage():
    machine = SeriesMachine.from_ratings(100e3, 1000.0, 220.0, 511.0)
    vehicle = Vehicle(mass=9000.0, wheel_radius=0.48, gear=4.52)
    time = np.arange(0.0, 1801.0, 2.0)
    wanted = np.clip(time / 60.0, 0.0, 1.0) * 30 / 3.6
    network = two_masses(InputPower(0.012, (("current_A", 1.0, 2.0),), Linear(0.00393, 20.0)))
    drive = series_drive(machine, vehicle, Controller(), time, wanted, np.full(time.size, 0.02))
    found = coupled(network, Record(time, {}, {"ambient": 20.0}), drive, {"winding": "winding"})
    assert found.run.z[-1, 0] > 60.0
    assert found.residuals[-1] < 1e-3
    warm = machine.R * (1 + 0.00393 * (found.run.z[-1, 0] - 20.0))
    i, n = found.inputs["current_A"][-1], found.inputs["speed_rpm"][-1]
    assert found.inputs["voltage_V"][-1] == pytest.approx((warm + machine.L_af * n * np.pi / 30) * i, rel=5e-3)
