"""Coefficient laws: an input factor (NumPy, once for the whole record) times one temperature law.

The compiled kernel knows only the temperature laws below, so any correlation, written in ordinary
NumPy, runs at compiled speed.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from geom.arrays import Array, Ints

if TYPE_CHECKING:
    from lumped.transfer.ranges import Domain

Inputs = Mapping[str, Array]


@dataclass(frozen=True)
class TemperatureLaw:
    """Base of the temperature laws; `hot` and `cold` are the temperatures (degC) at both ends of the link."""

    def level(self, inputs: Inputs) -> Array | float:
        """What the law makes of the inputs at its usual temperatures: 1 of a law that follows temperature alone."""
        return 1.0


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
    domain : of its correlation, over the film temperature and |hot - cold|
    """

    difference: tuple[float, ...]
    value: tuple[float, ...]
    domain: "Domain | None" = None

    @property
    def films(self) -> tuple[float, float]:
        """The film temperatures (degC) at which it begins and ends."""
        return FIRST_C, FIRST_C + STEP_K * (FILMS - 1)

    @property
    def follows(self) -> bool:
        """Whether its air has the properties of its temperature, else of one."""
        return bool(np.ptp(np.reshape(self.value, (FILMS, -1)), axis=0).any())

    def left(self, size: float, degC: float, _: float) -> str:
        """How |hot - cold| (K) and a film temperature lie outside the correlation, with value and range."""
        assert self.domain is not None
        if words := self.domain.beside(degC, "film"):
            return words
        low, high = map(float, self.domain.ends(degC))
        return f"{self.domain.what}: {size:.4g} K beside its air outside {low:.4g} to {high:.4g}"

    def at(self, difference: float, total: Array | float) -> Array:
        """The law at hot - cold (K) and hot + cold (degC)."""
        along = [np.interp(abs(difference), self.difference, row) for row in np.reshape(self.value, (FILMS, -1))]
        return np.interp(0.5 * np.asarray(total), FIRST_C + STEP_K * np.arange(FILMS), along)


USUAL_RISE_K = 30.0  # of a face over its air
LEAST = 1e-9  # of an input of a StreamTable: its logarithm is taken
FULL_UNITS = 5.0  # transfer units of one cell: the coolant then leaves it at its walls' temperature, to 1 %


