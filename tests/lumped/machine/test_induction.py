"""The cage machine against the closed forms of its equivalent circuit, its limits, and its balance of power."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_networks import two_masses

from lumped.drives.coupled import coupled, induction_drive
from lumped.drives.induction import InductionMachine
from lumped.integration.simulate import Record
from lumped.model.build import node_source
from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.laws import Fixed

MOTOR = InductionMachine(2, 0.38, 0.17, 2.5e-3, 3e-3, 82e-3, magnetising=12.5, current_limit=60.0, voltage_limit=325.0)
WARM = 110.0, 150.0  # degC of winding and cage


def grid():
    torque, speed = np.meshgrid(np.linspace(-200, 200, 21), np.linspace(-6000, 6000, 25))
    return torque.ravel(), speed.ravel()


def circuit(machine, slip, w, volts, winding_degC, cage_degC):
    """Stator and cage current (complex), torque of the T circuit at a peak phase voltage: Rs, leakage, Lm, Rr / s."""
    branch = machine.cage_resistance(cage_degC) / slip + 1j * w * machine.Lr_leak
    across = 1j * w * machine.Lm
    whole = machine.stator_resistance(winding_degC) + 1j * w * machine.Ls_leak + branch * across / (branch + across)
    stator = volts / whole
    cage = stator * across / (branch + across)
    torque = 1.5 * np.abs(cage) ** 2 * machine.cage_resistance(cage_degC) / slip * machine.pole_pairs / w
    return stator, cage, torque


def test_every_point_is_one_of_the_equivalent_circuit():
    torque, speed = grid()
    at = MOTOR.operation(*MOTOR.currents(torque, speed, *WARM), speed, *WARM)
    turns = np.abs(at.slip) > 1e-9
    w = 2.0 * np.pi * at.frequency[turns]
    stator, cage, made = circuit(MOTOR, at.slip[turns], w, at.voltage[turns], *WARM)
    assert_allclose(np.abs(stator), np.hypot(at.i_d, at.i_q)[turns], rtol=1e-9)
    assert_allclose(np.abs(cage), at.cage[turns], rtol=1e-9)
    assert_allclose(made, at.torque[turns], rtol=1e-9)


def test_power_taken_is_mechanical_power_and_losses():
    torque, speed = grid()
    at = MOTOR.operation(*MOTOR.currents(torque, speed, *WARM), speed, *WARM)
    assert_allclose(at.power, at.torque * speed * np.pi / 30 + at.stator_W + at.cage_W, rtol=1e-10, atol=1e-9)


def test_limits_are_kept_and_the_flux_is_the_rated_one_where_they_allow_it():
    torque, speed = grid()
    i_d, i_q = MOTOR.currents(torque, speed, *WARM)
    at = MOTOR.operation(i_d, i_q, speed, *WARM)
    assert at.voltage.max() <= 325.0 * (1 + 1e-9)
    assert np.hypot(i_d, i_q).max() <= 60.0 * (1 + 1e-9)
    assert np.all(np.abs(at.torque) <= np.abs(torque) * (1 + 1e-9))
    slow = (np.abs(speed) <= 1000) & (np.abs(torque) <= 140)
    assert_allclose(i_d[slow], 12.5, rtol=1e-12)
    assert_allclose(at.torque[slow], torque[slow], rtol=1e-9)


def test_random_machines_reach_the_torque_of_the_grid():
    """Driving and braking; the torque of a machine that brakes has a second maximum where its field hardly turns."""
    rng = np.random.default_rng(48)
    for way in (1.0, -1.0) * 20:
        volts, amperes, w = 10 ** rng.uniform(1.5, 3.2), 10 ** rng.uniform(0.5, 3.0), 2 * np.pi * rng.uniform(20, 400)
        Lm = volts / w / (amperes * rng.uniform(0.2, 0.6))
        R = volts / amperes * rng.uniform(0.002, 0.08, 2)
        leaks = Lm * rng.uniform(0.01, 0.15, 2)
        machine = InductionMachine(int(rng.integers(1, 7)), *R, *leaks, Lm, volts / w / Lm, amperes, volts)
        speed = w / machine.pole_pairs * 30 / np.pi * rng.uniform(0.1, 4.0)
        d, q = np.meshgrid(np.geomspace(1e-3, 1.0, 600) * machine.magnetising, way * np.linspace(0.0, amperes, 600))
        at = machine.operation(d, q, speed)
        best = np.max(way * at.torque[(at.voltage <= volts) & (np.hypot(d, q) <= amperes)])
        found = way * float(machine.torque(*machine.currents(way * 1e9, speed)))
        assert best * (1 - 1e-9) <= found <= best * 1.02, (machine, speed)  # the grid is coarser than the answer


def test_temperatures_feed_back_on_both_resistances():
    """A coil and a cage that warm: the drive's own losses are what the network is given, at their temperatures."""
    time = np.linspace(0.0, 4000.0, 201)
    network = two_masses(Fixed(0.0))
    losses = [
        node_source(network, name, "copper", {place: 1.0}, CopperLoss(R, (current,), 3.0, alpha))
        for name, place, R, current, alpha in (
            ("stator", "winding", MOTOR.Rs, "current_A", MOTOR.alpha_s),
            ("cage", "core", MOTOR.Rr, "cage_current_A", MOTOR.alpha_r),
        )
    ]
    network = network.extended(sources=losses)
    drive = induction_drive(MOTOR, np.full(201, 70.0), np.full(201, 1000.0))
    found = coupled(network, Record(time, {}, {"ambient": 20.0}), drive, {"winding": "winding", "cage": "core"})
    warm = found.run.z[-1, :2]
    assert warm.min() > 40.0
    assert found.residuals[-1] < 1e-3
    end = {name: values[-1] for name, values in found.inputs.items()}
    copper = 3.0 * MOTOR.stator_resistance(warm[0]) * end["current_A"] ** 2
    copper += 3.0 * MOTOR.cage_resistance(warm[1]) * end["cage_current_A"] ** 2
    assert end["electrical_W"] == pytest.approx(end["torque_Nm"] * 1000.0 * np.pi / 30 + copper, rel=1e-6)
    ratio = MOTOR.cage_resistance(warm[1]) / MOTOR.Rr
    assert ratio > 1.1
    slip = [found.inputs["slip"][k] * found.inputs["stator_Hz"][k] for k in (0, -1)]
    assert slip[1] / slip[0] == pytest.approx(ratio, rel=1e-6)
