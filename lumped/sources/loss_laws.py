"""Losses as laws: an input factor (W) times, for resistance, 1 + alpha (T - reference).

What a law declares is what the network injects: the source's weights sum to 1 and nothing is clipped.
"""

from dataclasses import dataclass

import numpy as np

from geom.arrays import Ints
from geom.constants import ALPHA_CU
from geom.errors import InputError
from lumped.transfer.laws import CONSTANT, Array, Conductivity, Inputs, Law, Linear, TemperatureLaw
from lumped.transfer.ranges import out_of_range

Power = tuple[str, float, float]
EDDY = ":eddy"  # after the name of a copper loss: its second source, what alternating current adds
IN = ":in:"  # before the part that a source of a copper loss heats, where each has its own


def declared_name(source: str) -> str:
    """The name of the loss that a source is a piece of."""
    return source.removesuffix(EDDY).partition(IN)[0]


def product(inputs: Inputs, terms: tuple[Power, ...]) -> Array | float:
    """prod |input / at| ** exponent over terms (input, at, exponent)."""
    out: Array | float = 1.0
    for name, at, exponent in terms:
        out = out * np.abs(np.asarray(inputs[name], float) / at) ** exponent
    return out


@dataclass(frozen=True)
class CopperLoss(Law):
    """factor * R * sum I^2 * (1 + alpha (T - reference)) (W).

    resistance (ohm) at reference (degC); currents: inputs (A); factor: 1.5 for peak dq currents and phase resistance,
    3 for rms phase current, 1 for direct current.  Source: Joule.
    """

    resistance: float
    currents: tuple[str, ...]
    factor_: float = 1.0
    alpha: float = ALPHA_CU
    reference: float = 20.0

    @property
    def temperature(self) -> TemperatureLaw:  # type: ignore[override]
        return Linear(self.alpha, self.reference)

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.currents

    def factor(self, inputs: Inputs) -> Array | float:
        squares = sum(np.asarray(inputs[name], float) ** 2 for name in self.currents)
        return self.factor_ * self.resistance * squares


@dataclass(frozen=True)
class EddyLoss(Law):
    """What alternating current adds to a copper loss: P_copper (k - 1) / (1 + alpha (T - reference)) (W).

    k = c0 + c1 f + c2 f^2 + ..., f = |speed / speed_at|: resistance of alternating over that of direct current at the
    copper's reference temperature. Eddy currents in strands thinner than the skin fall with resistivity (Dowell 1966).
    Source: AC factor as a polynomial in frequency: Liu et al. 2024, doi 10.1109/TPEL.2024.3409388.
    """

    copper: CopperLoss
    ac: tuple[float, ...]
    speed: str
    speed_at: float = 1.0

    @property
    def temperature(self) -> TemperatureLaw:  # type: ignore[override]
        return Conductivity(self.copper.alpha, self.copper.reference)

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.copper.currents, self.speed)

    def factor(self, inputs: Inputs) -> Array | float:
        f = np.abs(np.asarray(inputs[self.speed], float) / self.speed_at)
        out = np.asarray(np.polynomial.polynomial.polyval(f, self.ac), float)
        if np.any(out < 0.0):
            worst, at = float(out.min()), np.ravel(f)[np.argmin(out)] * self.speed_at
            raise InputError(
                f"the resistance factor is {worst:.3g} at {self.speed} = {at:.4g}",
                f"copper loss of {', '.join(self.copper.currents)}, ac coefficients {list(self.ac)}",
                "coefficients that keep c0 + c1 f + c2 f^2 ... above 0: resistance makes heat",
            )
        return self.copper.factor(inputs) * (out - 1.0)


@dataclass(frozen=True)
class PowerLoss(Law):
    """sum of watts * prod |input / at| ** exponent (W): friction, windage, stray, magnet, switching, mapped iron loss.

    terms : (watts, ((input, at, exponent), ...))
    """

    terms: tuple[tuple[float, tuple[Power, ...]], ...]
    temperature: TemperatureLaw = CONSTANT

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return tuple(dict.fromkeys(name for _, powers in self.terms for name, _, _ in powers))

    def factor(self, inputs: Inputs) -> Array | float:
        return sum(watts * product(inputs, powers) for watts, powers in self.terms)


@dataclass(frozen=True)
class IronLoss(Law):
    """(hysteresis f^a + eddy f^2 + excess f^1.5) B^b (W), f = |speed / speed_at|, B = |excitation / excitation_at|.

    hysteresis, eddy, excess : watts at speed_at and excitation_at; frequency_exponent a: of the first, 1 for Bertotti's
    split (1988, IEEE Trans. Magn. 24, 621), 1.3 to 1.7 when it stands for all (Steinmetz 1892); flux_exponent b: 1.6
    to 2. excitation: the input that sets the flux, e.g. the current of a series machine, or None. Yoke and teeth are
    two losses, each with its own watts, exponents and nodes.
    """

    hysteresis: float
    eddy: float
    speed: str
    speed_at: float
    excitation: str | None = None
    excitation_at: float = 1.0
    flux_exponent: float = 2.0
    temperature: TemperatureLaw = CONSTANT
    excess: float = 0.0
    frequency_exponent: float = 1.0

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.speed, *([self.excitation] if self.excitation else []))

    def factor(self, inputs: Inputs) -> Array | float:
        f = np.abs(np.asarray(inputs[self.speed], float) / self.speed_at)
        loss = self.hysteresis * f**self.frequency_exponent + self.eddy * f * f + self.excess * f**1.5
        if self.excitation is None:
            return loss
        return loss * product(inputs, ((self.excitation, self.excitation_at, self.flux_exponent),))


