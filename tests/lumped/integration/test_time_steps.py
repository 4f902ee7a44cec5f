"""Inputs that move within a sample: no node leaves what is allowed, and the length of the sample does not matter."""

import re
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Barrier

import numpy as np
import pytest
from numpy.testing import assert_allclose
from random_networks import admissible, built, machine, reference
from small_networks import two_masses

from geom.errors import ThermoscopeError
from lumped.declarations.network import read_network
from lumped.integration.compiled import FIT
from lumped.integration.signals import Signals
from lumped.integration.simulate import Record, simulate
from lumped.model.build import bare_network, node_link, node_source
from lumped.transfer.laws import Fixed, InputPower, Linear

PAGE = Path(__file__).parents[3] / "docs" / "network-toml.md"
DOCUMENTED = read_network(tomllib.loads(re.findall(r"```toml\n(.*?)```", PAGE.read_text(), re.S)[0]))
PRINCIPLE = 0.01  # K, beyond what is allowed
CURVED = (5028, 5069, 5075)  # whose error is what parabolas through the inputs miss, not what the steps do
SEEDS = range(1000, 1012)  # benchmarks/peers/time_steps.py takes a thousand


def pump(before, step):
    """The documented motor at 40 degC in 20 degC; the pump goes from `before` to 8 l/min within a sample."""
    time = np.arange(0.0, 601.0, step)
    still = dict.fromkeys(("id_A", "iq_A", "speed_rpm"), 0.0)
    given = {**still, "flow_l_min": np.where(time < 299.0, before, 8.0)}
    return Record(time, given, {"ambient": 20.0, "coolant": 20.0}, 40.0)


def finer(record, parts):
    """The same lines, with samples in between."""
    nt = record.time.size
    at = np.linspace(0, nt - 1, parts * (nt - 1) + 1)

    def between(values):
        return {k: np.interp(at, np.arange(nt), np.broadcast_to(v, nt)) for k, v in values.items()}

    time = np.interp(at, np.arange(nt), record.time)
    return Record(time, between(record.inputs), between(record.boundaries), record.initial)


@pytest.mark.parametrize(("before", "step"), [(0.0, 10.0), (0.0, 60.0), (0.1, 30.0)])
def test_a_pump_that_starts_leaves_no_node_colder_than_its_surroundings(before, step):
    record = pump(before, step)
    z = simulate(DOCUMENTED, record, keep_states=True).z
    assert z.min() > 20.0 - PRINCIPLE
    assert z.max() < 40.0 + PRINCIPLE  # all losses but a bearing's at rest are none
    assert_allclose(z, simulate(DOCUMENTED, finer(record, 60), keep_states=True).z[::60], atol=0.02)


@pytest.mark.parametrize(("seed", "most"), [*((seed, 10) for seed in SEEDS), *((seed, 40) for seed in CURVED)])
def test_a_random_network_is_where_radau_has_it(seed, most):
    """Equations, Jacobian and integrator of their own; none outside what surroundings and start allow.

    The error that a run says is that of every node, to a fifth of the largest: 3 % is left of what parabolas miss.
    """
    m = machine(seed, most)
    network, record = built(m)
    rows = [network.place(node).mean for node in network.states]
    run = simulate(network, record, rows=rows, keep_states=True)
    x, exact = run.z[:, : m.C.size], reference(m)
    span = max(exact.max(), m.around.max()) - min(exact.min(), m.around.min())
    error, (low, high) = np.abs(x - exact).max(axis=0), admissible(m)
    assert error.max() < max(0.1, 1e-3 * span)
    assert_allclose(run.time_error_K, error, atol=0.2 * error.max())
    assert low - PRINCIPLE < x.min()
    assert x.max() < high + PRINCIPLE


