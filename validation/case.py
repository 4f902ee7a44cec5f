"""What the diagnosing code sees of a case: tests, channels, and the model as it stands. No files here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.integration.record import instants
from lumped.integration.signals import Signals
from lumped.model.network import Network, Parameter, Row
from lumped.transfer.laws import CLOCK, RUNNING
from validation.doubt import USUAL, Doubt

Array = NDArray[np.float64]
Role = Literal["calibrate", "validate", "hold-out"]


@dataclass(frozen=True)
class Channel:
    """One measured temperature of one test.

    name : column name; the same name in several tests is the same physical sensor
    place : where it sits ("flange.right"); `row` is its linear map from z = [x; u]
    y : (n_time,) readings (degC), NaN where nothing was read
    sigma_K : 1-sigma of the reading (calibration and placement)
    lag_s : time constant of the sensor (s)
    model_K : slow misfit (K) that a model of this kind is not expected to get right; below it misfit is no evidence
    """

    name: str
    place: str
    row: Row
    y: Array
    sigma_K: float = 0.5
    lag_s: float = 0.0
    model_K: float = 0.0


@dataclass(frozen=True)
class Recorded:
    """The inputs of a test as they were recorded, in finer steps than it is looked at in.

    time (n,) s;  inputs : name -> (n,);  grid, on_grid : time and inputs of the test that were made of them
    """

    time: Array
    inputs: Mapping[str, Array]
    grid: Array
    on_grid: Mapping[str, Array]

    def now(self, test: Test) -> dict[str, Array] | None:
        """The recorded inputs of a test; one that was replaced there is as it is there. None on another time axis."""
        if test.time is not self.grid:
            return None
        unchanged = {name for name, u in test.inputs.items() if self.on_grid.get(name) is u}
        other = {n: np.interp(self.time, test.time, u) for n, u in test.inputs.items() if n not in unchanged}
        return other | {n: self.inputs[n] for n in unchanged}


@dataclass(frozen=True)
class Test:
    """One test on one time grid.

    time : (n_time,) s, increasing;  inputs : name -> (n_time,)  e.g. "current_A"
    boundaries : boundary name -> (n_time,) degC
    initial : degC for the whole machine, or per place
    role : calibrate (parameters are fitted to it), validate (effects are chosen with it), hold-out (only predicted)
    frees : globs of the parameters that this test alone is to fix, before the others are fitted
    recorded : the inputs in finer steps, where there are any: what the laws are made of
    """

    name: str
    role: Role
    time: Array
    inputs: Mapping[str, Array]
    boundaries: Mapping[str, Array]
    channels: tuple[Channel, ...]
    initial: float | Mapping[str, float] = 20.0
    frees: tuple[str, ...] = ()
    recorded: Recorded | None = None
    __test__: ClassVar[bool] = False  # its name makes pytest think so

    def __repr__(self) -> str:
        each = ("inputs", self.inputs), ("boundaries", self.boundaries), ("sensors", [c.name for c in self.channels])
        columns = "; ".join(f"{what} {', '.join(names) or 'none'}" for what, names in each)
        return f"<Test '{self.name}' ({self.role}): {instants(self.time)}; {columns}>"

    @cached_property
    def signals(self) -> Signals:
        """What the laws of a network may read: inputs, time, and that it is this test."""
        fine = self.recorded.now(self) if self.recorded else None
        if self.recorded is None or fine is None:
            return Signals({**self.inputs, **self._beside(self.time)}, self.time.size)
        time = self.recorded.time
        return Signals.recorded({**fine, **self._beside(time)}, time, self.time)

    def _beside(self, time: Array) -> dict[str, Array]:
        return {CLOCK: time, f"{RUNNING}{self.name}": np.ones_like(time)}

    @property
    def spread(self) -> float:
        """What a mean over a sample step adds to the instant, in second differences over the three instants around it.

        1/8 where an input switches there, 1/24 where it does not: 1/12, less where a step holds few readings.
        """
        if self.recorded is None or self.recorded.now(self) is None or self.time.size < 3:
            return 0.0
        return max(1.0 - (self.step_s / (self.time[1] - self.time[0])) ** 2, 0.0) / 12.0

    @property
    def step_s(self) -> float:
        """Usual time between two records of an input (s)."""
        time = self.recorded.time if self.recorded else self.time
        return float(np.median(np.diff(time))) if time.size > 1 else 0.0

    def scaled(self, factors: Mapping[str, float]) -> Test:
        """The test with some inputs multiplied."""
        inputs = {**self.inputs, **{n: f * np.asarray(self.inputs[n], float) for n, f in factors.items()}}
        if self.recorded is None:
            return replace(self, inputs=inputs)
        fine = {**self.recorded.inputs, **{n: f * self.recorded.inputs[n] for n, f in factors.items()}}
        sampled = {n: inputs[n] if n in factors else u for n, u in self.recorded.on_grid.items()}
        return replace(self, inputs=inputs, recorded=replace(self.recorded, inputs=fine, on_grid=sampled))


@dataclass(frozen=True)
class AddedEffect:
    """An effect that is part of the model: kind@place with the values of its parameters."""

    kind: str
    place: str

    @property
    def name(self) -> str:
        return f"{self.kind}@{self.place}"


@dataclass(frozen=True)
class Model:
    """The model as it stands: network, effects added, parameter values (those not listed are at their declared value).

    scale : factor on the covariance of the fitted values (from the residual's own correlation)
    """

    network: Network
    effects: tuple[AddedEffect, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    revision: int = 0


@dataclass(frozen=True)
class LowFidelity:
    """A smaller network of the same machine, with the same places, links and parameters, for the many runs of a fit.

    of : the network it stands for;  rows : (test, channel) -> where that sensor looks in the smaller one
    """

    of: Network
    network: Network
    rows: Mapping[tuple[str, str], Row]


@dataclass(frozen=True)
class Case:
    """A model and the tests it is held against.

    doubt : what models of this kind get wrong, the usual table or with lines that the case widens
    answers : what the user said about a test, an event or a fault: was it so?
    low : a smaller network of the same machine, where there is one
    """

    name: str
    model: Model
    tests: tuple[Test, ...]
    nuisances: tuple[Parameter, ...] = ()
    doubt: Doubt = field(default_factory=lambda: USUAL)
    answers: Mapping[str, bool] = field(default_factory=dict)
    low: LowFidelity | None = None

    @property
    def small(self) -> Case:
        """The case on its small network, where there is one that knows all its sensors; else as it is."""
        low = self.low
        if low is None or low.of is not self.model.network:
            return self
        if any((t.name, c.name) not in low.rows for t in self.tests for c in t.channels):
            return self
        tests = tuple(
            replace(t, channels=tuple(replace(c, row=low.rows[t.name, c.name]) for c in t.channels)) for t in self.tests
        )
        return replace(self, model=replace(self.model, network=low.network), tests=tests, low=None)

    def training(self) -> Case:
        """The case without its held-out tests: all that may be fitted, chosen or accepted with. InputError if none."""
        tests = tuple(t for t in self.tests if t.role != "hold-out")
        if not tests:
            raise InputError("has only held-out tests", f"case {self.name!r}", 'role = "calibrate" for at least one')
        return replace(self, tests=tests)
