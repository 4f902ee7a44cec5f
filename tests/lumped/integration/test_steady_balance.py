"""Steady state and heat balance."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from small_networks import boundaries, every_law, inputs, two_masses

from geom.errors import ThermoscopeError
from lumped.integration.balance import balance
from lumped.integration.simulate import Record, simulate
from lumped.integration.steady import steady
from lumped.model.build import bare_network, node_link, node_source
from lumped.transfer.laws import Fixed, Linear

NETWORK = every_law()
ROWS = [NETWORK.place(node).mean for node in NETWORK.states]
STILL = {"current_A": 12.0, "speed_rpm": 800.0}
CLOSES = 1e-4  # of the heat: a hundredth of a kelvin of a rise of 100 K
AROUND = {"ambient": 18.0, "bench": 25.0}


def test_two_masses_at_rest_are_ohms_law():
    rest = steady(two_masses(), {}, {"ambient": 20.0})
    assert rest["core"] == pytest.approx(20.0 + 100.0 / 25.0, rel=1e-12)
    assert rest["winding"] == pytest.approx(rest["core"] + 100.0 / 10.0, rel=1e-12)


def test_rest_is_where_a_long_run_ends():
    time = np.linspace(0.0, 2e5, 2001)
    run = simulate(NETWORK, Record(time, STILL, AROUND), rows=ROWS)
    assert_allclose(steady(NETWORK, STILL, AROUND, rows=ROWS).y, run.y[-1], atol=1e-8)


@pytest.mark.parametrize("parameter", NETWORK.parameters[::3], ids=lambda p: p.name)
def test_steady_tangent_is_the_finite_difference(parameter):
    def at(step):
        value = parameter.value * np.exp(step) if parameter.mapping == "log" else parameter.value + step
        return steady(NETWORK, STILL, AROUND, {parameter.name: value}, ROWS).y

    h = 1e-3
    difference = (8 * (at(h) - at(-h)) - at(2 * h) + at(-2 * h)) / (12 * h)
    dy = steady(NETWORK, STILL, AROUND, None, ROWS, [parameter]).dy[:, 0]
    assert_allclose(dy, difference, atol=1e-8 * max(np.abs(dy).max(), 1.0))


def test_thermal_runaway_is_an_error_not_a_cold_answer():
    net = bare_network("runaway", {"winding": 100.0}, ("ambient",))
    link = node_link(net, "out", "link", "winding", "ambient", Fixed(1.0))
    loss = node_source(net, "copper", "copper", {"winding": 1.0}, Fixed(300.0, Linear(0.00393, 20.0)))
    with pytest.raises(ThermoscopeError, match="runaway"):
        steady(net.extended([link], [loss]), {}, {"ambient": 20.0})


@pytest.fixture(scope="module")
def heat():
    time = np.concatenate([np.arange(0.0, 600.0, 7.0), np.arange(600.0, 1300.0, 31.0)])
    return balance(NETWORK, Record(time, inputs(time), boundaries(time), 60.0))


def test_what_goes_in_comes_out_or_stays(heat):
    """Heat flows by a quadrature of their own along the run: what is left is the error of its time steps."""
    assert np.abs(heat.residual).max() < CLOSES


def test_every_node_balances_through_its_links(heat):
    """Node a: copper in, the constant link to b and the table film to the bench out."""
    z = simulate(NETWORK, Record(heat.time, inputs(heat.time), boundaries(heat.time), 60.0), keep_states=True).z
    stored = 300.0 * (z[:, 0] - 60.0)
    left = heat.injected["copper"] - heat.through["constant"] - heat.through["table"] - stored
    assert np.abs(left).max() < CLOSES * heat.injected["copper"].max()
