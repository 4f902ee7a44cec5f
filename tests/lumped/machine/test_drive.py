"""The series machine against its ratings and equations; duty types against their definitions."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from lumped.drives.drive import Controller, SeriesMachine, Vehicle, drive_cycle
from lumped.drives.duty import s1, s2, s3, s6

MACHINE = SeriesMachine.from_ratings(100e3, 1000.0, 220.0, 511.0)
VEHICLE = Vehicle(mass=9000.0, wheel_radius=0.48, gear=4.52)


def load_torque(vehicle, speed_mps, slope):
    """At the motor shaft, steady (N m). Downhill the gear takes its loss off the drive."""
    T = vehicle.wheel_torque(speed_mps, slope)
    return np.where(T > 0.0, T / vehicle.efficiency, T * vehicle.efficiency)


def test_ratings_give_the_published_constants():
    """Seed 0: L_af = 3.657 mH, R_a + R_f = 47.6 mOhm, loss 12.42 kW, back-EMF 195.7 V."""
    assert MACHINE.L_af == pytest.approx(3.657e-3, rel=2e-4)
    assert pytest.approx(47.6e-3, rel=1e-3) == MACHINE.R
    assert MACHINE.losses(511.0) == pytest.approx(12.42e3, rel=1e-3)
    assert MACHINE.voltage(511.0, 1000.0) - MACHINE.R * 511.0 == pytest.approx(195.7, abs=0.05)


@pytest.fixture(scope="module")
def climb():
    time = np.arange(0.0, 301.0)
    wanted = np.clip(time / 60.0, 0.0, 1.0) * 40 / 3.6
    return drive_cycle(MACHINE, VEHICLE, Controller(), time, wanted, np.full(301, 0.04))


def test_on_the_slope_the_machine_carries_the_load(climb):
    """40 km/h up 4 %: about 1000 1/min, torque = load, V = R I + w L_af I."""
    load = load_torque(VEHICLE, 40 / 3.6, 0.04)
    assert climb.vehicle_speed_mps[-1] == pytest.approx(40 / 3.6, rel=1e-3)
    assert climb.speed_rpm[-1] == pytest.approx(1000.0, rel=0.02)
    assert climb.torque_Nm[-1] == pytest.approx(load, rel=5e-3)
    assert climb.voltage_V[-1] == pytest.approx(MACHINE.voltage(climb.current_A[-1], climb.speed_rpm[-1]), rel=5e-3)


def test_limits_are_kept(climb):
    assert climb.current_A.max() <= 511.0 * (1 + 1e-9)
    assert climb.voltage_V.max() <= 220.0


def test_shaft_work_is_kinetic_energy_and_load(climb):
    """L_af I^2 w over the ramp, from the mean-square current that heats the machine; 1 % for the 1 s sampling."""
    omega = climb.speed_rpm * np.pi / 30
    load = load_torque(VEHICLE, climb.vehicle_speed_mps, 0.04)
    needed = 0.5 * (MACHINE.J + VEHICLE.inertia()) * omega[-1] ** 2 + np.trapezoid(load * omega, climb.time)
    given = np.sum(MACHINE.torque(climb.current_A)[1:] * 0.5 * (omega[1:] + omega[:-1]))
    assert given == pytest.approx(needed, rel=0.01)


def test_a_finer_inner_step_gives_the_same_currents(climb):
    slope = np.full(301, 0.04)
    wanted = np.clip(climb.time / 60.0, 0.0, 1.0) * 40 / 3.6
    fine = drive_cycle(MACHINE, VEHICLE, Controller(), climb.time, wanted, slope, step=1e-3)
    assert_allclose(fine.current_A, climb.current_A, rtol=0.01, atol=1.0)


def stop_and_go(vehicle):
    """40 km/h and back every 100 s; the profile, what is driven, and the current that exactly this takes (A, rms)."""
    time = np.arange(0.0, 600.0, 0.5)
    wanted = np.interp(time % 100, [0, 5, 25, 55, 65, 100], [0, 0, 1, 1, 0, 0]) * 40 / 3.6
    course = drive_cycle(MACHINE, vehicle, Controller(), time, wanted, np.zeros(time.size))
    gathers = (MACHINE.J + vehicle.inertia()) * np.gradient(wanted, time) * vehicle.gear / vehicle.wheel_radius
    torque = np.where(wanted > 0, load_torque(vehicle, wanted, 0.0), 0.0) + gathers
    driven = np.where(torque > 0, torque, vehicle.regeneration * -torque)
    return time, wanted, course, np.sqrt(np.mean(np.minimum(driven / MACHINE.L_af, 511.0**2)))


@pytest.mark.parametrize("share", [0.0, 0.3])
def test_a_vehicle_with_brakes_stops_and_takes_the_current_of_its_profile(share):
    _, wanted, course, exact = stop_and_go(replace(VEHICLE, regeneration=share))
    assert np.sqrt(np.mean(course.current_A**2)) == pytest.approx(exact, rel=0.015)
    assert course.vehicle_speed_mps[wanted == 0.0][-1] == 0.0
    without = stop_and_go(replace(VEHICLE, brakes=0.0, regeneration=0.0))[2]
    assert np.sqrt(np.mean(without.current_A**2)) < 0.9 * exact


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_energy_from_the_supply_is_copper_brakes_and_load(share):
    """At rest at both ends; 0.1 % for the 0.5 s at which the load is sampled."""
    vehicle = replace(VEHICLE, regeneration=share)
    time, _, course, _ = stop_and_go(vehicle)
    load = np.trapezoid(load_torque(vehicle, course.vehicle_speed_mps, 0.0) * course.speed_rpm * np.pi / 30, time)
    step = np.diff(time)
    spent = step @ (MACHINE.R * course.current_A**2 + course.brake_W)[1:] + load
    assert step @ course.electrical_W[1:] == pytest.approx(spent, rel=1e-3)
    assert bool(course.torque_Nm.min() < -100.0) is (share > 0.0)


def test_a_slope_is_held_down_and_at_rest():
    """Downhill at 40 km/h and then at rest on the slope, by the brakes alone."""
    time = np.arange(0.0, 200.0)
    wanted = np.interp(time, [0, 40, 100, 120, 200], [0, 1, 1, 0, 0]) * 40 / 3.6
    course = drive_cycle(MACHINE, VEHICLE, Controller(), time, wanted, np.full(200, -0.06))
    assert course.vehicle_speed_mps[99] == pytest.approx(40 / 3.6, rel=0.05)
    assert course.vehicle_speed_mps[-1] == 0.0
    assert course.current_A[60:].max() < 1.0


@pytest.mark.parametrize(
    ("duty", "mean"),
    [(s1(3600.0), 1.0), (s2(600.0, 1800.0), 0.25), (s3(600.0, 0.4, 5), 0.4), (s6(600.0, 0.4, 5, 0.1), 0.46)],
)
def test_duty_types_load_for_their_share_of_the_time(duty, mean):
    time, load = duty
    assert np.trapezoid(load, time) / time[-1] == pytest.approx(mean, rel=1e-12)
    assert np.all(np.diff(time) >= 0)
