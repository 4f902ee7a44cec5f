"""What an effect is: one small frozen object that adds zero-amplitude physics to a network."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Literal

from lumped.model.network import Link, Network, Parameter
from lumped.model.quantities import INPUTS
from lumped.transfer.laws import CLOCK, Fixed, InputPower, Law

Interval = tuple[float, float]
NOTHING: Interval = (0.0, 0.0)
# In which reference values are stated
UNITS = {
    "speed": "rpm",
    "vehicle_speed": "m/s",
    "current": "A",
    "torque": "Nm",
    "power": "W",
    "voltage": "V",
    "frequency": "Hz",
    "air_flow": "m3/h",
    "water_flow": "l/min",
    "share": "%",
    "flow_share": "%",
}


@dataclass(frozen=True)
class Scene:
    """What the tests offer an effect: the network, the recorded inputs and the channels.

    inputs : names of the recorded signals
    channels : names of the measured temperatures
    """

    network: Network
    inputs: frozenset[str] = frozenset()
    channels: tuple[str, ...] = ()
    tests: tuple[str, ...] = ()

    @property
    def recorded(self) -> frozenset[str]:
        """What of the machine is recorded: "speed", "current", ..., and "time"."""
        quantities = frozenset(q for q in INPUTS if self.network.signal(q) in self.inputs)
        return quantities | ({"time"} if CLOCK in self.inputs else set())


@dataclass(frozen=True)
class Effect(ABC):
    """Physics that a network may lack, at one place. With its parameter at neutral it changes nothing.

    kind, title : short name and words;  place : where it sits;  sits : where it may, in words
    unit, sign, prior_sd, low, high : of its one parameter, a share where it has no unit; sign is what physics allows
        (0: both)
    at : speed, current, ... at which the parameter is what the effect amounts to ("" : everywhere)
    typical : usual magnitude in `unit`
    confused_with : kinds that leave a similar trace;  isolating_test : the test that sets it apart
    needs : quantities of the machine that must be recorded for it to act ("speed", "current", "time")
    fault : True when it is a fault of the measurement, not heat
    whole : True when it happens entirely or not at all, with parameter 1 (two plugs exchanged)
    of_tests : True when it may be off in whole tests alone, though it is an offset
    of_material : True when its amplitude is a property of a material, which is never far from `typical`
    temporary : True when it can be told only while a condition holds: in all tests it is what a fit does to parameters
    empirical : True when it follows a correlation that scatters, as films and losses do; not conduction, nor a sensor
    """

    place: str

    kind: ClassVar[str]
    title: ClassVar[str]
    sits: ClassVar[str] = "a place that its own file names"
    unit: ClassVar[str] = "1"
    at: ClassVar[str] = ""
    source: ClassVar[str]
    isolating_test: ClassVar[str]
    typical: ClassVar[tuple[float, float]]
    sign: ClassVar[int] = 1
    prior_sd: ClassVar[float] = 1.0
    low: ClassVar[float] = 0.0
    high: ClassVar[float] = 1e6
    neutral: ClassVar[float] = 0.0
    mapping: ClassVar[Literal["amplitude", "relative", "offset"]] = "amplitude"
    confused_with: ClassVar[tuple[str, ...]] = ()
    needs: ClassVar[tuple[str, ...]] = ()
    fault: ClassVar[bool] = False
    whole: ClassVar[bool] = False
    of_tests: ClassVar[bool] = False
    of_material: ClassVar[bool] = False
    temporary: ClassVar[bool] = False
    empirical: ClassVar[bool] = False

    @property
    def name(self) -> str:
        return f"{self.kind}@{self.place}"

    @property
    def statement(self) -> str:
        """What it says of the machine and where, in words: "forced convection by vehicle wind at flange.right"."""
        return f"{self.title} {place_words(self.place)}"

    def law_words(self, a: float, network: Network, values: Mapping[str, float], ci95: Interval) -> str:
        """What an amplitude came to in a fit: its size; "stator to coolant: 56 W/K at rest, 112 at ..." of a law."""
        unit = next(p.unit for p in network.parameters if p.name == self.name)
        return law_sentence(self.statement, a, a, unit, interval=ci95)

    @property
    def large(self) -> tuple[float, ...]:
        """Usual amplitudes that leave the tangent behind: the share that something loses where it only can lose."""
        return self.typical[:1] if self.mapping == "relative" and self.sign < 0 else ()

    @property
    def changes_others(self) -> bool:
        """Does it change what other effects may have brought, rather than bring a link or loss of its own?"""
        return self.mapping == "relative" or self.fault

    @classmethod
    def places(cls, scene: Scene) -> tuple[str, ...]:
        """Where it can sit on this network with these recordings."""
        return tuple(cls.candidate_places(scene)) if set(cls.needs) <= scene.recorded else ()

    @classmethod
    def lacking(cls, scene: Scene) -> list[str]:
        """What it would need to sit anywhere here: columns that are not recorded, a part or face that suits it."""
        columns = [f"a column of {q} (input {INPUTS.get(q, q)})" for q in cls.needs if q not in scene.recorded]
        return columns + ([] if list(cls.candidate_places(scene)) else [cls.sits])

    @classmethod
    @abstractmethod
    def candidate_places(cls, scene: Scene) -> Iterable[str]:
        """Places that suit it, supposing that what it needs is recorded."""

    @abstractmethod
    def extend(self, network: Network) -> Network:
        """The network with this effect at zero amplitude and one Parameter named like the effect."""

    def parameter(self, *targets: str, scale: float = 1.0, unit: str | None = None) -> Parameter:
        """Its parameter; `scale` multiplies prior and upper bound (bare nodes count in W/K instead of W/m2/K)."""
        unit = unit or self.unit
        return Parameter(
            name=self.name,
            targets=tuple((t, 1.0) for t in targets),
            value=self.neutral,
            unit=f"{unit} at {self.at}" if self.at else unit,
            low=self.low,
            high=self.high * scale,
            prior_sd=self.prior_sd * scale,
            mapping=self.mapping,
            neutral=self.neutral,
            sign=self.sign,
            source=self.source,
        )


class PowerLaw(Effect):
    """A loss or film that goes with powers of what is recorded; a is what it is where each has its reference value.

    follows : (quantity, reference value, exponent) of each; none: it is constant
    """

    follows: ClassVar[tuple[tuple[str, float, float], ...]] = ()

    def __init_subclass__(cls) -> None:
        """It needs what it follows, and is stated at the reference values unless it says at more than these."""
        if "follows" in vars(cls):
            cls.needs = tuple(quantity for quantity, _, _ in cls.follows)
            if "at" not in vars(cls):
                cls.at = " and ".join(f"{value:g} {UNITS[quantity]}" for quantity, value, _ in cls.follows)

    def law(self, network: Network) -> Law:
        """Of a coefficient of 1 (W, W/m2/K, or W/K at a bare node) at the reference values."""
        factors = tuple((network.signal(quantity), value, n) for quantity, value, n in self.follows)
        return InputPower(1.0, factors) if factors else Fixed(1.0)


class WeakLinks(Effect):
    """Links that conduct or carry less than assumed: g = g0 (1 + a), low <= a <= 0."""

    sign = -1
    low = -0.95
    high = 0.0
    mapping = "relative"

    @abstractmethod
    def links(self, network: Network) -> list[Link]:
        """What it weakens."""

    def extend(self, network: Network) -> Network:
        return with_parameter(network, self.parameter(*(link.name for link in self.links(network))))


class ReadingEffect(Effect):
    """An effect whose place only readings can tell, such as the level of an input: the catalogue has none of it."""

    @classmethod
    def candidate_places(cls, scene: Scene) -> Iterable[str]:
        """Nowhere by itself."""
        return ()

    @property
    @abstractmethod
    def inputs(self) -> tuple[str, ...]:
        """What it follows."""

    @abstractmethod
    def words(self, a: float, network: Network, values: Mapping[str, float], ci95: Interval = NOTHING) -> str:
        """What an amplitude means, beside what the network has there at the values of its parameters."""


def law_sentence(subject: str, rest: float, most: float, unit: str, at: str = "", interval: Interval = NOTHING) -> str:
    """ "stator to coolant: 56 W/K at rest, 112 at speed_rpm 4000 [100, 125]"; "body to room: 2 W/K [1.8, 2.3]" of what
    follows no input: a law, wherever it is told."""
    size = f"{rest:.3g} {unit} at rest, {most:.3g} at {at}" if at else f"{most:.3g} {unit}".removesuffix(" 1")
    return f"{subject}: {size}" + (f" [{interval[0]:.3g}, {interval[1]:.3g}]" if interval[1] > interval[0] else "")


def place_words(where: str) -> str:
    """Where something sits, in words: "at rotor", "between stator.core and housing"."""
    return f"between {where.replace('|', ' and ')}" if "|" in where else f"at {where}"


def with_parameter(network: Network, parameter: Parameter) -> Network:
    return replace(network, parameters=(*network.parameters, parameter))