@pytest.mark.parametrize("seed", SEEDS[:4])
def test_the_tangents_of_a_random_network_are_its_finite_differences(seed):
    """On the steps of the run, whose choice is not differentiated."""
    network, record = built(machine(seed, 8))
    rows, h = [network.place(node).mean for node in network.states], 1e-4
    run = simulate(network, record, rows=rows, tangents=network.parameters)
    largest = np.abs(run.dy).max()
    for k, parameter in list(enumerate(network.parameters))[:: max(1, len(network.parameters) // 4)]:
        up, down = (simulate(network, record, {parameter.name: np.exp(s)}, rows, steps=run.steps).y for s in (h, -h))
        assert_allclose(run.dy[:, :, k], (up - down) / (2 * h), atol=1e-6 * largest)


def test_time_errors_of_two_runs_are_worked_out_at_once():
    """Each waits for the other: one lock for both would keep them waiting."""
    run = simulate(two_masses(), Record(np.arange(9.0), {}, {"ambient": 20.0}))
    both = Barrier(2)

    def finer():
        both.wait(timeout=10)
        return run

    with ThreadPoolExecutor(2) as pool:
        errors = list(pool.map(lambda one: one.time_error_K, [replace(run, finer=finer) for _ in range(2)]))
    assert [e.size for e in errors] == [0, 0]


def test_samples_do_not_set_the_steps_where_inputs_are_smooth():
    """A record of every second against one of every tenth: as many steps, the same at the samples they share."""
    network = two_masses(InputPower(100.0, (("current_A", 10.0, 2.0),)))

    def run(every):
        time = np.arange(0.0, 3601.0, every)
        current = {"current_A": 10.0 + 4.0 * np.sin(time / 300.0)}
        return simulate(network, Record(time, current, {"ambient": 20.0 + time / 3600.0}), keep_states=True)

    fine, coarse = run(1.0), run(10.0)
    assert fine.steps.knot.size < 120
    assert fine.steps.knot.size < 1.5 * coarse.steps.knot.size
    assert_allclose(fine.z[::10], coarse.z, atol=0.01)


def test_a_fit_looks_at_a_drive_cycle_in_fewer_steps_than_it_was_recorded_in():
    """Recorded each half second, looked at each twentieth: heat is kept."""
    recorded = np.arange(0.0, 2000.5, 0.5)
    noise = np.random.default_rng(1).standard_normal(recorded.size)
    current = 10.0 + 6.0 * np.sin(recorded / 7.0) + 0.5 * noise
    time = recorded[::40]
    network = two_masses(InputPower(100.0, (("current_A", 10.0, 2.0),)))

    def run(precision, air):
        record = Record(time, Signals.recorded({"current_A": current}, recorded, time), {"ambient": air})
        return simulate(network, record, precision=precision, keep_states=True)

    every, fit = run(FIT._replace(merged=0.0), 20.0), run(FIT, 20.0)
    assert fit.steps.knot.size < 0.6 * every.steps.knot.size
    assert_allclose(fit.z, every.z, atol=0.02)


def test_a_run_goes_on_where_another_ended():
    record = pump(0.0, 30.0)
    whole = simulate(DOCUMENTED, record, keep_states=True)
    half = record.time.size // 2

    def part(some):
        given = {k: np.broadcast_to(v, record.time.size)[some] for k, v in record.inputs.items()}
        return Record(record.time[some], given, record.boundaries, record.initial)

    first = simulate(DOCUMENTED, part(slice(0, half + 1)))
    second = simulate(DOCUMENTED, part(slice(half, None)), keep_states=True, begin=first.end)
    assert_allclose(second.z, whole.z[half:], rtol=1e-12)


def test_thermal_runaway_names_node_and_time():
    net = bare_network("runaway", {"core": 900.0, "winding": 100.0}, ("ambient",))
    links = [
        node_link(net, "in", "link", "winding", "core", Fixed(1.0)),
        node_link(net, "out", "link", "core", "ambient", Fixed(5.0)),
    ]
    loss = node_source(
        net, "copper", "copper", {"winding": 1.0}, InputPower(300.0, (("current_A", 10.0, 2.0),), Linear(0.00393, 20.0))
    )
    record = Record(np.arange(0.0, 20000.0, 60.0), {"current_A": 10.0}, {"ambient": 20.0})
    with pytest.raises(ThermoscopeError, match=r"thermal runaway at t = \d+.* s: 'winding'"):
        simulate(net.extended(links, [loss]), record)


def test_a_node_that_is_heated_beyond_all_is_no_runaway():
    net = two_masses(Fixed(1e6))
    with pytest.raises(ThermoscopeError, match=r"'winding' passes 3000 degC at t = .* more heat"):
        simulate(net, Record(np.arange(0.0, 2000.0, 60.0), {}, {"ambient": 20.0}))


@pytest.mark.parametrize(("C", "step"), [(1e-9, 36000.0), (1e-6, 1.0), (1e-3, 1e-6)])
def test_any_capacity_at_any_sample_is_right(C, step):
    """A capacity next to none follows its neighbours; a sample of ten hours is one of many steps."""
    net = bare_network("tiny", {"part": 1000.0, "air": C}, ("ambient",))
    links = [
        node_link(net, "a", "link", "part", "air", Fixed(5.0)),
        node_link(net, "b", "link", "air", "ambient", Fixed(5.0)),
    ]
    time = step * np.arange(4.0)
    z = simulate(
        net.extended(links), Record(time, {}, {"ambient": 20.0}, {"part": 100.0, "air": 60.0}), keep_states=True
    ).z
    assert_allclose(z[:, 0], 20.0 + 80.0 * np.exp(-2.5e-3 * time), atol=0.02)
    assert_allclose(z[:, 1], 0.5 * (z[:, 0] + 20.0), atol=0.02)


def test_a_boundary_that_jumps_is_a_jump():
    """A time given twice: before it nothing moves, after it the exact exponential."""
    net = bare_network("one", {"a": 100.0}, ("ambient",))
    net = net.extended([node_link(net, "a", "link", "a", "ambient", Fixed(2.0))])
    time = np.array([0.0, 50.0, 50.0, 100.0, 250.0])
    ambient = np.array([20.0, 20.0, 80.0, 80.0, 80.0])
    z = simulate(net, Record(time, {}, {"ambient": ambient}), keep_states=True).z
    assert_allclose(z[:3, 0], 20.0, atol=1e-12)
    assert_allclose(z[2:, 0], 80.0 - 60.0 * np.exp(-(time[2:] - 50.0) / 50.0), atol=0.02)
