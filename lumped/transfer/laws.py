"""Coefficient laws: an input factor (NumPy, once for the whole record) times one temperature law.

The compiled kernel knows only the temperature laws below, so any correlation, written in ordinary
NumPy, runs at compiled speed.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Inputs = Mapping[str, Array]


@dataclass(frozen=True)
class TemperatureLaw:
    """Base of the temperature laws; `hot` and `cold` are the temperatures (degC) at both ends of the link."""


@dataclass(frozen=True)
class Constant(TemperatureLaw):
    """1."""


@dataclass(frozen=True)
class Power(TemperatureLaw):
    """(|hot - cold| / 1 K) ** exponent."""

    exponent: float


@dataclass(frozen=True)
class Radiation(TemperatureLaw):
    """sigma (Th^2 + Tc^2)(Th + Tc) with absolute temperatures (W/m2/K)."""


@dataclass(frozen=True)
class Linear(TemperatureLaw):
    """1 + alpha (hot - reference): copper resistance, alpha (1/K), reference (degC)."""

    alpha: float
    reference: float


@dataclass(frozen=True)
class Conductivity(TemperatureLaw):
    """1 / (1 + alpha (hot - reference)): eddy currents in copper, alpha (1/K) of its resistivity, reference (degC)."""

    alpha: float
    reference: float


@dataclass(frozen=True)
class Table(TemperatureLaw):
    """Piecewise linear in |hot - cold|: `value` at `difference` (K, increasing from 0), held flat outside.

    A table that begins below 0 is one of hot - cold with its sign: with no cold side, of a temperature (degC).
    """

    difference: tuple[float, ...]
    value: tuple[float, ...]


FIRST_C, STEP_K, FILMS = -60.0, 20.0, 14  # film temperatures of a FilmTable: to 200 degC; h is within 0.1 % between


@dataclass(frozen=True)
class FilmTable(TemperatureLaw):
    """Piecewise linear in |hot - cold| and in the film temperature (hot + cold) / 2, held flat outside.

    difference : (nd,) K, increasing from 0;  value : (FILMS * nd,), one film temperature after the other
    """

    difference: tuple[float, ...]
    value: tuple[float, ...]


CONSTANT = Constant()
CLOCK = "time_s"  # the input that is the record's time
RUNNING = "running "  # before the name of a test: the input that is 1 in this one only


class Law(ABC):
    """A coefficient g(t, T) = factor(inputs) * temperature(T).

    The factor at an instant is made of the inputs at that instant; a law that reads "time_s", or has `over_record` set,
    may look at the whole record.
    """

    temperature: TemperatureLaw = CONSTANT
    reads: tuple[str, ...] = ()
    over_record: ClassVar[bool] = False

    @property
    def looks_at_all(self) -> bool:
        """Whether a factor at an instant may depend on what the inputs are at others."""
        return self.over_record or CLOCK in self.reads

    @abstractmethod
    def factor(self, inputs: Inputs) -> Array | float:
        """The input factor: a number, or one value per time of the record."""


@dataclass(frozen=True)
class Fixed(Law):
    """A number with a temperature law: conductance (W/K), film or contact coefficient (W/m2/K), loss (W)."""

    value: float
    temperature: TemperatureLaw = CONSTANT

    def factor(self, inputs: Inputs) -> float:
        return self.value


@dataclass(frozen=True)
class Wrapped(Law):
    """Another law, changed: it reads what that one reads and has its temperature, where nothing else is said."""

    base: Law

    @property
    def temperature(self) -> TemperatureLaw:  # type: ignore[override]
        return self.base.temperature

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.base.reads


@dataclass(frozen=True)
class Scaled(Wrapped):
    """Another law times a number; -1 is what a measured total has to leave out."""

    by: float

    def factor(self, inputs: Inputs) -> Array | float:
        return self.by * np.asarray(self.base.factor(inputs), float)


@dataclass(frozen=True)
class WithTemperature(Wrapped):
    """Another law's input factor with a temperature law of its own."""

    temperature: TemperatureLaw = CONSTANT

    def factor(self, inputs: Inputs) -> Array | float:
        return self.base.factor(inputs)


@dataclass(frozen=True)
class InputPower(Law):
    """value * prod(|input / scale| ** exponent): forced films, friction, copper, iron.

    terms : (input name, scale in the input's unit, exponent)
    """

    value: float
    terms: tuple[tuple[str, float, float], ...]
    temperature: TemperatureLaw = CONSTANT

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(name for name, _, _ in self.terms)

    def factor(self, inputs: Inputs) -> Array | float:
        out: Array | float = self.value
        for name, scale, exponent in self.terms:
            out = out * np.abs(np.asarray(inputs[name], float) / scale) ** exponent
        return out
