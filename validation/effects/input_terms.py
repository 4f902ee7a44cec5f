"""Heat that follows an input as nothing declared does: a loss at one place, a conductance between two."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from geom.errors import InputError
from lumped.model.multipliers import multipliers, parameter_values
from lumped.model.network import Network
from lumped.transfer.laws import InputPower
from lumped.transfer.ranges import within_silence
from measured.sensors.operators import head
from validation.effects.base import ReadingEffect, with_parameter
from validation.effects.build import conductance_scale, exchange, heat, links_between, power_scale

PLACE = re.compile(r"([^|]+)(?:\|([^|]+))?\|([^|]+)")
FACTOR = re.compile(r"([^|*^]+?)(?:\^(\d+(?:\.\d+)?))? at (\d+(?:\.\d+)?(?:e[+-]?\d+)?)")
ZERO = np.zeros(1)
Factor = tuple[str, float, float]  # input, its largest value, exponent


def factor_words(factors: Iterable[Factor]) -> str:
    """ "speed_rpm^2 at 4000 * id_A at 120", as a place has it."""
    return " * ".join(f"{name}{'' if p == 1.0 else f'^{p:g}'} at {level:.4g}" for name, level, p in factors)


@dataclass(frozen=True)
class InputTerm(ReadingEffect):
    """A coefficient a |u / level|^p of one input u, or a product of two such: a is what it is at these levels.

    Place: "PLACE|INPUT^POWER at LEVEL", each level in the input's unit; of two inputs " * " between them.
    """

    ends: ClassVar[int]
    empirical = True
    typical = (1.0, 100.0)
    prior_sd = 0.5
    high = 20.0

    def __post_init__(self) -> None:
        self.parts()

    def parts(self) -> tuple[tuple[str, ...], tuple[Factor, ...]]:
        """The one place or the two, and what is followed."""
        match = PLACE.fullmatch(self.place)
        ends = [end for end in match.groups()[:2] if end] if match else []
        matches = [FACTOR.fullmatch(word) for word in match[3].split(" * ")] if match else []
        factors = tuple((m[1], float(m[3]), float(m[2] or 1.0)) for m in matches if m)
        if len(ends) != self.ends or len(factors) < len(matches) or not all(level > 0.0 for _, level, _ in factors):
            right = "|".join([*("PLACE" for _ in range(self.ends)), "INPUT^POWER at LEVEL"])
            raise InputError(f"'{self.place}' is not a place and what it follows", f"effect '{self.name}'", right)
        return tuple(ends), factors

    @property
    def inputs(self) -> tuple[str, ...]:
        return tuple(name for name, _, _ in self.parts()[1])

    def checked_ends(self, network: Network) -> tuple[str, ...]:
        """The places, if the network has them; heat put into a boundary would warm nothing."""
        ends, _ = self.parts()
        possible = list(
            dict.fromkeys([*network.places, *network.states, *(network.boundaries if self.ends > 1 else ())])
        )
        for end in ends:
            if end not in possible:
                raise InputError(f"no place '{end}'", f"effect '{self.name}'", f"one of {', '.join(possible)}")
        return ends

    def law(self) -> InputPower:
        """Of 1 at the levels."""
        return InputPower(1.0, self.parts()[1])

    @property
    def levels(self) -> str:
        """ "speed_rpm 4000 and id_A 120"."""
        return " and ".join(f"{name} {level:g}" for name, level, _ in self.parts()[1])


@dataclass(frozen=True)
class InputLoss(InputTerm):
    """Heat at one place."""

    kind = "loss.input"
    ends = 1
    title = "a loss that follows an input as no declared loss there does"
    unit = "W"
    source = "heat balance: a loss that was declared at another place, or not at all"
    isolating_test = "that input alone, at two levels"
    confused_with = ("loss.constant", "loss.factor")

    def words(self, a: float, network: Network, values: Mapping[str, float]) -> str:
        """ "a loss at stator: 0 W at rest, 230 at speed_rpm 4000"."""
        return (
            f"missing: a loss at {self.parts()[0][0]} that no declared one gives, 0 W at rest, {a:.3g} at {self.levels}"
        )

    def extend(self, network: Network) -> Network:
        (place,) = self.checked_ends(network)
        source = heat(network, self.name, "extra", place, self.law())
        parameter = self.parameter(source.name, scale=power_scale(network), unit=f"W at {self.levels}")
        return with_parameter(network.extended(sources=[source]), parameter)


@dataclass(frozen=True)
class InputConductance(InputTerm):
    """A conductance between two places, or a place and a boundary; its constant part is what is declared there."""

    kind = "conductance.input"
    ends = 2
    title = "a conductance that follows an input as no declared one there does"
    unit = "W/K"
    source = "films grow with what moves the fluid"
    isolating_test = "cool down at two levels of that input without load"
    confused_with = ("flow", "coupling")

    def words(self, a: float, network: Network, values: Mapping[str, float]) -> str:
        """ "stator to coolant: 56 W/K at rest, 112 at speed_rpm 4000"."""
        one, other = self.parts()[0]
        rest = _rest(network, one, other, values)
        return f"missing: {one} to {other} {rest:.3g} W/K at rest, {rest + a:.3g} at {self.levels}"

    def extend(self, network: Network) -> Network:
        one, other = self.checked_ends(network)
        link = exchange(network, self.name, one, other, self.law())
        parameter = self.parameter(link.name, scale=conductance_scale(network), unit=f"W/K at {self.levels}")
        return with_parameter(network.extended(links=[link]), parameter)


def _rest(network: Network, one: str, other: str, values: Mapping[str, float]) -> float:
    """Conductance (W/K) of the declared links between two places where all inputs are zero."""
    bare = replace(network, parameters=tuple(p for p in network.parameters if head(p) == "thermal"))
    times = multipliers(bare, parameter_values(bare, values))
    with within_silence():
        return sum(
            times.get(x.name, 1.0)
            * float(np.max(np.abs(x.vals)) * np.max(x.law.size(dict.fromkeys(x.law.reads, ZERO))))
            for x in links_between(bare, one, other)
            if times.get(x.name, 1.0) > 0.0
        )
