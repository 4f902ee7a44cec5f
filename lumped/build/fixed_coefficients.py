"""A field and its network with the same coefficients, losses and streams, all of them fixed: what each answers.

Temperatures are rises over the surroundings (K): of a field's unknowns, then of its fluids.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from fem.matrices.assembly import FieldModel
from fem.solvers.snapshots import random_coefficients
from fem.solvers.solve import Solver, coupled, film_columns
from geom import InputError, Machine
from geom.arrays import Numbers
from lumped.build.crosscheck import coefficients, fluid_nodes
from lumped.build.pipeline import means_network
from lumped.condensation.linear import linear, unit_load
from lumped.condensation.recovery import Shapes
from lumped.condensation.reduction import Reduction
from lumped.condensation.reduction_error import LoadCases, random_load_cases
from lumped.machine.air import INTAKE_USUAL_C
from lumped.machine.films import surroundings
from lumped.machine.loss_sources import loss_watts, place_of
from lumped.machine.motor import rated_inputs
from lumped.model.network import Array, Network

STEPS = ((10.0, 6), (60.0, 9), (600.0, 10))  # s, number: a step of loss from a minute to two hours


@dataclass(frozen=True)
class FixedCoefficients:
    """films, contacts (W/m2/K); watts : part -> W; fluids with the matrix of their streams (W/K) and their heat (W)."""

    films: Mapping[str, float]
    contacts: Mapping[str, float]
    watts: Mapping[str, float]
    fluids: tuple[str, ...]
    streams: Array
    heat: Array

    def moved(self, spread: float, seed: int = 0) -> "FixedCoefficients":
        """The same with every film and contact times spread ** U(-1, 1)."""
        rng = np.random.default_rng(seed)
        films, contacts = (random_coefficients(of, spread, rng) for of in (self.films, self.contacts))
        return replace(self, films=films, contacts=contacts)

    def of_field(self, field: FieldModel) -> Array:
        """(n + n_fluid,) steady."""
        factor = Solver(field).factor(field.stiffness(self.films, self.contacts))
        return self._together(factor, self._load(field), *self._fluids(field))

    def influence(self, field: FieldModel, rows: Callable[[Array], Array]) -> tuple[Array, Array]:
        """Steady T (n,), and what 1 W anywhere adds to each of the readings rows(T) (n, k): (n, k) K/W."""
        factor = Solver(field).factor(field.stiffness(self.films, self.contacts))
        B, G = self._fluids(field)
        T = self._together(factor, self._load(field), B, G)[: field.n]
        readings = rows(T)
        return T, coupled(factor, readings, B, G.T, np.zeros((len(self.fluids), readings.shape[1])))[0]

    def steps_of_field(self, field: FieldModel) -> Iterator[Array]:
        """(n + n_fluid,) after each of STEPS of backward Euler from rest."""
        solver, K, T = Solver(field), field.stiffness(self.films, self.contacts), np.zeros(field.n)
        for dt, count in STEPS:
            factor = solver.factor(K, 1 / dt)
            for _ in range(count):
                out = self._together(factor, self._load(field) + field.M @ T / dt, *self._fluids(field))
                T = out[: field.n]
                yield out

    def of_network(self, network: Network, field: FieldModel) -> Array:
        """(n + n_fluid,) steady, as recovered from the network's states."""
        system = linear(network, self.films, self.contacts)
        x = self._together(np.linalg.inv(system.A).__matmul__, *self._on(network, field))
        return self._recovered(network, x)

    def steps_of_network(self, network: Network, field: FieldModel) -> Iterator[Array]:
        """The same after each step."""
        system, (b, B, G) = linear(network, self.films, self.contacts), self._on(network, field)
        x = np.zeros(len(b))
        for dt, count in STEPS:
            inverse = np.linalg.inv(system.A + np.diag(system.C) / dt)
            for _ in range(count):
                out = self._together(inverse.__matmul__, b + system.C * x / dt, B, G)
                x = out[: len(b)]
                yield self._recovered(network, out)

    def _together(self, inverse: Callable[[Array], Array], b: Array, B: Array, G: Array) -> Array:
        x, u = coupled(inverse, b[:, None], B, G, self.heat[:, None])
        return np.concatenate([x[:, 0], u[:, 0]])

    def _load(self, field: FieldModel) -> Array:
        return field.losses(self.watts)

    def _fluids(self, field: FieldModel) -> tuple[Array, Array]:
        B, D = film_columns(field, self.films, self.fluids)
        alone = [name for name, row in zip(self.fluids, D + self.streams, strict=True) if not row.any()]
        if alone:
            right = "a closed void between its solids, such as the space around the end windings"
            raise InputError(f"{alone[0]} touches no part", "the machine", right)
        return B, D + self.streams

    def _on(self, network: Network, field: FieldModel) -> tuple[Array, Array, Array]:
        """Load, film columns and the fluids' matrix on a network's solid states."""
        system = linear(network, self.films, self.contacts)
        load = sum((q * unit_load(network, p, system.solid) for p, q in self.watts.items()), np.zeros(len(system.C)))
        columns = [list(system.fluid).index(network.column(name)) for name in self.fluids]
        return load, system.B[:, columns], self._fluids(field)[1]

    def _recovered(self, network: Network, x: Array) -> Array:
        shapes, states = network.recovery, np.zeros(len(network.states))
        assert isinstance(shapes, Shapes)
        solid = len(x) - len(self.fluids)
        fluids = {network.column(name) for name in self.fluids}
        states[[i for i in range(len(states)) if i not in fluids]] = x[:solid]
        return np.concatenate([shapes.field(states), x[solid:]])


