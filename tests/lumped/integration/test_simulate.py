"""The scheme against closed forms, a published example and its own order."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.linalg import expm
from small_networks import C1, C2, G2A, G12, boundaries, every_law, inputs, two_masses

from geom.errors import InputError, ThermoscopeError
from lumped.integration.compiled import compiled
from lumped.integration.simulate import Record, simulate
from lumped.model.build import bare_network, node_link, node_source
from lumped.numerics.stages import Steps
from lumped.transfer.laws import Fixed, InputPower, Law, Linear, Power, Table


def exact_two_masses(t, loss=100.0, start=20.0, ambient=20.0):
    A = np.array([[-G12 / C1, G12 / C1], [G12 / C2, -(G12 + G2A) / C2]])
    end = -np.linalg.solve(A, [loss / C1, G2A * ambient / C2])
    return end + expm(A * t) @ (np.full(2, start) - end)


def last(network, time, bounds=20.0, given=None):
    run = simulate(network, Record(time, given or {}, {"ambient": bounds}), keep_states=True)
    return run.z[-1, : len(network.states)]


def in_equal_steps(network, record, parts):
    """States at all samples but the first, with so many equal steps between any two knots."""
    knots = compiled(network, record).forcing.time.size
    knot = np.repeat(np.arange(1, knots), parts)
    share = np.tile(np.arange(1, parts + 1) / parts, knots - 1)
    steps = Steps(knot, share, np.zeros(knot.size, np.int64))
    return simulate(network, record, keep_states=True, steps=steps).z[1:]


def constant(seconds, every=1.0):
    return Record(np.arange(0.0, seconds + 0.5 * every, every), {}, {"ambient": 20.0})


@pytest.mark.parametrize("some", [slice(-1, None), slice(None)], ids=["at the end", "everywhere"])
def test_the_error_falls_with_the_cube_of_the_step(some):
    """Samples of 2 s lie inside steps of 12.5 to 50 s."""
    record = constant(1200, 2.0)
    exact = np.array([exact_two_masses(t) for t in record.time[1:]])
    z = [in_equal_steps(two_masses(), record, parts)[:, :2] for parts in (24, 48, 96)]
    errors = [np.abs(x - exact)[some].max() for x in z]
    assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 3.0, atol=0.2)


def test_with_every_law_and_an_algebraic_node_the_order_is_still_three():
    """Against far finer steps of the same piecewise linear record, at its samples, all states; the table has no corner
    on the way, where no scheme keeps its order."""
    time = np.arange(0.0, 801.0, 40.0)
    record = Record(time, inputs(time), boundaries(time), 40.0)
    network = every_law(Table((0.0, 60.0), (1.0, 2.6)))
    exact = in_equal_steps(network, record, 256)
    errors = [np.sqrt(np.mean((in_equal_steps(network, record, parts) - exact) ** 2)) for parts in (4, 8, 16)]
    assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 3.0, atol=0.3)


class Duty(Law):
    """100 W for 360 s, 1000 W for 240 s, in turn, times 1 + 3.03e-3 (T - 95 degC)."""

    temperature = Linear(3.03e-3, 95.0)
    reads = ("winding_W",)

    def factor(self, inputs):
        return inputs["winding_W"]


def test_modelica_heat_transfer_motor_example():
    """Modelica.Thermal.HeatTransfer.Examples.Motor: 134.3293 and 59.3203 degC at 7200 s."""
    edges = np.cumsum(np.tile([360.0, 240.0], 12))
    time = np.sort(np.concatenate([np.arange(0, 7201.0), edges[:-1]]))  # a time given twice is a jump
    loss = np.where(np.mod(time, 600.0) < 360.0, 100.0, 1000.0)
    first_of_pair = np.concatenate([time[1:] == time[:-1], [True]])
    loss[first_of_pair] = np.where(np.mod(time[first_of_pair] - 1e-6, 600.0) < 360.0, 100.0, 1000.0)
    network = two_masses(Duty(), Fixed(500.0))
    assert_allclose(last(network, time, given={"winding_W": loss}), [134.3293, 59.3203], atol=0.01)


def test_a_node_without_capacity_is_where_its_links_balance():
    network = two_masses(middle=True)
    z = in_equal_steps(network, constant(3600), 1000)
    assert_allclose(z[:, 2], z[:, :2].mean(axis=1), atol=1e-11)
    assert_allclose(z[-1, :2], exact_two_masses(3600), atol=1e-4)


def test_very_stiff_nodes_do_not_ring():
    """A 1 microjoule air node among kilojoule parts, one-minute steps: monotone, no overshoot (L-stability)."""
    net = bare_network("stiff", {"part": 1000.0, "air": 1e-6}, ("ambient",))
    links = [
        node_link(net, "a", "link", "part", "air", Fixed(5.0)),
        node_link(net, "b", "link", "air", "ambient", Fixed(5.0)),
    ]
    z = simulate(
        net.extended(links),
        Record(np.arange(0, 1800, 60.0), {}, {"ambient": 20.0}, {"part": 100.0, "air": -200.0}),
        keep_states=True,
    ).z
    assert np.all(np.diff(z[2:, 1]) < 0)
    assert_allclose(z[2:, 1], 0.5 * (z[2:, 0] + 20.0), atol=1e-3)


def test_initial_temperatures_by_place_fill_the_others_with_their_mean():
    record = Record(np.array([0.0]), {}, {"ambient": 20.0}, {"a": 30.0, "b": 40.0})
    record = Record(record.time, inputs(record.time), {"ambient": 20.0, "bench": 25.0}, record.initial)
    z = simulate(every_law(), record, keep_states=True).z
    assert_array_equal(z[0, [0, 1, 2, 4, 5]], [30.0, 40.0, 35.0, 20.0, 25.0])


def test_a_missing_input_is_named():
    time = np.arange(3.0)
    with pytest.raises(InputError, match="current_A"):
        simulate(every_law(), Record(time, {"speed_rpm": inputs(time)["speed_rpm"]}, boundaries(time)))


def test_a_missing_boundary_is_named():
    with pytest.raises(InputError, match="ambient"):
        simulate(two_masses(), Record(np.arange(3.0), {}, {"coolant": 20.0}))


def test_not_a_number_in_an_input_is_refused():
    time = np.arange(3.0)
    given = {**inputs(time), "current_A": np.array([1.0, np.nan, 2.0])}
    with pytest.raises(InputError, match="current_A"):
        simulate(every_law(), Record(time, given, boundaries(time)))


def test_falling_times_are_refused():
    with pytest.raises(InputError, match="times"):
        simulate(two_masses(), Record(np.array([0.0, 2.0, 1.0]), {}, {"ambient": 20.0}))


def test_a_node_that_nothing_holds_is_an_error_that_names_it():
    net = bare_network("loose", {"a": 1.0, "loose": 0.0}, ("ambient",))
    net = net.extended([node_link(net, "a", "link", "a", "ambient", Fixed(1.0))])
    with pytest.raises(ThermoscopeError, match="loose"):
        simulate(net, Record(np.arange(3.0), {}, {"ambient": 20.0}))


def test_a_source_of_the_square_of_a_linear_current_is_exact():
    """What is linear between the samples is the current: its square gives (a^2 + a b + b^2)/3, not (a^2 + b^2)/2."""
    net = bare_network("adiabatic", {"a": 50.0}, ("ambient",))
    law = InputPower(7.0, (("current_A", 1.0, 2.0),))
    link, source = (
        node_link(net, "none", "link", "a", "ambient", Fixed(0.0)),
        node_source(net, "s", "copper", {"a": 1.0}, law),
    )
    time = np.array([0.0, 1.0, 1.5, 4.0, 9.0])
    current = np.array([0.0, 3.0, -2.0, 1.0, 5.0])
    z = simulate(
        net.extended([link], [source]), Record(time, {"current_A": current}, {"ambient": 0.0}), keep_states=True
    ).z
    a, b = current[:-1], current[1:]
    heat = 7 * np.sum(np.diff(time) * (a * a + a * b + b * b) / 3)
    assert_allclose(z[-1, 0], 20.0 + heat / 50.0, rtol=1e-13)


def test_films_of_one_face_share_a_pattern_and_add_up():
    """Forced 3 and 7 W/K with a natural film between them on the list, against forced 10 W/K and the natural film."""
    time, body = np.arange(0.0, 1801.0, 30.0), bare_network("body", {"body": 900.0}, ("ambient",))
    record = Record(time, {"speed_rpm": 800.0 + 300.0 * np.sin(time / 200.0)}, {"ambient": 20.0}, 80.0)

    def films(**laws):
        return body.extended([node_link(body, name, "film", "body", "ambient", law) for name, law in laws.items()])

    def forced(conductance):
        return InputPower(conductance, (("speed_rpm", 1000.0, 0.8),))

    natural = Fixed(0.5, Power(0.25))
    three, two = films(a=forced(3.0), b=natural, c=forced(7.0)), films(a=forced(10.0), b=natural)
    assert compiled(three, record).terms.row.size == 1
    z, sum_of_both = (simulate(net, record, keep_states=True).z for net in (three, two))
    assert z[-1, 0] < 40.0
    assert_allclose(z, sum_of_both, atol=1e-9)
