"""Where one more thermocouple would set rivals apart best, in the tests as they were driven."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from lumped.model.network import Network, Place
from lumped.model.sites import outside, turns
from measured.case import Channel, Test
from validation.comparison.linearisation import segments
from validation.inference.evidence import Evidence
from validation.inference.result import Experiment
from validation.inference.score import Gram
from validation.planning.rivals import CompetingModels, Plan, refitted_gains, separable_pairs, separation, widened_error

SIGMA_K = 0.5  # of a further thermocouple, as a sheet's usual
PREFIX = "planned: "
HOURS = {"outside": 0.5, "inside": 4.0, "air": 2.0, "turning": 16.0}  # to mount one, from the bench's own practice
WHY = {
    "outside": "glued on from outside",
    "inside": "the machine has to be opened",
    "air": "a probe through an opening",
    "turning": "needs telemetry or slip rings",
}


def next_sensors(evidence: Evidence, models: CompetingModels) -> list[Experiment]:
    """Places without a sensor, by the deviance gap of the pair that stays closest, per hour of mounting."""
    network = evidence.fit.network
    places = {p.name: p for p in free_places(network, evidence.tests)}
    if not places:
        return []
    kinds = {name: access(network, place) for name, place in places.items()}
    plans = []
    for place, more in with_sensors(evidence, tuple(places.values()), models.group):
        tests = [with_thermocouples(t, [place]) for t in evidence.tests]
        plans.append(Plan(place.name, HOURS[kinds[place.name]], tests, separation(evidence, models, more)))
    return [
        Experiment("place", p.what, separable_pairs(evidence, p.gaps), p.gain, p.hours, WHY[kinds[p.what]])
        for p in refitted_gains(evidence, models, plans)
    ]


def free_places(network: Network, tests: Sequence[Test]) -> list[Place]:
    """Where no channel sits: parts, nodes and fluids, and the faces of parts that have several."""
    with_sensor = {c.place for t in tests for c in t.channels}
    kinds = ("part", "node", "surface", "fluid")
    return [p for p in network.places.values() if p.kind in kinds and p.name not in with_sensor]


def access(network: Network, place: Place) -> str:
    """How one gets there."""
    if place.kind == "fluid":
        return "air"
    if turns(network, place.name):
        return "turning"
    return "outside" if place.part in outside(network) and place.kind != "part" else "inside"


def with_sensors(evidence: Evidence, places: Sequence[Place], effects: Sequence[int]) -> Iterator[tuple[Place, Gram]]:
    """What a thermocouple at each place adds to the Gram matrix, its unknown bias projected out."""
    fit = evidence.fit
    columns = (*fit.unknowns.parameters, *(evidence.parameters[k] for k in effects))
    tests = [with_thermocouples(t, places) for t in evidence.tests]
    p, error = len(fit.unknowns.parameters), widened_error(evidence, tests)
    parts = segments(evidence.network, tests, fit.values, columns)
    if error:
        parts, p = [error.beside(s, p) for s in parts], p + error.size
    for place in places:
        segments_there = [s for s in parts if s.channel == PREFIX + place.name]
        # The Gram matrix of one sensor over all tests, with one bias of the usual size taken out; no residual yet
        noise = fit.noise
        X = np.vstack([noise.whiten(s, np.column_stack([s.J, np.ones(s.time.size)])) for s in segments_there])
        Z, b = X[:, :-1], X[:, -1]
        G = Z.T @ Z - np.outer(Z.T @ b, b @ Z) / (b @ b + SIGMA_K**-2)
        K = G.shape[0] - p
        yield place, Gram(G[:p, :p], G[:p, p:], G[p:, p:], np.zeros(p), np.zeros(K), 0.0)


def with_thermocouples(test: Test, places: Sequence[Place]) -> Test:
    """The test with a thermocouple at every place, and nothing else read."""
    still = np.zeros_like(test.time)
    return replace(test, channels=tuple(Channel(PREFIX + p.name, p.name, p.mean, still, SIGMA_K) for p in places))
