"""A kind of machine with its tests and thermometers, and what its logger would have written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from hidden.truth.change import Change
from hidden.truth.draw import Draw
from hidden.truth.machine import Machine
from hidden.truth.profile import LOG_S, air, between, fine_times, log_times
from hidden.truth.readings import BIAS_K, Sensor, read, recorded, with_gaps

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plan:
    """A test: inputs (rng, times) -> name -> (n,) at the logging times. role as in a case."""

    name: str
    role: str
    minutes: float
    inputs: Callable[[np.random.Generator, Array], dict[str, Array]]


@dataclass(frozen=True)
class Spot:
    """Where on which body, 0 to 1."""

    body: str
    position: float


@dataclass(frozen=True)
class Hidden:
    """An effect that can be hidden: its name in a user's words, the machine's change at amplitude a, the largest a."""

    name: str
    make: Callable[[float], Change]
    largest: float


@dataclass(frozen=True)
class Archetype:
    """thermometers : the user's name for the place -> where it really is;  baths : likewise for measured boundaries

    missing : effects that can be hidden;  twins : pairs of names that tests may not tell apart
    foreign, faults, absorbed : (label, change from a seed) of the other classes;  tense : priors that can be wrong
    """

    name: str
    build: Callable[[Draw, Change], Machine]
    plans: tuple[Plan, ...]
    thermometers: Mapping[str, Spot]
    baths: Mapping[str, Spot]
    missing: tuple[Hidden, ...]
    faults: Mapping[str, Callable[[int], Change]]
    foreign: Mapping[str, Callable[[int], Change]]
    absorbed: Mapping[str, Callable[[int], Change]]
    tense: Mapping[str, float]
    twins: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Record:
    """One logged test. time (n,) s;  inputs, boundaries, readings : name -> (n,);  start : degC at the first instant"""

    name: str
    role: str
    time: Array
    inputs: Mapping[str, Array]
    boundaries: Mapping[str, Array]
    readings: Mapping[str, Array]
    start: float


def measured(kind: Archetype, seed: int, change: Change, plans: tuple[Plan, ...] | None = None) -> tuple[Record, ...]:
    """All tests of one true machine."""
    draw = Draw(seed, change.factors)
    machine = kind.build(draw, change)
    sensors = [_sensor(machine, name, spot, draw, change) for name, spot in kind.thermometers.items()]
    return tuple(_logged(kind, machine, sensors, plan, seed, change) for plan in plans or kind.plans)


def _sensor(machine: Machine, name: str, spot: Spot, draw: Draw, change: Change) -> Sensor:
    rng = draw.stream(f"sensor {name}")
    position = float(np.clip(spot.position + 0.12 * rng.standard_normal(), 0.0, 0.999))
    cell = machine.skeleton.cell(spot.body, position)
    happens = (change.readings[name],) if name in change.readings else ()
    return Sensor(name, cell, BIAS_K * rng.uniform(-1, 1), float(rng.uniform(5.0, 15.0)), changes=happens)


def truly(kind: Archetype, plan: Plan, seed: int, change: Change) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """Logging times, inputs at them, and what drives the machine on the fine grid."""
    rng = np.random.default_rng([seed, *plan.name.encode()])
    at = log_times(plan.minutes, LOG_S)
    inputs = {**plan.inputs(rng, at), "T_ambient": air(at, rng)}
    fine = fine_times(at)
    driving = {k: between(fine, at, k, v) for k, v in inputs.items()}
    return at, inputs, {**driving, **{k: signal(fine) for k, signal in change.signals.items()}}


def _logged(kind: Archetype, machine: Machine, sensors: list[Sensor], plan: Plan, seed: int, change: Change) -> Record:
    rng = np.random.default_rng([seed, 1, *plan.name.encode()])
    at, inputs, driving = truly(kind, plan, seed, change)
    fine, room = fine_times(at), driving["T_ambient"]
    start = float(room[0] + rng.uniform(-0.5, 1.0))
    T = machine.run(fine, driving, start + 0.2 * rng.standard_normal(machine.skeleton.C.size))
    readings = {s.name: read(s, fine, T[:, s.cell], room, at, rng) for s in sensors}
    readings |= {name: shows(readings[name]) for name, shows in change.shown.items()}
    readings = with_gaps(readings, rng)
    for a, b in change.swaps:
        readings[a], readings[b] = readings[b], readings[a]
    shown = {k: v + change.offsets.get(k, 0.0) for k, v in inputs.items()}
    for name, spot in kind.baths.items():
        shown[f"T_{name}"] = np.interp(at, fine, T[:, machine.skeleton.cell(spot.body, spot.position)])
    written = recorded(shown, rng)
    boundaries = {k[2:]: v for k, v in written.items() if k.startswith("T_")}
    first = float(np.median([y[np.isfinite(y)][0] for y in readings.values()]))
    return Record(plan.name, plan.role, at, {k: v for k, v in written.items() if not k.startswith("T_")}, boundaries,
                  readings, first)  # fmt: skip


def with_role(record: Record, role: str) -> Record:
    return replace(record, role=role)
