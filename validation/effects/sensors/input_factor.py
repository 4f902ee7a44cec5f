"""An input recorded too large or too small."""

from dataclasses import dataclass

from lumped.transfer.laws import Array, Law
from validation.effects.sensors.input_fault import Chord, InputFault

STEP = 0.1  # of the input: a chord as wide as such faults are


@dataclass(frozen=True)
class Slope(Chord):
    """d law / d ln of one input."""

    def chord(self, u: Array) -> tuple[float, Array, Array]:
        return STEP, (1.0 + STEP) * u, (1.0 - STEP) * u


@dataclass(frozen=True)
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

    def chord_of(self, law: Law) -> Law:
        return Slope(law, self.place)
