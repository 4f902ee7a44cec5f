"""An input recorded too large or too small."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from lumped.correlations import RangeWarning
from lumped.model.network import Link, Network, Source
from lumped.transfer.laws import Array, Inputs, Law, TemperatureLaw
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import copy_link, copy_source

COUNTED = ("speed", "frequency")  # by encoder or clock: a wrong number of pulses is a factor, and seen at once
STEP = 0.1  # of the input: a chord of laws that bend, as wide as such faults are


@dataclass(frozen=True)
class Slope(Law):
    """d law / d ln of one input."""

    base: Law
    input: str
    reads: tuple[str, ...] = field(init=False, default=())
    temperature: TemperatureLaw = field(init=False, default=TemperatureLaw())

    def __post_init__(self) -> None:
        object.__setattr__(self, "reads", self.base.reads)
        object.__setattr__(self, "temperature", self.base.temperature)

    def factor(self, inputs: Inputs) -> Array | float:
        u = np.asarray(inputs[self.input], float)
        known: Mapping[str, Array] = {name: inputs[name] for name in self.reads}
        with warnings.catch_warnings():  # the chord may leave a table that the input itself stays in
            warnings.simplefilter("ignore", RangeWarning)
            more, less = (np.asarray(self.base.factor({**known, self.input: (1.0 + h) * u})) for h in (STEP, -STEP))
        return np.asarray((more - less) / (2.0 * STEP))


def read(network: Network) -> list[tuple[str, Link | Source]]:
    """Inputs, and the links and losses of the network's own that follow them by themselves at every instant."""
    items: list[Link | Source] = [*network.links, *network.sources]
    return [(name, x) for x in items if not x.origin and not x.law.looks_at_all for name in x.law.reads]


def metered(scene: Scene) -> list[str]:
    """Inputs that laws read and that an instrument measured; what is counted, such as a speed, is not a few per cent
    off."""
    names = dict.fromkeys(name for name, _ in read(scene.network))
    return [n for n in names if n in scene.inputs and scene.network.measures(n) not in COUNTED]


@dataclass(frozen=True)
class InputFactor(Effect):
    """An input is in truth 1 + a times what was written down: a wrong range, a wrong shunt, a worn flow meter."""

    kind = "input.factor"
    title = "an input is recorded too small or too large"
    sits = "an input that a law of the network reads, but none that is counted (speed, frequency)"
    unit = "1"
    source = "definition; the laws that read it follow it"
    isolating_test = "read the input with a second instrument"
    typical = (-0.3, 0.3)
    sign = 0
    prior_sd = 0.2
    low = -0.9
    high = 3.0
    confused_with = ("flow", "loss.winding", "loss.factor")
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return metered(scene)

    def extend(self, network: Network) -> Network:
        names = []
        for x in [x for name, x in read(network) if name == self.place]:
            names.append(f"{self.name}:{x.name}")
            law = Slope(x.law, self.place)
            if isinstance(x, Link):
                network = copy_link(network, x, names[-1], law)
            else:
                network = copy_source(network, x, names[-1], law)
        return with_parameter(network, self.parameter(*names))
