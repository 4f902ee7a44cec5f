"""An input recorded with a constant added."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from lumped.correlations import RangeWarning
from lumped.model.network import Link, Network
from lumped.model.quantities import INPUTS
from lumped.transfer.laws import Array, Inputs, Law, TemperatureLaw
from validation.effects.base import Effect, Scene, with_parameter
from validation.effects.build import copy_link, copy_source
from validation.effects.sensors.input_factor import metered, read

STEP = 0.05  # of the input's largest value: a chord as wide as such faults are


@dataclass(frozen=True)
class Shift(Law):
    """d law / d of one input, per unit of it."""

    base: Law
    input: str
    reads: tuple[str, ...] = field(init=False, default=())
    temperature: TemperatureLaw = field(init=False, default=TemperatureLaw())

    def __post_init__(self) -> None:
        object.__setattr__(self, "reads", self.base.reads)
        object.__setattr__(self, "temperature", self.base.temperature)

    def factor(self, inputs: Inputs) -> Array | float:
        u = np.asarray(inputs[self.input], float)
        h = STEP * float(np.max(np.abs(u), initial=0.0)) or 1.0
        known: Mapping[str, Array] = {name: inputs[name] for name in self.reads}
        with warnings.catch_warnings():  # the chord may leave a table that the input itself stays in
            warnings.simplefilter("ignore", RangeWarning)
            more, less = (np.asarray(self.base.factor({**known, self.input: u + s})) for s in (h, -h))
        return np.asarray((more - less) / (2.0 * h))


@dataclass(frozen=True)
class InputOffset(Effect):
    """An input is in truth larger by a constant than what was written down: a zero that was never set.

    Its prior and bounds are shares of the input's level (rms over all tests), see `at_level`.
    """

    kind = "input.offset"
    title = "an input is recorded with an offset"
    sits = "an input that a law of the network reads, but none that is counted (speed, frequency)"
    unit = "1"
    source = "definition; the laws that read it follow it"
    isolating_test = "read the input with everything switched off"
    typical = (-0.1, 0.1)
    sign = 0
    prior_sd = 0.05
    low = -0.5
    high = 0.5
    confused_with = ("input.factor", "loss.constant")
    fault = True

    @classmethod
    def where(cls, scene: Scene) -> list[str]:
        return metered(scene)

    def extend(self, network: Network) -> Network:
        names = []
        for x in [x for name, x in read(network) if name == self.place]:
            names.append(f"{self.name}:{x.name}")
            law = Shift(x.law, self.place)
            if isinstance(x, Link):
                network = copy_link(network, x, names[-1], law)
            else:
                network = copy_source(network, x, names[-1], law)
        unit = INPUTS.get(network.measures(self.place), "_1").rpartition("_")[2]
        return with_parameter(network, self.parameter(*names, unit=unit))
