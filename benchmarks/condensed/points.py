"""A condensed network and its field with the same coefficients, losses, fluids and steps: what each of them answers.

Temperatures are rises over the surroundings (K). Fluids are lumped nodes, with their streams, in both.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fem.solvers.snapshots import random_coefficients
from fem.solvers.solve import coupled, film_columns
from lumped.build.crosscheck import fluid_nodes
from lumped.build.fixed_coefficients import rated_streams, rated_watts
from lumped.build.network_size import NetworkSize
from lumped.condensation.linear import linear, unit_load
from lumped.condensation.reduction import Reduction
from lumped.model.network import Network

Floats = np.ndarray
WARM = 20.0  # K, of a coolant's inlet over the surroundings in the third load case
SPREAD = 5.0
LATE = 30.0  # s after a step of loss
STEPS = ((5.0, 12), (30.0, 18), (300.0, 22))  # s, number: two hours


@dataclass(frozen=True)
class Point:
    """One set of coefficients (W/m2/K), a factor on all streams, and the group it is reported in."""

    group: str
    name: str
    films: Mapping[str, float]
    contacts: Mapping[str, float]
    flow: float = 1.0


@dataclass(frozen=True)
class Pair:
    """A field and a network of it. watts (n_zone, n_case), heat (n_fluid, n_case) W into the fluids."""

    reduction: Reduction
    network: Network
    watts: Floats
    heat: Floats
    streams: Floats

    @classmethod
    def of(cls, found: NetworkSize) -> "Pair":
        """Load cases: rated losses, losses drawn at random, half of rated with a warm inlet or another draw."""
        machine, network, zones = found.built.machine, found.built.network, list(found.reduction.zones)
        rated, fluids = rated_watts(machine, network), fluid_nodes(network)
        own = np.array([rated.get(zone, 0.0) for zone in zones])
        rng = np.random.default_rng(7)
        one, two = (own.sum() * rng.dirichlet(np.full(len(zones), 0.5)) for _ in range(2))
        streams = rated_streams(machine, network)
        inlet = WARM * ("coolant" in network.boundaries) * streams.sum(1)
        windage = np.array([rated.get(fluid, 0.0) for fluid in fluids])
        watts = np.array([own, one, 0.5 * own if inlet.any() else two])
        return cls(found.reduction, network, watts.T, np.array([windage, 0 * inlet, inlet]).T, streams)

    @property
    def fluids(self) -> tuple[str, ...]:
        return fluid_nodes(self.network)

    @cached_property
    def field_loads(self) -> Floats:
        """(n, n_case) W"""
        return np.column_stack([*self.reduction.loads.values()]) @ self.watts

    def points(self) -> Iterator[Point]:
        """Everything the network must bear without being made anew."""
        h, g = dict(self.reduction.films), dict(self.reduction.contacts)
        yield Point("nominal", "nominal", h, g)
        for factor in (0.3, 3.0):
            yield Point("all films", f"x{factor}", _times(h, factor), g)
        for face in h:
            yield Point("one film x10", face, {**h, face: 10.0 * h[face]}, g)
        for factor in (0.2, 5.0):
            yield Point("contacts", f"all x{factor}", h, _times(g, factor))
            for contact in g:
                yield Point("contacts", f"{contact} x{factor}", h, {**g, contact: factor * g[contact]})
        gap = [face for face, film in self.reduction.field.films.items() if film.fluid == "airgap"]
        yield Point("gap, flow", "gap x4", {**h, **{face: 4.0 * h[face] for face in gap}}, g)
        yield Point("gap, flow", "flow x0.3", h, g, 0.3)
        for seed in range(4):
            yield self.random(seed)

    def random(self, seed: int) -> Point:
        """Every film, contact and the flow times 5 ** U(-1, 1), from draws that nothing was learned from."""
        rng = np.random.default_rng([2024, seed])
        h, g = (random_coefficients(c, SPREAD, rng) for c in (self.reduction.films, self.reduction.contacts))
        return Point("random", f"draw {seed}", h, g, SPREAD ** rng.uniform(-1, 1))

    def of_field(self, point: Point) -> Floats:
        """(n, n_case)"""
        K = self.reduction.field.stiffness(point.films, point.contacts)
        B, G = self._fluids(point)
        return coupled(self.reduction.solver.factor(K), self.field_loads, B, G, self.heat)[0]

    def of_network(self, point: Point) -> Floats:
        """(n_states + n_boundaries, n_case)"""
        system, b, B, G = self._system(point)
        x, u = coupled(lambda y: np.linalg.solve(system.A, y), b, B, G, self.heat)
        return self._whole(system.solid, x, u)

    def stepped(self, point: Point) -> Iterator[tuple[float, Floats, Floats]]:
        """After a step of loss from rest, backward Euler in both: time (s), field (n, n_case), network as above."""
        field, solver = self.reduction.field, self.reduction.solver
        K, (Bf, G) = field.stiffness(point.films, point.contacts), self._fluids(point)
        system, b, B, _ = self._system(point)
        T, x, t = np.zeros_like(self.field_loads), np.zeros_like(b), 0.0
        for dt, count in STEPS:
            factor, inverse = solver.factor(K, 1 / dt), np.linalg.inv(system.A + np.diag(system.C) / dt)
            for _ in range(count):
                t += dt
                T, _ = coupled(factor, self.field_loads + field.M @ T / dt, Bf, G, self.heat)
                x, u = coupled(inverse.__matmul__, b + system.C[:, None] * x / dt, B, G, self.heat)
                if t >= LATE:
                    yield t, T, self._whole(system.solid, x, u)

    def _fluids(self, point: Point) -> tuple[Floats, Floats]:
        B, D = film_columns(self.reduction.field, point.films, self.fluids)
        return B, D + point.flow * self.streams

    def _system(self, point: Point):  # type: ignore[no-untyped-def]
        system = linear(self.network, point.films, point.contacts)
        load = np.column_stack([unit_load(self.network, z, system.solid) for z in self.reduction.zones])
        columns = [list(system.fluid).index(self.network.column(name)) for name in self.fluids]
        return system, load @ self.watts, system.B[:, columns], self._fluids(point)[1]

    def _whole(self, solid: Floats, x: Floats, u: Floats) -> Floats:
        z = np.zeros((self.network.size, x.shape[1]))
        z[solid] = x
        z[[self.network.column(name) for name in self.fluids]] = u
        return z

    def smaller(self, states: int) -> "Pair":
        """The same with a network of at most so many states."""
        return replace(self, network=self.reduction.network(tolerance=0.0, max_states=states))


def _times(coefficients: Mapping[str, float], factor: float) -> dict[str, float]:
    return {name: factor * value for name, value in coefficients.items()}