@dataclass(frozen=True)
class BrushLoss(Law):
    """drop |I| + friction |n / speed_at| (W): drop (V) of both brushes together, about 2 V for carbon.

    Source: IEC 60034-2-1 (brush loss as a fixed voltage drop); friction as Coulomb friction, mu p A v.
    """

    drop: float
    current: str
    friction: float = 0.0
    speed: str | None = None
    speed_at: float = 1.0

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.current, *([self.speed] if self.speed else []))

    def factor(self, inputs: Inputs) -> Array | float:
        loss = self.drop * np.abs(np.asarray(inputs[self.current], float))
        if self.speed is None:
            return loss
        return loss + self.friction * product(inputs, ((self.speed, self.speed_at, 1.0),))


@dataclass(frozen=True)
class RippleLoss(Law):
    """factor R dI^2 / 12 (W): copper loss of the ripple of a chopper, dI = Vs D (1 - D) / (L f), D = |V| / Vs.

    supply: Vs (V); voltage: input with the mean voltage (V); L (H); frequency (Hz); R (ohm) at reference (degC);
    factor: resistance at the switching frequency over that of direct current.
    Source: triangular ripple of a buck converter (Mohan, Undeland, Robbins 2003, ch. 7).
    """

    supply: float
    voltage: str
    L: float
    frequency: float
    R: float
    factor_: float = 1.0
    alpha: float = ALPHA_CU
    reference: float = 20.0

    @property
    def temperature(self) -> TemperatureLaw:  # type: ignore[override]
        return Linear(self.alpha, self.reference)

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.voltage,)

    def factor(self, inputs: Inputs) -> Array | float:
        D = np.minimum(np.abs(np.asarray(inputs[self.voltage], float)) / self.supply, 1.0)
        ripple = self.supply * D * (1.0 - D) / (self.L * self.frequency)
        return self.factor_ * self.R * ripple**2 / 12.0


@dataclass(frozen=True)
class MeasuredLoss(Law):
    """Measured input power minus measured output power (W).

    powers : (factor, inputs): factor * product of the inputs, e.g. (1, ("electrical_W",)) and
        (-pi/30, ("torque_Nm", "speed_rpm"))
    What the model separates out of it is taken off by sources of law `Scaled` by -1, at the moment's temperature.
    The difference may be negative in transients (energy stored in the rotor and the field) and is not clipped.
    """

    powers: tuple[tuple[float, tuple[str, ...]], ...]

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        names = [name for _, factors in self.powers for name in factors]
        return tuple(dict.fromkeys(names))

    def factor(self, inputs: Inputs) -> Array | float:
        total: Array | float = 0.0
        for scale, names in self.powers:
            total = total + scale * np.prod([np.asarray(inputs[name], float) for name in names], axis=0)
        return total


@dataclass(frozen=True)
class MapLoss(Law):
    """A measured or computed map (W) over |speed| and |torque|, bilinear; warns outside and takes the nearest edge.

    at_speed (ns,) and at_torque (nt,) rise; watts (ns, nt), row by row; speed, torque: names of the inputs, whatever
    they are. powers : (input, at, exponent) of factors beside it, such as the speed of a map over currents.
    """

    at_speed: tuple[float, ...]
    at_torque: tuple[float, ...]
    watts: tuple[tuple[float, ...], ...]
    speed: str = "speed_rpm"
    torque: str = "torque_Nm"
    temperature: TemperatureLaw = CONSTANT
    powers: tuple[Power, ...] = ()

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.speed, self.torque, *(name for name, _, _ in self.powers))

    def factor(self, inputs: Inputs) -> Array:
        n = self._within(self.speed, inputs, self.at_speed)
        T = self._within(self.torque, inputs, self.at_torque)
        i, a = _cell(n, self.at_speed)
        j, b = _cell(T, self.at_torque)
        P = np.asarray(self.watts)
        low, high = (1 - b) * P[i, j] + b * P[i, j + 1], (1 - b) * P[i + 1, j] + b * P[i + 1, j + 1]
        return ((1 - a) * low + a * high) * product(inputs, self.powers)

    def _within(self, name: str, inputs: Inputs, at: tuple[float, ...]) -> Array:
        x = np.abs(np.asarray(inputs[name], float))
        outside = [v for v, out in ((x.min(), x.min() < at[0]), (x.max(), x.max() > at[-1])) if out] if x.size else []
        if outside:
            values = " and ".join(f"{v:.4g}" for v in outside)
            out_of_range(f"loss map: {name} = {values} outside {at[0]:g} to {at[-1]:g}")
        return np.clip(x, at[0], at[-1])


def _cell(x: Array, at: tuple[float, ...]) -> tuple[Ints, Array]:
    """Index of the grid cell that holds x, and the share of the way through it."""
    grid = np.asarray(at)
    k = np.clip(np.searchsorted(grid, x, side="right") - 1, 0, grid.size - 2)
    return k, (x - grid[k]) / (grid[k + 1] - grid[k])
