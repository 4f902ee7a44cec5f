"""Losses from measured channels: what goes in electrically less what leaves at the shaft."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import Array, Inputs, Law


@dataclass(frozen=True)
class MeasuredLoss(Law):
    """Measured input power minus measured output power (W).

    powers : (factor, inputs): factor * product of the inputs, e.g. (1, ("electrical_W",)) and
        (-pi/30, ("torque_Nm", "speed_rpm"))
    What the model separates out of it is taken off by sources of law `Scaled` by -1, at the moment's temperature.
    The difference may be negative in transients (energy stored in the rotor and the field) and is not clipped.
    """

    powers: tuple[tuple[float, tuple[str, ...]], ...]

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        names = [name for _, factors in self.powers for name in factors]
        return tuple(dict.fromkeys(names))

    def factor(self, inputs: Inputs) -> Array | float:
        total: Array | float = 0.0
        for scale, names in self.powers:
            total = total + scale * np.prod([np.asarray(inputs[name], float) for name in names], axis=0)
        return total