def rated(
    machine: Machine, network: Network, films: Mapping[str, float], contacts: Mapping[str, float]
) -> FixedCoefficients:
    """The rated point of a machine, its windings at their reference temperature, whole parts heated."""
    watts, fluids = dict(rated_watts(machine, network)), fluid_nodes(network)
    heat = np.array([watts.pop(name, 0.0) for name in fluids])
    whole: dict[str, float] = {}
    for place, q in watts.items():
        part = place_of(network, place).part
        whole[part] = whole.get(part, 0.0) + q
    if not any(whole.values()):
        right = "a loss, and in [ratings] what its law reads"
        raise InputError("nothing heats it at its rated point", f"{machine.name} [losses]", right)
    return FixedCoefficients(films, contacts, whole, fluids, rated_streams(machine, network), heat)


def load_cases(machine: Machine, reduction: Reduction) -> LoadCases:
    """The losses of the rated point with its fluids, and variations of them, as the guard applies them."""
    whole = means_network(machine, reduction)
    rated = rated_watts(machine, whole)
    return random_load_cases(
        list(reduction.zones), list(reduction.washing), rated, fluid_rises(machine, reduction, whole, rated)
    )


def rated_watts(machine: Machine, network: Network) -> Numbers:
    """Watts per part or zone at the rated point, windings at their reference temperature."""
    return loss_watts(machine, network, rated_inputs(machine))


def rated_streams(machine: Machine, network: Network) -> Array:
    """The streams' matrix (W/K) among the fluids at the rated point, for coolant and air as warm as films are usually.

    Temperatures are rises there, so a stream can not look at them.
    """
    cooling = surroundings(machine, ()).cooling
    z = np.full(network.size, INTAKE_USUAL_C if cooling is None else cooling.usual_C)
    z[network.column("ambient")] = INTAKE_USUAL_C
    return coefficients(network, rated_inputs(machine), z).streams


def fluid_rises(machine: Machine, reduction: Reduction, network: Network, rated: Numbers) -> dict[str, float]:
    """fluid -> K over the surroundings at the rated losses and the reduction's coefficients, as a network has it."""
    fluids, zones = fluid_nodes(network), list(reduction.zones)
    system = linear(network, reduction.films, reduction.contacts)
    load = sum(rated.get(zone, 0.0) * unit_load(network, zone, system.solid) for zone in zones)
    columns = [list(system.fluid).index(network.column(name)) for name in fluids]
    G = film_columns(reduction.field, reduction.films, fluids)[1] + rated_streams(machine, network)
    fluid_losses = np.array([[rated.get(fluid, 0.0)] for fluid in fluids])
    inverse = np.linalg.inv(system.A)
    _, u = coupled(lambda y: inverse @ y, np.reshape(load, (-1, 1)), system.B[:, columns], G, fluid_losses)
    return dict(zip(fluids, u[:, 0].tolist(), strict=True))
