"""An error of a recorded input: everything that follows it is off with it."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lumped.model.network import Link, Network, Source
from lumped.model.sites import standing_links, standing_sources
from lumped.transfer.laws import Array, Inputs, Law, Wrapped
from lumped.transfer.ranges import within_silence
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import copy_link, copy_source

COUNTED = ("speed", "frequency")  # by encoder or clock: a wrong number of pulses is a factor, and seen at once


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
class InputFault(Effect):
    """A copy of every link and loss that reads the input, with the chord of its law."""

    sits = "an input that a law of the network reads, but none that is counted (speed, frequency)"
    unit = "1"
    source = "definition; the laws that read it follow it"
    sign = 0
    fault = True

    @classmethod
    def candidate_places(cls, scene: Scene) -> list[str]:
        """Inputs that an instrument measured; what is counted, such as a speed, is not a few per cent off."""
        names = dict.fromkeys(name for name, _ in read(scene.network))
        return [n for n in names if n in scene.inputs and scene.network.measures(n) not in COUNTED]

    @abstractmethod
    def chord_of(self, law: Law) -> Law:
        """The chord of a law along this error."""

    def unit_of(self, network: Network) -> str:
        """Of its parameter."""
        return self.unit

    def extend(self, network: Network) -> Network:
        names, unit = [], self.unit_of(network)
        for x in [x for name, x in read(network) if name == self.place]:
            names.append(f"{self.name}:{x.name}")
            if isinstance(x, Link):
                network = copy_link(network, x, names[-1], self.chord_of(x.law))
            else:
                network = copy_source(network, x, names[-1], self.chord_of(x.law))
        return with_parameter(network, self.parameter(*names, unit=unit))


def read(network: Network) -> list[tuple[str, Link | Source]]:
    """Inputs, and the links and losses of the model that follow them by themselves at every instant."""
    items: list[Link | Source] = [*standing_links(network), *standing_sources(network)]
    return [(name, x) for x in items if not x.law.looks_at_all for name in x.law.reads]
