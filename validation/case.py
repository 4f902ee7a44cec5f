"""What the diagnosing code sees of a case: tests, channels, and the model as it stands. No files here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from lumped.laws import CLOCK
from lumped.network import Network, Parameter, Row
from lumped.signals import Signals
from validation.doubt import USUAL, Doubt

Array = NDArray[np.float64]
Role = Literal["calibrate", "validate", "hold-out"]
RUNNING = "running "  # the input that is 1 in one test only


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
class Test:
    """One test on one time grid.

    time : (n_time,) s, increasing;  inputs : name -> (n_time,)  e.g. "current_A"
    boundaries : boundary name -> (n_time,) degC
    initial : degC for the whole machine, or per place
    role : calibrate (parameters are fitted to it), validate (effects are chosen with it), hold-out (only predicted)
    frees : globs of the parameters that this test alone is to fix, before the others are fitted
    """

    name: str
    role: Role
    time: Array
    inputs: Mapping[str, Array]
    boundaries: Mapping[str, Array]
    channels: tuple[Channel, ...]
    initial: float | Mapping[str, float] = 20.0
    frees: tuple[str, ...] = ()
    __test__: ClassVar[bool] = False  # its name makes pytest think so

    @cached_property
    def signals(self) -> Signals:
        """What the laws of a network may read: inputs, time, and that it is this test."""
        own = {CLOCK: self.time, f"{RUNNING}{self.name}": np.ones_like(self.time)}
        return Signals({**self.inputs, **own}, self.time.size)


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
class Case:
    """A model and the tests it is held against.

    doubt : what models of this kind get wrong, the usual table or with lines that the case widens
    answers : what the user said about a test, an event or a fault: was it so?
    """

    name: str
    model: Model
    tests: tuple[Test, ...]
    nuisances: tuple[Parameter, ...] = ()
    doubt: Doubt = field(default_factory=lambda: USUAL)
    answers: Mapping[str, bool] = field(default_factory=dict)

    def training(self) -> Case:
        """The case without its held-out tests: all that may be fitted, chosen or accepted with."""
        return replace(self, tests=tuple(t for t in self.tests if t.role != "hold-out"))
