"""Tangents are the derivative of the discrete scheme itself; links without strength change nothing, to the bit."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from small_networks import boundaries, every_law, inputs

from lumped.integration.compiled import compiled
from lumped.integration.simulate import Record, march, simulate
from lumped.model.build import node_link
from lumped.model.multipliers import multipliers
from lumped.model.network import Parameter
from lumped.transfer.laws import Fixed, InputPower, Power, Radiation

NETWORK = every_law()
TIME = np.arange(0.0, 1200.0, 10.0)
RECORD = Record(TIME, inputs(TIME), boundaries(TIME), 35.0)
ROWS = [NETWORK.place(node).mean for node in NETWORK.states]


def moved(parameter, step, steps):
    """On given steps: which ones are chosen is not differentiated."""
    value = parameter.value * np.exp(step) if parameter.mapping == "log" else parameter.value + step
    return simulate(NETWORK, RECORD, {parameter.name: value}, ROWS, steps=steps).y


@pytest.mark.parametrize("parameter", NETWORK.parameters[-4:], ids=lambda p: p.name)
def test_tangent_is_the_finite_difference(parameter):
    """Fourth-order central difference: truncation and rounding both near 1e-9 of the largest tangent."""
    h, run = 1e-3, simulate(NETWORK, RECORD, None, ROWS, [parameter])
    up, down, far, near = (moved(parameter, k * h, run.steps) for k in (1, -1, 2, -2))
    difference, dy = (8 * (up - down) - far + near) / (12 * h), run.dy[:, :, 0]
    assert np.abs(dy).max() > 1e-3
    assert_allclose(dy, difference, atol=1e-6 * np.abs(dy).max())


@pytest.mark.parametrize("boundary", [*NETWORK.boundaries, None])
def test_tangent_of_a_boundary_and_of_the_start(boundary):
    """By an offset (K), beside tangents of parameters, which it leaves as they are; no two nodes start equally warm,
    where a table has a kink."""
    one, h = NETWORK.parameters[:1], 1e-3

    def record(step):
        air = {n: u + step * (n == boundary) for n, u in RECORD.boundaries.items()}
        start = {n: T + step * (boundary is None) for n, T in {"a": 44.0, "b": 38.0, "c": 33.0}.items()}
        return Record(TIME, RECORD.inputs, air, start)

    run = simulate(NETWORK, record(0.0), None, ROWS, one, shifts=[boundary])

    def shifted(step):
        return simulate(NETWORK, record(step), None, ROWS, steps=run.steps).y

    difference = (8 * (shifted(h) - shifted(-h)) - shifted(2 * h) + shifted(-2 * h)) / (12 * h)
    assert np.abs(run.dy[:, :, 1]).max() > 1e-2
    assert_allclose(run.dy[:, :, 1], difference, atol=1e-6 * np.abs(difference).max())
    assert_allclose(run.dy[:, :, :1], simulate(NETWORK, record(0.0), None, ROWS, one).dy, atol=1e-12)


def test_asking_for_tangents_leaves_the_answer_as_it_is():
    assert_array_equal(
        simulate(NETWORK, RECORD, None, ROWS, NETWORK.parameters).y, simulate(NETWORK, RECORD, None, ROWS).y
    )


@pytest.mark.parametrize("steps", [1, 7, TIME.size - 1])
def test_a_run_in_portions_is_the_run_in_one(steps):
    whole = simulate(NETWORK, RECORD, None, ROWS, NETWORK.parameters, keep_states=True)
    core = compiled(NETWORK, RECORD, None, ROWS, NETWORK.parameters)
    cut = march(NETWORK, RECORD, core, keep_states=True, portion=steps)
    for name in ("z", "y", "dy"):
        assert_allclose(getattr(cut, name), getattr(whole, name), rtol=1e-12)


LAWS = {"power": Fixed(9.0, Power(0.25)), "radiation": InputPower(0.9, (("current_A", 1.0, 1.0),), Radiation())}


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_the_tangent_of_a_neutral_link_is_its_finite_difference(law):
    amplitude = Parameter("new", (("new", 1.0),), 0.0, mapping="amplitude", neutral=0.0)
    more = NETWORK.extended([node_link(NETWORK, "new", "film", "a", "ambient", law)], parameters=[amplitude])
    run, h = simulate(more, RECORD, None, ROWS, [amplitude]), 1e-5
    up, down = (simulate(more, RECORD, {"new": x}, ROWS, steps=run.steps).y for x in (h, -h))
    difference, dy = (up - down) / (2 * h), run.dy[:, :, 0]
    assert_allclose(dy, difference, atol=1e-5 * np.abs(dy).max())


def test_parameters_on_one_target_multiply():
    m = multipliers(NETWORK, {"log constant": 2.0, "square": 3.0, "relative": 0.5})
    assert m["constant"] == pytest.approx(2.0 * 9.0)
    assert m["power"] == pytest.approx(1.5)
    assert m["iron"] == pytest.approx(np.sqrt(1.5))
