"""An input recorded with a constant added."""

from dataclasses import dataclass

import numpy as np

from lumped.model.network import Network
from lumped.model.quantities import INPUTS
from lumped.transfer.laws import Array, Law
from validation.effects.sensors.input_fault import Chord, InputFault

STEP = 0.05  # of the input's largest value: a chord as wide as such faults are


@dataclass(frozen=True)
class Shift(Chord):
    """d law / d of one input, per unit of it."""

    def chord(self, u: Array) -> tuple[float, Array, Array]:
        h = STEP * float(np.max(np.abs(u), initial=0.0)) or 1.0
        return h, u + h, u - h


@dataclass(frozen=True)
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

    def chord_of(self, law: Law) -> Law:
        return Shift(law, self.place)

    def unit_of(self, network: Network) -> str:
        return INPUTS.get(network.measures(self.place), "_1").rpartition("_")[2]
