"""What alternating current adds in one layer of bars: by Dowell's closed form, or from a map."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lumped.sources.loss_laws import CopperLoss
from lumped.transfer.laws import Array, Inputs, Law, StreamTable
from lumped.transfer.ranges import out_of_range

MU_0 = 4e-7 * math.pi  # H/m
RESISTIVITY = 1.7241e-8  # ohm m at 20 degC, annealed copper, IEC 60028
THIN, THICK = 0.05, 20.0  # heights over skin depth of a table: below nothing is added to 1e-3, above no bar is built
SIZES = 200  # of a table: the added loss is within 0.2 % between them
TEMPERATURES = np.arange(-60.0, 301.0, 20.0)  # degC: of its skin depth within 0.1 % between them


def dowell(height: Array | float, layer: int) -> Array:
    """AC over DC resistance of a layer of bars in a slot, 1 at its bottom (Dowell 1966, Proc. IEE 113, 1387).

    height : of a bar, over the skin depth and times the root of its share of the slot's width
    F = x [(sinh 2x + sin 2x)/(cosh 2x - cos 2x) + 2 m (m - 1) (sinh x - sin x)/(cosh x + cos x)]; the mean over n
    layers is Dowell's x [... + 2 (n^2 - 1)/3 ...].

    >>> dowell(np.array([0.01, 1.0]), 2).round(3).tolist()
    [1.0, 1.726]
    """
    whole = np.asarray(height, float)
    x = np.minimum(whole, THICK)  # beyond, both quotients are 1 to all digits
    skin = (np.sinh(2 * x) + np.sin(2 * x)) / (np.cosh(2 * x) - np.cos(2 * x))
    proximity = (np.sinh(x) - np.sin(x)) / (np.cosh(x) + np.cos(x))
    return np.asarray(whole * (skin + 2.0 * layer * (layer - 1) * proximity))


@dataclass(frozen=True)
class LayerLoss(Law):
    """What alternating current adds to the copper loss of a layer: P_copper (k - 1) (W), k of f / resistivity.

    In bars of one temperature the quasi-static field knows frequency and resistivity by their quotient alone.
    temperature : what is added over direct current's, with its resistivity;  top : |input| up to which it is known
    """

    copper: CopperLoss
    temperature: StreamTable
    top: float = math.inf

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.copper.currents, str(self.temperature.of))

    def factor(self, inputs: Inputs) -> Array | float:
        largest = float(np.max(self.temperature.size(inputs), initial=0.0))
        if largest > self.top:
            out_of_range(f"AC factors: {self.temperature.of} = {largest:.4g} outside 0 to {self.top:.4g}")
        return self.copper.factor(inputs)


def by_dowell(
    copper: CopperLoss, speed: str, pole_pairs: float, height: float, porosity: float, layer: int
) -> LayerLoss:
    """height : of a bar (m);  porosity : its share of the slot's width;  speed : input (1/min)"""
    x, resistivity = np.geomspace(THIN, THICK, SIZES), RESISTIVITY * (1.0 + copper.alpha * (copper.reference - 20.0))
    frequency = (x / height) ** 2 * resistivity / (math.pi * MU_0 * porosity)
    return LayerLoss(copper, _added(copper, speed, 60.0 * frequency / pole_pairs, dowell(x, layer)))


def from_map(copper: CopperLoss, speed: str, at: Sequence[float], factors: Sequence[float]) -> LayerLoss:
    """at : speeds, rising from 0 or more;  factors : AC over DC resistance there, at the copper's reference"""
    slow = at[-1] * 1e-3  # slower is at rest
    speeds = np.union1d(np.geomspace(slow, at[-1], SIZES), [v for v in at if v > slow])
    factor = np.interp([0.0, *speeds[1:]], at, factors)
    return LayerLoss(copper, _added(copper, speed, speeds, factor), at[-1])


def _added(copper: CopperLoss, speed: str, at: Array, factor: Array) -> StreamTable:
    """(k - 1) (1 + alpha (T - reference)) over ln(input) less the logarithm of resistivity, and over T."""
    resistivity = 1.0 + copper.alpha * (TEMPERATURES - copper.reference)
    value = np.outer(resistivity, factor - 1.0).ravel()
    grid = TEMPERATURES, np.log(resistivity), np.log(at), value
    total, shift, number, added = (tuple(x.tolist()) for x in grid)
    return StreamTable(speed, float(at[-1]), copper.reference, total, shift, number, added)
