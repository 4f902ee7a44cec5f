"""What the viewer shows of a test beside temperatures: the error between the sensors, and heat between nodes.

The error is interpolated by the model's own covariance at the end of a test.
"""

from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from lumped.integration.balance import balance
from lumped.integration.simulate import simulate
from measured.case import Case, Channel, Test
from thermoscope.case_folder.folder import Folder
from validation.bands.posterior import deviation
from validation.calibration.model_error import with_doubts
from validation.comparison.interpolation import Interpolated, interpolated
from validation.comparison.predict import heat_model, record
from validation.parameters.unknowns import standing

if TYPE_CHECKING:
    from viz.rendering.nodes import SplitMesh
    from viz.viewer.part_shapes import NetworkRun


def error_gain(folder: Folder, test: Test, nodes: "SplitMesh") -> tuple[tuple[Channel, ...], Interpolated]:
    """Sensors that read at the end of a test, and what each kelvin that one of them is off by tells elsewhere.

    Its mean is (n_nodes, n_channels) K/K. Doubts: every parameter within its interval, where it has one, else its
    prior, as if apart from the others; and the model error of validation.calibration.model_error.
    """
    case, intervals = folder.case, folder.case.model.intervals
    network, values = heat_model(standing(case), case.model.values)
    larger = with_doubts(network, case.doubt)[0]
    doubted = [p for p in larger.parameters if p.prior_sd > 0]
    end = simulate(larger, record(test, {}), values, tangents=doubted).end
    D = end.D[: len(larger.states)] * np.array([deviation(p, intervals.get(p.name)) for p in doubted])
    there = larger.on_parts(nodes.parts, D)
    late, width = last_fifth(test), len(larger.states) + len(larger.boundaries)
    channels = tuple(c for c in test.channels if np.isfinite(np.asarray(c.y, float)[late]).any())
    here = np.array([c.row.dense(width)[: len(larger.states)] @ D for c in channels])
    noise_K = np.array([np.hypot(c.sigma_K, c.model_K) for c in channels])
    return channels, interpolated(there, here, np.eye(len(channels)), noise_K)


def last_fifth(test: Test) -> slice:
    """Of its samples."""
    return slice(int(0.8 * len(test.time)), None)


def network_run(case: Case, test: Test, times: Array) -> "NetworkRun":
    """At the times (s) of a test: node -> degC; heat between nodes, the mean over the step that ends there."""
    from viz.figures.flows import heat_flows, last_running_step
    from viz.viewer.part_shapes import NetworkRun

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
