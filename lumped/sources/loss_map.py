"""Losses from a map over speed and torque."""

from dataclasses import dataclass

import numpy as np

from geom.arrays import Ints
from lumped.sources.loss_laws import Power, product
from lumped.transfer.laws import CONSTANT, Array, Inputs, Law, TemperatureLaw
from lumped.transfer.ranges import out_of_range


@dataclass(frozen=True)
class MapLoss(Law):
    """A measured or computed map (W) over |speed| and |torque|, bilinear; warns outside and takes the nearest edge.

    at_speed (ns,) and at_torque (nt,) rise; watts (ns, nt), row by row; speed, torque: names of the inputs, whatever
    they are. powers : (input, at, exponent) of factors beside it, such as the speed of a map over currents.
    """

    at_speed: tuple[float, ...]
    at_torque: tuple[float, ...]
    watts: tuple[tuple[float, ...], ...]
    speed: str = "speed_rpm"
    torque: str = "torque_Nm"
    temperature: TemperatureLaw = CONSTANT
    powers: tuple[Power, ...] = ()

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.speed, self.torque, *(name for name, _, _ in self.powers))

    def factor(self, inputs: Inputs) -> Array:
        n = self._within(self.speed, inputs, self.at_speed)
        T = self._within(self.torque, inputs, self.at_torque)
        i, a = _cell(n, self.at_speed)
        j, b = _cell(T, self.at_torque)
        P = np.asarray(self.watts)
        low, high = (1 - b) * P[i, j] + b * P[i, j + 1], (1 - b) * P[i + 1, j] + b * P[i + 1, j + 1]
        return ((1 - a) * low + a * high) * product(inputs, self.powers)

    def _within(self, name: str, inputs: Inputs, at: tuple[float, ...]) -> Array:
        x = np.abs(np.asarray(inputs[name], float))
        outside = [v for v, out in ((x.min(), x.min() < at[0]), (x.max(), x.max() > at[-1])) if out] if x.size else []
        if outside:
            values = " and ".join(f"{v:.4g}" for v in outside)
            out_of_range(f"loss map: {name} = {values} outside {at[0]:g} to {at[-1]:g}")
        return np.clip(x, at[0], at[-1])


def _cell(x: Array, at: tuple[float, ...]) -> tuple[Ints, Array]:
    """Index of the grid cell that holds x, and the share of the way through it."""
    grid = np.asarray(at)
    k = np.clip(np.searchsorted(grid, x, side="right") - 1, 0, grid.size - 2)
    return k, (x - grid[k]) / (grid[k + 1] - grid[k])
