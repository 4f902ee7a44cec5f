"""What the diagnosing code sees of a case: tests, channels, and the model as it stands. No files here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Literal
from weakref import WeakValueDictionary

import numpy as np

from geom.arrays import Array, Ints
from geom.errors import InputError
from lumped.integration.record import instants
from lumped.integration.signals import Signals
from lumped.model.network import Network, Parameter, Row
from lumped.transfer.laws import CLOCK, RUNNING
from measured.doubt import USUAL, Doubt, Odds

Role = Literal["calibrate", "validate", "hold-out"]
_SIGNALS: WeakValueDictionary[tuple[str, int, int, int], Signals] = WeakValueDictionary()
STILL_K = 1e-3  # below what any sensor resolves: corrections of equal readings by a larger network differ by less
GAP = 10.0  # usual steps: a logger that was silent for longer had stopped


@dataclass(frozen=True)
class Channel:
    """One measured temperature of one test.

    name : column name; the same name in several tests is the same physical sensor
    place : where it sits ("flange.right"); `row` is its linear map from z = [x; u]
    y : (n_time,) readings (degC), NaN where nothing was read
    sigma_K : 1-sigma of the reading (calibration and placement)
    lag_s : time constant of the sensor (s)
    model_K : slow misfit (K) that a model of this kind is not expected to get right; below it misfit is not evidence
    """

    name: str
    place: str
    row: Row
    y: Array
    sigma_K: float = 0.5
    lag_s: float = 0.0
    model_K: float = 0.0


def seconds_read(time: Array) -> float:
    """Time (s) that readings stand for: what they count beside others, however often a logger writes.

    time : (n,) s, of the readings alone: where nothing was read for long, only the first of it counts
    """
    if time.size < 2:
        return 1.0
    steps = np.diff(time)
    usual = float(np.median(steps))
    return usual + float(np.minimum(steps, GAP * usual).sum())


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
        return {  # in the order of the test
            name: self.inputs[name] if self.on_grid.get(name) is u else np.interp(self.time, test.time, u)
            for name, u in test.inputs.items()
        }


@dataclass(frozen=True)
class Test:
    """One test on one time grid.

    time : (n_time,) s, increasing;  inputs : name -> (n_time,)  e.g. "current_A"
    boundaries : boundary name -> (n_time,) degC
    initial : degC for the whole machine, or per place
    role : calibrate (parameters are fitted to it), validate (effects are chosen with it), hold-out (only predicted)
    frees : globs of the parameters that this test alone is to fix, before the others are fitted
    recorded : the inputs in finer steps, where there are any: what the laws are made of
    blocks : first sample of each block of readings that a fit averages; None for a few hundred equal ones
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
    blocks: Ints | None = None
    __test__: ClassVar[bool] = False  # its name makes pytest think so

    def __repr__(self) -> str:
        each = ("inputs", self.inputs), ("boundaries", self.boundaries), ("sensors", [c.name for c in self.channels])
        columns = "; ".join(f"{what} {', '.join(names) or 'none'}" for what, names in each)
        return f"<Test '{self.name}' ({self.role}): {instants(self.time)}; {columns}>"

    @cached_property
    def signals(self) -> Signals:
        """What the laws of a network may read: inputs, time, and that it is this test.

        A test with other sensors, blocks or boundaries has the same, with what the laws made of them.
        """
        key = self.name, id(self.time), id(self.inputs), id(self.recorded)
        if (out := _SIGNALS.get(key)) is None:
            out = _SIGNALS[key] = self._signals()
            out.made_of = self.time, self.inputs, self.recorded  # their ids are no other object's as long as it lives
        return out

    def _signals(self) -> Signals:
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

    @property
    def is_steady(self) -> bool:
        """Whether no reading ever changes: its later part says what its earlier one said."""
        every = [c.y[np.isfinite(c.y)] for c in self.channels]
        return all(float(np.ptp(y)) < STILL_K for y in every if y.size)

    def scaled(self, factors: Mapping[str, float]) -> Test:
        """The test with some inputs multiplied."""
        inputs = {**self.inputs, **{n: f * np.asarray(self.inputs[n], float) for n, f in factors.items()}}
        if self.recorded is None:
            return replace(self, inputs=inputs)
        fine = {n: factors[n] * u if n in factors else u for n, u in self.recorded.inputs.items()}
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
class SignalReference:
    """An input or a boundary over the tests that a model was fitted to.

    level : root mean square of an input, mean of a boundary (degC);  low, high : its range
    at_load : its value at the instant of the largest load, mean of a boundary; None where that test does not record it
    quantity : what it measures, "" where nothing says;  machine : of that quantity it is the machine's
    """

    level: float
    low: float
    high: float
    at_load: float | None = None
    quantity: str = ""
    machine: bool = False


@dataclass(frozen=True)
class Reference:
    """What a model took from the tests of its fits. It stands beside the fitted values, so that tests which come, go or
    change places later change nothing in the model.

    signals : by input or boundary;  sizes : effect -> mean of what its law multiplies an amplitude by
    tests : that were fitted;  errors : sensor -> rms error (K) on the strictest role of test, and that role
    start_C : where the first of these tests started (degC)
    """

    signals: Mapping[str, SignalReference] = field(default_factory=dict)
    sizes: Mapping[str, float] = field(default_factory=dict)
    tests: tuple[str, ...] = ()
    errors: Mapping[str, tuple[float, str]] = field(default_factory=dict)
    start_C: float | None = None

    @property
    def levels(self) -> dict[str, float]:
        """Input -> where a fitted exponent leaves its law as declared; an input that was never used has none."""
        return {name: one.level for name, one in self.signals.items() if one.level > 0}

    @property
    def load_point(self) -> dict[str, float]:
        """Input or boundary -> value at which load counts as 1: of the largest load that the tests reached."""
        return {name: one.at_load for name, one in self.signals.items() if one.at_load is not None}


@dataclass(frozen=True)
class Model:
    """The model as it stands: network, effects added, parameter values (those not listed are at their declared value).

    reference : what exponents and effects refer to; None before the first fit
    intervals : parameter -> its central 95 % by the tests that were fitted
    """

    network: Network
    effects: tuple[AddedEffect, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    revision: int = 0
    reference: Reference | None = None
    intervals: Mapping[str, tuple[float, float]] = field(default_factory=dict)


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
    odds : kind, "kind@place" or "sensors" -> what the odds of these effects are multiplied by here, and why
    """

    name: str
    model: Model
    tests: tuple[Test, ...]
    nuisances: tuple[Parameter, ...] = ()
    doubt: Doubt = field(default_factory=lambda: USUAL)
    answers: Mapping[str, bool] = field(default_factory=dict)
    low: LowFidelity | None = None
    odds: Mapping[str, Odds] = field(default_factory=dict)

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
        if not self.usable:
            raise InputError("has only held-out tests", f"case {self.name!r}", 'role = "calibrate" for at least one')
        return replace(self, tests=self.usable)

    @property
    def usable(self) -> tuple[Test, ...]:
        """The tests that a fit may use: all but the held-out ones."""
        return tuple(t for t in self.tests if t.role != "hold-out")

    @property
    def fitted(self) -> tuple[Test, ...]:
        """The tests that the model was fitted to, as far as they are still there, in the order of then.

        Where nothing says which: those to calibrate with, and with effects in the model those to choose them with.
        """
        if self.model.reference is None:
            return tuple(t for t in self.usable if self.model.effects or t.role == "calibrate")
        by_name = {t.name: t for t in self.usable}
        return tuple(by_name[name] for name in self.model.reference.tests if name in by_name)
