"""Flows that turn round: heat is carried the other way, and what cannot be known is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from test_circuit import CHANNEL, circuit, closed, network

from geom.errors import InputError
from lumped.declarations.network import read_network
from lumped.integration.balance import balance
from lumped.integration.simulate import Record, simulate
from lumped.integration.steady import steady
from lumped.transfer.exchanger import counterflow, parallel_flow
from lumped.transfer.laws import CLOCK
from lumped.transfer.reversal import OneWay

AROUND = {"ambient": 20.0, "inlet": 20.0}
FLOW = {"flow_l_min_input": "flow_l_min"}
TWO = {"passes": [CHANNEL, {**CHANNEL, "wall": "flange"}]}


def pipe(path=("inlet", "a", "b", "c"), **more):
    """Three cells of which the middle one is heated by 100 W, and a stream of 5 W/K per l/min."""
    return read_network(
        {
            "network": {"name": "pipe", "boundaries": ["inlet", "far"]},
            "nodes": {n: {"C_J_K": 50.0, "kind": "fluid"} for n in "abc"},
            "losses": {"heat": {"kind": "constant", "at": "b", "P_W": 100.0}},
            "streams": {"water": {"path": list(path), "density_kg_m3": 1000.0, "cp_J_kgK": 300.0, **FLOW, **more}},
        }
    )


def test_heat_is_carried_downstream_whichever_way_that_is():
    """100 W into 5 W/K: +20 K in the cells behind the heated one, none before it, from the end that flows in."""
    net = pipe(backwards_from="far")
    for flow, T in ((1.0, (10.0, 30.0, 30.0)), (-1.0, (60.0, 60.0, 40.0))):
        rest = steady(net, {"flow_l_min": flow}, {"inlet": 10.0, "far": 40.0})
        assert_allclose([rest[n] for n in "abc"], T, rtol=1e-9)


@pytest.mark.parametrize("kind", ["open", "closed", "parallel"])
def test_heat_in_is_heat_out_and_stored_through_the_turn(kind):
    two = [{**CHANNEL, "branch": "a"}, {**CHANNEL, "branch": "b", "length_m": 3.0, "wall": "flange"}]
    made = {
        "open": lambda: network(circuit(**FLOW, backwards_from="ambient")),
        "closed": lambda: network(closed(**FLOW), closed=True),
        "parallel": lambda: network(circuit(**FLOW, passes=two, backwards_from="ambient")),
    }
    net, time = made[kind](), np.arange(0.0, 900.0, 2.0)
    around = {b: AROUND[b] for b in net.boundaries}
    heat = balance(net, Record(time, {"flow_l_min": 8.0 * np.cos(time / 60.0)}, around, 25.0))
    assert np.abs(heat.residual).max() < 1e-5  # the balance has a quadrature of its own


def test_backwards_the_last_wall_is_the_first_to_be_cooled():
    """Heated at the housing, which comes first: forwards it warms the flange, backwards it does not."""
    net = network(circuit(**FLOW, **TWO, backwards_from="ambient", films="fixed"))
    forwards, backwards = (steady(net, {"flow_l_min": q}, AROUND) for q in (8.0, -8.0))
    assert forwards["flange"] > 40.0
    assert backwards["flange"] < 30.0
    assert backwards["water.1.1"] == pytest.approx(forwards["water.outlet"], rel=1e-9)


def test_a_closed_loop_carries_its_heat_to_the_air_either_way():
    """At rest the exchanger gives off the loss; crossflow does not see the turn, counterflow becomes parallel flow."""
    for arrangement, alike in (("crossflow", True), ("counterflow", False)):
        loop = closed(**FLOW)
        loop["reservoir"]["arrangement"] = arrangement
        net = network(loop, closed=True)
        there, back = (steady(net, {"flow_l_min": q}, {"ambient": 20.0}) for q in (8.0, -8.0))
        into = there["water.outlet"], back["water.reservoir"]
        assert (into[0] == pytest.approx(into[1], rel=1e-6)) == alike
    assert counterflow(np.array([1.0]), np.array([0.5])) > parallel_flow(np.array([1.0]), np.array([0.5]))


@pytest.mark.parametrize("made", [pipe, lambda: network(circuit(**FLOW))], ids=["stream", "circuit"])
def test_what_comes_in_from_behind_must_be_known(made):
    net, time = made(), np.arange(0.0, 50.0, 10.0)
    inputs = {CLOCK: time, "flow_l_min": np.array([8.0, 4.0, -0.05, -3.0, -6.0])}
    with pytest.raises(InputError, match=r"flow_l_min = -3 at t = 30 s.*backwards_from"):
        simulate(net, Record(time, inputs, dict.fromkeys(net.boundaries, 20.0)))


def test_jackets_and_fans_of_machine_files_refuse_it():
    from geom import load_machine
    from lumped.machine.jackets import _rate_law, cooling_of

    machine = load_machine("ipmsm-48s8p-jacket")
    law = _rate_law(machine, "jacket", cooling_of(machine))
    assert isinstance(law, OneWay)
    with pytest.raises(InputError, match=r"flow_l_min = -5 at sample 2"):
        law.factor({"flow_l_min": np.array([5.0, -5.0])})
    assert np.all(law.factor({"flow_l_min": np.array([5.0, -0.05])}) >= 0.0)
