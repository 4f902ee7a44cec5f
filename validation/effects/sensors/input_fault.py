"""Errors of a recorded input: everything that follows it is off with it."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from lumped.model.network import Link, Network, Parameter, Source
from lumped.model.sites import standing_links, standing_sources
from lumped.transfer.laws import Array, Inputs, Wrapped
from lumped.transfer.ranges import within_silence
from measured.recordings.units import MEMORY_UNIT, SWITCHED
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import copy_elements

COUNTED = ("speed", "frequency")  # by encoder or clock: a wrong number of pulses is a factor, and seen at once
FACTOR_STEP = 0.1  # of the input: a chord as wide as such faults are
OFFSET_STEP = 0.05  # of the input's largest value: the same


@dataclass(frozen=True)
class Chord(Wrapped):
    """How a law changes with an error of one input, per unit of the error: over a chord, for laws that bend."""

    input: str

    @abstractmethod
    def chord(self, u: Array) -> tuple[float, Array, Array]:
        """The error on both sides that the chord spans, the input with it added and taken away."""

    def factor(self, inputs: Inputs) -> Array | float:
        readings: Mapping[str, Array] = {name: inputs[name] for name in self.reads}
        error, above, below = self.chord(np.asarray(inputs[self.input], float))
        with within_silence():  # the chord may leave a table that the input itself stays in
            more, less = (np.asarray(self.base.size({**readings, self.input: u})) for u in (above, below))
        return np.asarray((more - less) / (2.0 * error * self.temperature.level(readings)))


@dataclass(frozen=True)
class Slope(Chord):
    """d law / d ln of one input."""

    def chord(self, u: Array) -> tuple[float, Array, Array]:
        return FACTOR_STEP, (1.0 + FACTOR_STEP) * u, (1.0 - FACTOR_STEP) * u


@dataclass(frozen=True)
class Shift(Chord):
    """d law / d of one input, per unit of it."""

    def chord(self, u: Array) -> tuple[float, Array, Array]:
        h = OFFSET_STEP * float(np.max(np.abs(u), initial=0.0)) or 1.0
        return h, u + h, u - h


class InputFault(Effect):
    """A copy of every link and loss that reads the input, with the chord of its law along this error."""

    chord: ClassVar[type[Chord]]
    sits = "an input that a law of the network reads, but none that is counted (speed, frequency)"
    source = "definition; the laws that read it follow it"
    sign = 0
    fault = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        """Inputs that an instrument measured; what is counted, such as a speed, is not a few per cent off."""
        names = dict.fromkeys(name for name, _ in read(scene.network))
        return [n for n in names if n in scene.inputs and scene.network.measures(n) not in COUNTED]

    def unit_of(self, network: Network) -> str:
        """Of its parameter."""
        return self.unit

    def extend(self, network: Network) -> Network:
        followers = [x for name, x in read(network) if name == self.place]
        copies = {f"{self.name}:{x.name}": (x, self.chord(x.law, self.place)) for x in followers}
        return with_parameter(copy_elements(network, copies), self.parameter(*copies, unit=self.unit_of(network)))


def is_misread(one: Effect, amplitude: Parameter) -> bool:
    """Does an effect say that a room, an inlet or an input was read wrong? At its bound nothing is read so far off."""
    return isinstance(one, InputFault) or amplitude.targets[0][0].startswith("boundary:")


def read(network: Network) -> list[tuple[str, Link | Source]]:
    """Inputs, and the links and losses of the model that follow them by themselves at every instant."""
    items: list[Link | Source] = [*standing_links(network), *standing_sources(network)]
    return [(name, x) for x in items if not x.law.looks_at_all for name in x.law.reads]


class InputFactor(InputFault):
    """An input is in truth 1 + a times what was written down: a wrong range, a wrong shunt, a worn flow meter."""

    kind = "input.factor"
    title = "an input is recorded too small or too large"
    isolating_test = "read the input with a second instrument"
    typical = (-0.3, 0.3)
    prior_sd = 0.2
    low = -0.9
    high = 3.0
    confused_with = ("flow", "loss.winding", "loss.factor")
    chord = Slope


class InputOffset(InputFault):
    """An input is in truth larger by a constant than what was written down: a zero that was never set.

    Its prior and bounds are shares of the input's level (rms over the fitted tests), see `at_level`.
    """

    kind = "input.offset"
    title = "an input is recorded with an offset"
    isolating_test = "read the input with everything switched off"
    typical = (-0.1, 0.1)
    prior_sd = 0.05
    low = -0.5
    high = 0.5
    confused_with = ("input.factor", "loss.constant")
    chord = Shift

    def unit_of(self, network: Network) -> str:
        quantity = network.measures(self.place)
        return "%" if quantity in SWITCHED else MEMORY_UNIT.get(quantity, "1")