@dataclass(frozen=True)
class StreamTable(TemperatureLaw):
    """A film that follows |input| and temperature together, by its Reynolds number and the fluid's properties.

    Bilinear in `number`, ln|input| less `shift`, and in `total`, hot + cold: of a liquid its own temperature (its cold
    side sees nothing), of air twice the film's. With shift = ln(nu) a table is one of Re and T: regimes do not cut its
    cells. Outside it goes on in a straight line above its last number, flat everywhere else.

    of, usual : the input, or None; its usual size, which holds where there is no input
    degC : `total` at which the level is taken;  value : (nt * nn,), one total after the other
    stretch : of a film onto what leaves an upwind cell, the wetted area over the heat capacity rate of an input of 1
        (m2 K/W); with N = h stretch / |input| the value is then h (exp(N) - 1) / N, exact for walls of one temperature.
        Beyond FULL_UNITS the coolant leaves as warm as its walls; where it all but stands the value is h again.
    domain : of the correlation, over its fluid's temperature and |input| at the viscosity of `degC`
    still : film of still air on the same face; the value is then what blown air adds to it, (h^n + still^n)^(1/n) -
        still with n = exponent (Churchill 1977)
    """

    of: str | None
    usual: float
    degC: float
    total: tuple[float, ...]
    shift: tuple[float, ...]
    number: tuple[float, ...]
    value: tuple[float, ...]
    stretch: float = 0.0
    still: FilmTable | None = None
    exponent: float = 3.0
    domain: "Domain | None" = None

    def level(self, inputs: Inputs) -> Array | float:
        return self.at(self.size(inputs), self.degC)

    def size(self, inputs: Inputs) -> Array | float:
        """|input|"""
        return self.usual if self.of is None else np.abs(np.asarray(inputs[self.of], float))

    def ends(self, degC: Array | float, share: float) -> tuple[Array, Array]:
        """The least and the largest |input| of the correlation at temperatures of its fluid: of `total`, a share."""
        assert self.domain is not None
        thicker = np.exp(np.interp(np.asarray(degC) / share, self.total, self.shift))
        low, high = self.domain.ends(degC)
        return low * thicker, high * thicker

    def left(self, size: float, degC: float, share: float) -> str:
        """How an |input| and a temperature lie outside the correlation, with value and range; else nothing."""
        assert self.domain is not None
        if words := self.domain.beside(degC, "coolant" if share == 1.0 else "film"):
            return words
        low, high = map(float, self.ends(degC, share))
        at = f"{self.domain.what}: {self.of or 'flow'} = {size:.4g} at {degC:.4g} degC"
        return "" if low <= size <= high else f"{at} outside {low:.4g} to {high:.4g}"

    def at(self, size: Array | float, total: Array | float, difference: float = USUAL_RISE_K) -> Array:
        """The law at |input|, hot + cold (degC) and hot - cold (K)."""
        u, T = np.broadcast_arrays(np.maximum(size, LEAST), np.asarray(total, float))
        grid, numbers = np.array(self.total), np.array(self.number)
        T = np.clip(T, grid[0], grid[-1])
        y = np.maximum(np.log(u) - np.interp(T, grid, self.shift), numbers[0])
        (i, p), (j, q) = _piece(grid, T), _piece(numbers, y)
        H = np.reshape(self.value, (grid.size, numbers.size))
        h = (1 - p) * ((1 - q) * H[i, j] + q * H[i, j + 1]) + p * ((1 - q) * H[i + 1, j] + q * H[i + 1, j + 1])
        if self.still is not None:
            still = self.still.at(difference, total)
            return np.asarray((h**self.exponent + still**self.exponent) ** (1.0 / self.exponent) - still)
        if not self.stretch:
            return np.asarray(h)
        N = h * self.stretch / u
        return np.asarray(np.maximum(h, np.expm1(np.minimum(N, FULL_UNITS)) * u / self.stretch))


def _piece(grid: Array, x: Array) -> tuple[Ints, Array]:
    """The piece of a grid that x lies in, and where in it."""
    k = np.clip(np.searchsorted(grid, x, "right") - 1, 0, grid.size - 2)
    return k, (x - grid[k]) / (grid[k + 1] - grid[k])


CONSTANT = Constant()
CLOCK = "time_s"  # the input that is the record's time
RUNNING = "running "  # before the name of a test: the input that is 1 in this one only


class Law(ABC):
    """A coefficient g(t, T) = factor(inputs) * temperature(T).

    The factor at an instant is made of the inputs at that instant; a law that reads "time_s", or has `over_record` set,
    may look at the whole record, unless it has `by_instant` set.
    """

    temperature: TemperatureLaw = CONSTANT
    reads: tuple[str, ...] = ()
    over_record: ClassVar[bool] = False
    by_instant: bool = False

    @property
    def looks_at_all(self) -> bool:
        """Whether a factor at an instant may depend on what the inputs are at others."""
        return self.over_record or CLOCK in self.reads

    @abstractmethod
    def factor(self, inputs: Inputs) -> Array | float:
        """The input factor: a number, or one value per time of the record."""

    def size(self, inputs: Inputs) -> Array | float:
        """The coefficient at the usual temperatures of its temperature law: how it follows the inputs in all."""
        return np.asarray(self.factor(inputs)) * self.temperature.level(inputs)


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
class AtUsualTemperature(Wrapped):
    """Another law as it is at its usual temperatures, whatever the temperatures are."""

    temperature: TemperatureLaw = CONSTANT

    def factor(self, inputs: Inputs) -> Array | float:
        return self.base.size(inputs)


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
