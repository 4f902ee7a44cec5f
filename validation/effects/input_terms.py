"""Heat that follows an input as nothing declared does: a loss at one place, a conductance between two."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from geom.arrays import Numbers
from geom.errors import InputError
from lumped.model.multipliers import multipliers, parameter_values
from lumped.model.network import Link, Network, Source
from lumped.transfer.laws import Array, InputPower, Inputs, Law
from lumped.transfer.ranges import within_silence
from measured.sensors.operators import head
from validation.effects.base import NOTHING, Effect, Interval, ReadingEffect, law_sentence, place_words, with_parameter
from validation.effects.build import Shaped, conductance_scale, exchange, heat, links_between, power_scale

PLACE = re.compile(r"([^|]+)(?:\|([^|]+))?\|([^|]+)")
NUMBER = r"(\d+(?:\.\d+)?(?:e[+-]?\d+)?)"
FACTOR = re.compile(rf"([^|*^>]+?)(?:>{NUMBER})?(?:\^{NUMBER})? at {NUMBER}")
ZERO = np.zeros(1)
STRAIGHT = 0.05  # an exponent this close to one is a straight line: nobody sees the difference
Factor = tuple[str, float, float, float]  # input, where it sets in, its largest value, exponent


def factor_words(factors: Iterable[Factor]) -> str:
    """ "speed_rpm^2 at 4000 * id_A at 120", "speed_rpm>2000 at 4000", as a place has it."""
    return " * ".join(
        f"{name}{f'>{begin:.4g}' if begin else ''}{'' if p == 1.0 else f'^{p:g}'} at {level:.4g}"
        for name, begin, level, p in factors
    )


@dataclass(frozen=True)
class Regimes:
    """The product of ((|u| - begin) / (level - begin)) ** exponent of some inputs u, 0 where one is below its begin."""

    factors: tuple[Factor, ...]

    def __call__(self, inputs: Inputs) -> Array | float:
        out: Array | float = 1.0
        for name, begin, level, p in self.factors:
            out = out * np.maximum((np.abs(np.asarray(inputs[name], float)) - begin) / (level - begin), 0.0) ** p
        return out


@dataclass(frozen=True)
class InputTerm(ReadingEffect):
    """A coefficient a |u / level|^p of one input u, or a product of two such: a is what it is at these levels.

    Place: "PLACE|INPUT^POWER at LEVEL", each level in the input's unit; of two inputs " * " between them. What acts
    only from a value of the input on is "INPUT>VALUE at LEVEL".
    """

    ends: ClassVar[int]
    noun: ClassVar[str]
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
        factors = tuple((m[1], float(m[2] or 0.0), float(m[4]), float(m[3] or 1.0)) for m in matches if m)
        if len(ends) != self.ends or len(factors) < len(matches) or not all(f[2] > f[1] for f in factors):
            right = "|".join([*("PLACE" for _ in range(self.ends)), "INPUT^POWER at LEVEL"])
            raise InputError(f"'{self.place}' is not a place and what it follows", f"effect '{self.name}'", right)
        return tuple(ends), factors

    @property
    def statement(self) -> str:
        ends, factors = self.parts()
        return f"a {self.noun} {place_words('|'.join(ends))} that follows {' and '.join(name for name, *_ in factors)}"

    @property
    def inputs(self) -> tuple[str, ...]:
        return tuple(factor[0] for factor in self.parts()[1])

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

    def law(self) -> Law:
        """Of 1 at the levels."""
        factors = self.parts()[1]
        if any(begin for _, begin, _, _ in factors):
            return Shaped(InputPower(1.0, ()), Regimes(factors), also_reads=self.inputs)
        return InputPower(1.0, tuple((name, level, p) for name, _, level, p in factors))

    @property
    def most(self) -> dict[str, float]:
        """Input -> its level."""
        return {name: level for name, _, level, _ in self.parts()[1]}

    @property
    def levels(self) -> str:
        """ "speed_rpm 4000 and id_A 120"."""
        return " and ".join(f"{name} {level:g}" for name, level in self.most.items())

    def words(self, a: float, network: Network, values: Numbers, ci95: Interval = NOTHING) -> str:
        """The same, of something missing."""
        return f"missing: {self.law_words(a, network, values, ci95)}"

    def sentence(self, subject: str, rest: float, most: float, values: Numbers, width: Interval) -> str:
        """What it is at rest and at most, how sure that is, and the shape between them.  width : interval, most = 0"""
        each = []
        for name, begin, _, p in self.parts()[1]:
            exponent = p + values.get(f"{self.name}^{name}", 0.0)
            each += [f"nothing up to {name} {begin:g}, then growing"] if begin else []
            each += [f"with {name} to the power of {exponent:.2g}"] if abs(exponent - 1.0) >= STRAIGHT else []
        shape = f" ({'; '.join(each)})" if each else ""
        interval = (most + width[0], most + width[1])
        return law_sentence(subject, rest, most, self.unit, self.levels, interval) + shape


@dataclass(frozen=True)
class InputLoss(InputTerm):
    """Heat at one place."""

    kind = "loss.input"
    noun = "loss"
    ends = 1
    title = "a loss that follows an input as no declared loss there does"
    unit = "W"
    source = "heat balance: a loss that was declared at another place, or not at all"
    isolating_test = "that input alone, at two levels"
    confused_with = ("loss.constant", "loss.factor")

    def law_words(self, a: float, network: Network, values: Numbers, ci95: Interval) -> str:
        """ "a loss at stator that no declared one gives: 0 W at rest, 230 at speed_rpm 4000 [200, 260]"."""
        names = {f"{self.name}^{name}" for name in self.inputs}
        exponents = [x for x in network.sources if x.name in names]
        most, where = a + _total(exponents, network, values, self.most), self.parts()[0][0]
        return self.sentence(f"a loss at {where} that no declared one gives", 0.0, most, values, _width(a, ci95))

    def extend(self, network: Network) -> Network:
        (place,) = self.checked_ends(network)
        source = heat(network, self.name, "extra", place, self.law())
        parameter = self.parameter(source.name, scale=power_scale(network), unit=f"W at {self.levels}")
        return with_parameter(network.extended(sources=[source]), parameter)


@dataclass(frozen=True)
class InputConductance(InputTerm):
    """A conductance between two places, or a place and a boundary; its constant part is what is declared there."""

    kind = "conductance.input"
    noun = "conductance"
    ends = 2
    title = "a conductance that follows an input as no declared one there does"
    unit = "W/K"
    source = "films grow with what moves the fluid"
    isolating_test = "cool down at two levels of that input without load"
    confused_with = ("flow", "coupling")

    def law_words(self, a: float, network: Network, values: Numbers, ci95: Interval) -> str:
        """What the place gives in all, with what is declared there."""
        one, other = self.parts()[0]
        others = [x for x in links_between(network, one, other) if x.name != self.name]
        rest, more = (_total(others, network, values, now) for now in ({}, self.most))
        return self.sentence(f"{one} to {other}", rest, more + a, values, _width(a, ci95))

    def extend(self, network: Network) -> Network:
        one, other = self.checked_ends(network)
        link = exchange(network, self.name, one, other, self.law())
        parameter = self.parameter(link.name, scale=conductance_scale(network), unit=f"W/K at {self.levels}")
        return with_parameter(network.extended(links=[link]), parameter)


def _width(a: float, ci95: Interval) -> Interval:
    """An interval about the amplitude in it."""
    return (ci95[0] - a, ci95[1] - a) if ci95[1] > ci95[0] else NOTHING


def _total(elements: Iterable[Link | Source], network: Network, values: Numbers, now: Numbers) -> float:
    """Conductance (W/K) or heat (W) of links or losses where some inputs have a value and all others are zero."""
    bare = replace(network, parameters=tuple(p for p in network.parameters if head(p) == "thermal"))
    times = multipliers(bare, parameter_values(bare, values))
    with within_silence():
        return sum(
            times.get(x.name, 1.0)
            * (float(np.max(np.abs(x.vals))) if isinstance(x, Link) else 1.0)
            * float(np.max(x.law.size({n: ZERO + now.get(n, 0.0) for n in x.law.reads})))
            for x in elements
            if times.get(x.name, 1.0) != 0.0
        )


def law_words(
    effects: Iterable[Effect], network: Network, values: Numbers, ci95: Mapping[str, Interval]
) -> dict[str, str]:
    """Effect -> what it came to in a fit, with its interval, as it is told everywhere."""
    mine = [e for e in effects if e.name in values]
    return {e.name: e.law_words(values[e.name], network, values, ci95.get(e.name, NOTHING)) for e in mine}
