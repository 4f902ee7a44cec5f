"""Temperatures and heat flows of a network along a test, pair by pair of its nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from lumped.integration.balance import balance
from measured.case import Case, Test
from validation.comparison.predict import heat_model, record
from validation.parameters.unknowns import standing

if TYPE_CHECKING:
    from viz.viewer.network import NetworkRun


def network_run(case: Case, test: Test, times: Array) -> NetworkRun:
    """At the times (s) of a test: node -> degC; heat between nodes, the mean over the step that ends there."""
    from viz.figures.flows import heat_flows, last_running_step
    from viz.viewer.network import NetworkRun

    (network, values), run = heat_model(standing(case), case.model.values), record(test, {})
    heat = balance(network, run, values)
    at = np.searchsorted(heat.time, times).clip(1, heat.time.size - 1)
    mean = {n: heat.z[at, i] for i, n in enumerate([*network.states, *network.boundaries])}
    flows = heat_flows(network, heat, last_running_step(network, heat)).flows
    conductance: dict[tuple[str, str], float] = {}
    for f in flows:
        conductance[f.start, f.end] = conductance.get((f.start, f.end), 0.0) + f.conductance
    watts = {pair: np.zeros(len(at)) for pair in conductance}
    for link in network.links:
        start, end = (network.places[p].part if p in network.places else p for p in link.places)
        if (start, end) in watts and link.kind != "stream":
            watts[start, end] += heat.power(link.name)[at - 1]
    return NetworkRun(mean, watts, conductance)
