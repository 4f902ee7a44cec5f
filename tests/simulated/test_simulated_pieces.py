"""Sensors, films, losses, vehicle and the rotor's slot pitch, each against a value from outside."""

import numpy as np
import pytest

from geom import load_machine
from simulated.physics import films, losses, materials
from simulated.physics.draws import Draws
from simulated.road import drive, halves, sensors


def test_lag_follows_a_ramp_late_by_its_time_constant():
    t = np.arange(0.0, 400.0, 10.0)
    y = sensors.lagged(t, 20 + 0.1 * t, 15.0)
    assert y[-1] == pytest.approx(20 + 0.1 * (t[-1] - 15.0), abs=1e-6)


def test_draws_do_not_depend_on_their_order():
    a, b = Draws(3), Draws(3)
    a.around("x", 1.0, 0.3)
    assert a.around("y", 1.0, 0.3) == b.around("y", 1.0, 0.3)


def test_still_air_on_a_plate_against_a_textbook():
    """Incropera 6th ed., example 9.2: glass fire screen 0.71 m, 232 against 23 degC, h = 7.0 W/m2/K."""
    assert films.natural_plate(209.0, 127.5, 0.71) == pytest.approx(7.0, rel=0.03)


def test_air_properties_against_a_table():
    """Incropera table A.4 at 300 and 400 K."""
    np.testing.assert_allclose(films.air_k([26.85, 126.85]), [0.0263, 0.0338], rtol=0.02)
    np.testing.assert_allclose(films.air_nu([26.85, 126.85]), [15.89e-6, 26.41e-6], rtol=0.02)


def test_radiation_of_a_black_surface():
    """sigma (T^4 - Ta^4) between 100 and 20 degC: 681 W/m2."""
    assert films.radiation(100.0, 20.0, 1.0) * 80.0 == pytest.approx(5.670374e-8 * (373.15**4 - 293.15**4), rel=1e-6)


def test_vehicle_at_constant_speed():
    """40 km/h on the level: power of rolling and drag over the wheels equals torque times speed in the motor."""
    car, v = drive.Vehicle(), np.array([40 / 3.6])
    amps = car.current(v, np.zeros(1), np.zeros(1))[0]
    wheels = (car.mass * 9.81 * car.rolling + 0.6 * car.drag_area * v[0] ** 2) * v[0]
    motor = (losses.L_AF * amps**2 - car.friction) * 1000 * losses.RPM
    assert motor * car.efficiency == pytest.approx(wheels, rel=1e-9)


def test_road_is_the_published_one():
    """40 km/h on average over the hour, about 1000 rpm, never above the controller's 511 A."""
    road = drive.drives(Draws(20251))["road-1"]
    assert 3.6 * road.vehicle.mean() == pytest.approx(40.0, abs=2.0)
    assert road.rpm.mean() == pytest.approx(1000.0, rel=0.05)
    assert road.current.max() <= 511.0


@pytest.fixture(scope="module")
def machine():
    return load_machine("series-dc-100kw")


@pytest.fixture(scope="module")
def built(machine):
    return halves.build(machine, 0.08, 0.02, 60)


def test_slot_pitch_times_slots_is_the_rotor(machine, built):
    corners = built.mesh.points[built.mesh.tets]
    volume = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    for part in halves.ROTOR:
        meshed = volume[built.mesh.region == built.mesh.parts.index(part)].sum() * built.copies[part]
        assert meshed == pytest.approx(machine.part(part).volume, rel=1e-3), part


def test_sensor_weights_reproduce_a_linear_field(built):
    from simulated.physics import conduction

    machine = load_machine("series-dc-100kw")
    draws = Draws(1)
    joints = materials.contacts([*built.mesh.contacts, *built.joints], draws)
    body = conduction.build(built.mesh, materials.solids(machine, draws), joints, built.copies, built.joints)
    field = body.points @ np.array([3.0, -2.0, 5.0]) + 7.0
    nodes, weights, where = sensors.locate(body, "yoke", np.array([0.155, 0.155, 0.195]))
    assert weights @ field[nodes] == pytest.approx(where @ np.array([3.0, -2.0, 5.0]) + 7.0)
    np.testing.assert_allclose(where, [0.155, 0.155, 0.195], atol=1e-3)
