"""Heat is conserved in the network of every machine of the library, and its parameters have their tangents."""

import numpy as np
import pytest
from bare_networks import means_only
from library_machines import DISTINCT

from geom import load_machine
from lumped.build.pipeline import prepared
from lumped.integration.balance import balance
from lumped.integration.simulate import Record, simulate

pytestmark = pytest.mark.nightly
TIME = np.arange(0.0, 3600.0, 30.0)
INPUTS = {  # a stop, a start, a flow that varies
    "current_A": 30.0 + 10.0 * np.sin(TIME / 300.0),
    "speed_rpm": 1500.0 * np.clip(np.sin(TIME / 400.0), 0.0, 1.0),
    "fan_flow_m3h": 138.0 * (1.0 + np.cos(TIME / 500.0)),
    "flow_l_min": 8.0 + 6.0 * np.sin(TIME / 200.0),
}
AROUND = {"ambient": 20.0 + 5.0 * np.sin(TIME / 900.0), "coolant": 40.0}


@pytest.fixture(scope="module", params=DISTINCT)
def network(request):
    return means_only(prepared(load_machine(request.param), 0.1, 36))


@pytest.fixture(scope="module")
def record(network):
    read = {name for x in (*network.links, *network.sources) for name in x.law.reads}
    return Record(TIME, {n: INPUTS[n] for n in read}, {b: AROUND[b] for b in network.boundaries}, 30.0)


def test_patterns_take_at_one_end_what_they_give_at_the_other(network):
    """At uniform temperature nothing flows; what is not carried out by a stream stays between the ends."""
    n = len(network.states)
    for link in network.links:
        P = np.zeros((n, network.size))
        np.add.at(P, (link.rows, link.cols), link.vals)
        small = 1e-9 * np.abs(link.vals).max()
        assert np.abs(P.sum(axis=1)).max() < small, link.name
        if link.kind != "stream":
            assert abs(P[:, :n].sum(axis=0) @ np.ones(n) + P[:, n:].sum()) < small, link.name
            assert np.abs(P[:, :n] - P[:, :n].T).max() < small, link.name
    assert all(source.weights.sum() == pytest.approx(1.0) for source in network.sources)


def test_heat_in_is_heat_out_and_stored(network, record):
    heat = balance(network, record)
    assert sum(x[-1] for x in heat.injected.values()) > 1e4
    assert np.abs(heat.residual).max() < 1e-4
    carried = {**heat.through, **heat.injected}
    assert [name for name, x in carried.items() if np.abs(x).max() == 0.0] == []


def test_tangents_are_differences_along_any_direction(network, record):
    """On the same steps; rounding is 1e-7 K, and a step that small hardly crosses a corner of a table."""
    rows, h = [network.place(s).mean for s in network.states if s in network.places], 1e-6
    run = simulate(network, record, None, rows, network.parameters)
    way = np.random.default_rng(0).standard_normal(len(network.parameters))

    def moved(step):
        logs = [p.mapping == "log" for p in network.parameters]
        values = [
            p.value * np.exp(step * w) if log else p.value + step * w
            for p, w, log in zip(network.parameters, way, logs, strict=True)
        ]
        named = {p.name: v for p, v in zip(network.parameters, values, strict=True)}
        return simulate(network, record, named, rows, steps=run.steps).y

    dy, difference = run.dy @ way, (moved(h) - moved(-h)) / (2 * h)
    assert np.abs(dy).max() > 0.1
    np.testing.assert_allclose(dy, difference, atol=1e-5 * np.abs(dy).max() + 3e-7)
