"""A declared loss or film that is off where an input is large: a correction to its law, smooth in that input."""

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geom.errors import InputError
from lumped.model.network import Network
from lumped.transfer.laws import Array, Inputs
from validation.effects.base import NOTHING, Interval, ReadingEffect, with_parameter
from validation.effects.build import Shaped, copy_element

KIND = "law"
PLACE = re.compile(r"(.+)\|(.+)>(\d+(?:\.\d+)?(?:e[+-]?\d+)?)")
WIDTH = 0.1  # of the level: over so much the correction sets in, about as sharply as a map of ten points can show


@dataclass(frozen=True)
class Ramp:
    """0 well below a level of an input, 1 well above."""

    input: str
    level: float

    def __call__(self, inputs: Inputs) -> Array:
        u = np.abs(np.asarray(inputs[self.input], float))
        return np.asarray(1.0 / (1.0 + np.exp(np.clip((self.level - u) / (WIDTH * self.level), -50.0, 50.0))))


@dataclass(frozen=True)
class Above(ReadingEffect):
    """g = g0 (1 + a r(u)) of one declared loss or film, r from 0 to 1 around a level of an input u.

    Place: "LOSS OR LINK|INPUT>LEVEL", the level in the input's unit.
    """

    kind = KIND
    title = "a declared law is off at high values of an input"
    source = "definition: a map measured on another machine, a constant where the law bends"
    isolating_test = "two tests at constant load, one below and one above that value"
    typical = (-0.5, 0.5)
    sign = 0
    prior_sd = 0.3
    low = -0.95
    high = 3.0
    confused_with = ("loss.factor", "input.factor")

    def __post_init__(self) -> None:
        self.parts()

    def parts(self) -> tuple[str, str, float]:
        """Loss or link, input, level."""
        match = PLACE.fullmatch(self.place)
        if match is None or float(match[3]) <= 0.0:
            raise InputError(f"'{self.place}' is not a law above a level", f"effect '{self.name}'", "LOSS|INPUT>LEVEL")
        return match[1], match[2], float(match[3])

    @property
    def statement(self) -> str:
        target, name, level = self.parts()
        return f"the declared {target.replace(':', ' ')} is wrong where {name} is above {level:g}"

    @property
    def inputs(self) -> tuple[str, ...]:
        return (self.parts()[1],)

    def words(self, a: float, network: Network, values: Mapping[str, float], ci95: Interval = NOTHING) -> str:
        """ "the declared loss stator is 40 % too high above current_A 150"."""
        target, name, level = self.parts()
        side = "too low" if a > 0 else "too high"
        wrong = 100.0 * abs(a if a > 0 else a / (1.0 + a))  # a loss of which 1 + a is true is so much too high
        return f"the declared {target.replace(':', ' ')} is {wrong:.0f} % {side} where {name} is above {level:g}"

    def extend(self, network: Network) -> Network:
        target, name, level = self.parts()
        items = [x for x in network.elements if not x.origin]
        followed = next((x for x in items if x.name == target), None)
        if followed is None:
            names = ", ".join(x.name for x in items)
            raise InputError(f"no loss or link '{target}'", f"effect '{self.name}'", f"one of {names}")
        network = copy_element(network, followed, self.name, Shaped.of(followed.law, Ramp(name, level), name))
        return with_parameter(network, self.parameter(self.name))
