"""The network of the 100 kW motor, derived from its field: balances, limits, and the field itself as reference."""

import numpy as np
import pytest
from library_machines import point_in

from geom import load_machine
from geom.errors import InputError
from lumped.build.crosscheck import coefficients, crosscheck, steady_state
from lumped.build.pipeline import build
from lumped.condensation.reduction import Recipe
from lumped.integration.simulate import Record, simulate
from lumped.machine.settings import Losses, contact_coefficients, read
from lumped.transfer.terms_value import coefficient

POINT = {"current_A": 200.0, "speed_rpm": 1000.0, "fan_flow_m3h": 138.0}


@pytest.fixture(scope="module", params=[pytest.param("series-dc-100kw", marks=pytest.mark.heavy)])
def motor(request):
    return build(load_machine(request.param), 0.1, 36, Recipe(tolerance=0.03))


def test_uniform_temperature_moves_no_heat(motor):
    """Every link's pattern sees only differences."""
    network = motor.network
    hidden = np.array(["#" in s for s in (*network.states, *network.boundaries)])
    z = np.where(hidden, 0.0, 37.0)
    for link in network.links:
        flow = np.zeros(network.size)
        np.add.at(flow, link.rows, link.vals * z[link.cols])
        assert np.abs(flow).max() < 1e-9 * max(1.0, np.abs(link.vals).max()), link.name


def test_steady_heat_in_equals_heat_out(motor):
    network = motor.network
    z = steady_state(network, POINT, 20.0)
    c = coefficients(network, POINT, z)
    n = len(network.states)
    fluids = [p for p in network.places.values() if p.kind == "fluid"]
    u = np.array([z[network.column(p.name)] for p in fluids])
    out = float(np.sum(c.streams @ u)) - float(c.streams.sum()) * 20.0
    for place in network.places.values():
        if place.fluid == "ambient":
            out += c.films[place.name] * (place.mean.weights @ z[place.mean.index] - z[n]) * place.area
    windage = next(s for s in network.sources if s.kind == "windage").law.factor(
        {k: np.array([v]) for k, v in POINT.items()}
    )
    assert out == pytest.approx(sum(c.watts.values()) + float(windage[0]), rel=1e-6)


def test_capacity_is_density_times_heat_times_volume(motor):
    network, machine = motor.network, motor.machine
    for part in machine.parts:
        m = machine.material_of(part.name)
        own = network.C[network.states.index(part.name)]
        assert own == pytest.approx(m.rho * m.cp * part.volume, rel=0.01), part.name


def test_network_agrees_with_its_field(motor):
    """Same mesh, same coefficients: means within 0.5 % and hot spots within 3 % of the part's own rise."""
    check = crosscheck(motor.field, motor.network, POINT)
    assert check.energy_balance < 1e-9
    assert check.worst.percent_of_rise < 3.0, check.worst
    mean_error = [abs(p.network_mean_C - p.fem_mean_C) / (p.fem_mean_C - 20.0) for p in check.parts]
    assert max(mean_error) < 0.005


def test_the_fan_takes_up_44_watts_per_kelvin(motor):
    """138 m3/h of an ideal gas, p / (R T), at 1 atm; the published 44 W/K lie between those of 20 and of 40 degC."""
    stream = next(link for link in motor.network.links if link.name == "stream:fan:air.left")
    rates = []
    for air_C in (20.0, 40.0):
        rate = coefficient(stream.law, {"fan_flow_m3h": np.array(138.0)}, air_C, 0.0) * stream.vals.max()
        density = 101_325.0 / (287.05 * (air_C + 273.15))
        assert rate == pytest.approx(density * 1006.5 * 138.0 / 3600.0, rel=5e-3)
        rates.append(rate)
    assert rates[1] < 44.0 < rates[0]


def test_no_loss_no_rise(motor):
    time = np.linspace(0.0, 3600.0, 61)
    signals = {"current_A": 0.0 * time, "speed_rpm": 0.0 * time, "fan_flow_m3h": 0.0 * time + 138.0}
    run = simulate(motor.network, Record(time, signals, {"ambient": 0.0 * time + 20.0}, 20.0), keep_states=True)
    named = [i for i, s in enumerate(motor.network.states) if "#" not in s]
    assert np.abs(run.z[:, named] - 20.0).max() < 1e-8


def test_a_point_reads_what_the_field_shows(motor):
    network = motor.network
    x = steady_state(network, POINT, 20.0)[: len(network.states)]
    xyz = np.array(point_in(motor.machine, "yoke"))
    row = network.recovery.row("yoke", xyz)
    coolest, hottest = network.recovery.of_part("yoke", x).min(), network.recovery.of_part("yoke", x).max()
    assert coolest <= row.weights @ x[row.index] <= hottest


def test_a_point_beside_a_surface_reads_the_surface(motor):
    """A millimetre off the middle of an outer facet whose corners are further away than a reading may be moved."""
    network = motor.network
    shape, x = network.recovery.parts["yoke"], steady_state(network, POINT, 20.0)[: len(network.states)]
    facets = shape.xyz[shape.tets[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]]].reshape(-1, 3, 3)
    middle = facets.mean(axis=1)
    far = np.linalg.norm(facets - middle[:, None], axis=2).min(axis=1) > 0.005
    there = middle[far][np.argmax(np.hypot(*middle[far, :2].T))]
    beside = there + 0.001 * np.array([*(there[:2] / np.hypot(*there[:2])), 0.0])
    at, off = (network.recovery.row("yoke", xyz) for xyz in (there, beside))
    rise = np.ptp(network.recovery.of_part("yoke", x))
    assert off.weights @ x[off.index] == pytest.approx(at.weights @ x[at.index], abs=0.05 * rise)


def test_a_point_outside_its_part_is_refused(motor):
    with pytest.raises(InputError, match=r"is not in part 'yoke'.*nearest point"):
        motor.network.recovery.row("yoke", np.array([1.0, 1.0, 1.0]))


def test_unknown_loss_is_refused_with_a_suggestion():
    with pytest.raises(InputError, match=r"unknown key 'windage'.*did you mean 'windage_W'"):
        read(Losses, {"windage": 3.0}, "motor [losses]")


@pytest.mark.parametrize("entry", [{"gap_mm": 0.0}, {"gap": 0.1}, 5.0])
def test_a_contact_needs_a_positive_gap_or_coefficient(entry):
    with pytest.raises(InputError, match=r"is not a contact.*gap_mm"):
        contact_coefficients({"a|b": entry}, ["a|b"], "motor [contacts]")


def test_gap_of_still_air_is_a_coefficient():
    assert contact_coefficients({"default": {"gap_mm": 0.026}}, ["a|b"], "here") == pytest.approx({"a|b": 1000.0})
