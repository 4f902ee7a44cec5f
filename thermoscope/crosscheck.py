"""The network against the field it came from, on the same mesh, with the same coefficients: where do they differ?"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fem.assembly import FieldModel
from fem.solve import Fluids, Solver, Steady, steady
from lumped.laws import Law
from lumped.multipliers import multipliers
from lumped.network import Array, Network
from lumped.simulate import Record, simulate
from lumped.terms_value import temperature_value

FLOOR = 0.1  # of the machine's largest rise: below it a percentage of a part's own rise means nothing


@dataclass(frozen=True)
class PartCheck:
    """Mean and hottest temperature (degC) of a part in the field and in the network."""

    place: str
    fem_mean_C: float
    network_mean_C: float
    fem_max_C: float
    network_max_C: float
    percent_of_rise: float


@dataclass(frozen=True)
class CrossCheck:
    """parts : every part;  energy_balance : |in - out| / in of the field solution;  state (n,) of the network."""

    parts: tuple[PartCheck, ...]
    energy_balance: float
    state: Array
    field: Array

    @property
    def worst(self) -> PartCheck:
        return max(self.parts, key=lambda p: p.percent_of_rise)


@dataclass(frozen=True)
class Coefficients:
    """What every link and source amounts to at one operating point and temperature state."""

    films: dict[str, float]
    contacts: dict[str, float]
    conductivity: dict[str, float]
    watts: dict[str, float]
    streams: Array
    inflow: Array


def steady_state(
    network: Network, inputs: Mapping[str, float], ambient: float, values: Mapping[str, float] | None = None
) -> Array:
    """(n + n_boundary,) temperatures the network settles at (degC)."""
    time = np.concatenate([[0.0], np.cumsum(np.geomspace(10.0, 1e6, 80))])
    signals = {name: np.full(time.size, float(value)) for name, value in inputs.items()}
    boundaries = {name: np.full(time.size, ambient) for name in network.boundaries}
    run = simulate(network, Record(time, signals, boundaries, ambient), values, keep_states=True)
    assert run.z is not None
    return run.z[-1]


def coefficients(
    network: Network, inputs: Mapping[str, float], z: Array, values: Mapping[str, float] | None = None
) -> Coefficients:
    """Film h and contact g (W/m2/K), losses (W) by part and fluid, and the streams' matrix among the fluid nodes."""
    m = multipliers(network, values)
    signals = {name: np.array([float(value)]) for name, value in inputs.items()}
    films: dict[str, float] = {}
    contacts: dict[str, float] = {}
    conductivity: dict[str, float] = {}
    watts: dict[str, float] = {}
    fluids = fluid_nodes(network)
    n, ambient = len(network.states), z[len(network.states) :]
    D, s = np.zeros((len(fluids), len(fluids))), np.zeros(len(fluids))

    def value(law: Law, name: str, hot: float, cold: float) -> float:
        return m.get(name, 1.0) * float(np.mean(law.factor(signals))) * temperature_value(law.temperature, hot, cold)

    for link in network.links:
        g = value(link.law, link.name, _at(z, link.hot), _at(z, link.cold))
        key = link.name.split(":")[1]
        if link.kind == "film":
            films[key] = films.get(key, 0.0) + g
        elif link.kind == "contact":
            contacts[key] = contacts.get(key, 0.0) + g
        elif link.kind == "conduction":
            conductivity[key] = g
        else:
            for row, col, v in zip(link.rows, link.cols, link.vals, strict=True):
                if col < n:
                    D[fluids.index(network.states[row]), fluids.index(network.states[col])] += g * v
                else:
                    s[fluids.index(network.states[row])] -= g * v * ambient[col - n]
    for source in network.sources:
        q = value(source.law, source.name, _at(z, source.probe), 0.0)
        for i, w in zip(source.index, source.weights, strict=True):
            watts[network.states[i]] = watts.get(network.states[i], 0.0) + q * w
    for k, name in enumerate(fluids):
        s[k] += watts.pop(name, 0.0)
    return Coefficients(films, contacts, conductivity, watts, D, s)


def _at(z: Array, row: object) -> float:
    return float(row.weights @ z[row.index])  # type: ignore[attr-defined]


def fluid_nodes(network: Network) -> tuple[str, ...]:
    return tuple(p.name for p in network.places.values() if p.kind == "fluid")


def crosscheck(
    field: FieldModel,
    network: Network,
    inputs: Mapping[str, float],
    ambient: float = 20.0,
    solver: Solver | None = None,
) -> CrossCheck:
    """Steady state of both at one operating point, with the coefficients the network settles at."""
    z = steady_state(network, inputs, ambient)
    c = coefficients(network, inputs, z)
    load = sum((q * field.load(part) for part, q in c.watts.items()), np.zeros(field.n))
    fluids = Fluids(fluid_nodes(network), c.streams, c.inflow, dict.fromkeys(network.boundaries, ambient))
    full = steady(solver or Solver(field), c.films, c.contacts, load, fluids, c.conductivity)
    return CrossCheck(compared(field, network, full, z[: len(network.states)], ambient), full.energy_balance, z, full.T)


def compared(field: FieldModel, network: Network, full: Steady, x: Array, ambient: float) -> tuple[PartCheck, ...]:
    """Part by part; the percentage is of the part's own rise, of at least a tenth of the machine's largest."""
    assert network.recovery is not None
    T = network.recovery.field(x)
    largest = float(full.T.max()) - ambient
    out = []
    for part, block in field.blocks.items():
        mean, hot = float(field.mean(part) @ full.T), float(full.T[block.dofs].max())
        seen, peak = float(x[network.states.index(part)]), float(T[block.dofs].max())
        off = max(
            abs(seen - mean) / max(abs(mean - ambient), FLOOR * largest),
            abs(peak - hot) / max(hot - ambient, FLOOR * largest),
        )
        out.append(PartCheck(part, mean, seen, hot, peak, 100.0 * off))
    return tuple(out)
