"""Heat exchangers by effectiveness and number of transfer units, as laws of a network."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import Array, Inputs, Law

Effectiveness = Callable[[Array, Array], Array]


def counterflow(N: Array, ratio: Array) -> Array:
    """(1 - exp(-N (1 - r))) / (1 - r exp(-N (1 - r))); N / (1 + N) at r = 1. Kays and London 1964."""
    even = np.abs(1.0 - ratio) < 1e-6
    gap = np.where(even, 1.0, 1.0 - ratio)
    e = np.exp(-N * gap)
    return np.where(even, N / (1.0 + N), (1.0 - e) / (1.0 - ratio * e))


def parallel_flow(N: Array, ratio: Array) -> Array:
    """(1 - exp(-N (1 + r))) / (1 + r). Kays and London 1964."""
    return -np.expm1(-N * (1.0 + ratio)) / (1.0 + ratio)


def crossflow(N: Array, ratio: Array) -> Array:
    """Both fluids unmixed, as in a radiator: 1 - exp((exp(-r N^0.78) - 1) N^0.22 / r). Incropera et al. 2007, 11.32."""
    r = np.maximum(ratio, 1e-12)
    return -np.expm1(np.expm1(-r * N**0.78) * N**0.22 / r)


ARRANGEMENTS: dict[str, Effectiveness] = {
    "crossflow": crossflow,
    "counterflow": counterflow,
    "parallel flow": parallel_flow,
}
BACKWARDS: dict[Effectiveness, Effectiveness] = {counterflow: parallel_flow, parallel_flow: counterflow}


@dataclass(frozen=True)
class Flow:
    """Heat capacity rate (W/K): `rate` per unit of an input, or `rate` itself where there is no input."""

    rate: float
    of: str | None = None

    def at(self, inputs: Inputs) -> Array:
        return self.rate * (np.abs(np.asarray(inputs[self.of], float)) if self.of else np.ones(1))

    @property
    def reads(self) -> tuple[str, ...]:
        return (self.of,) if self.of else ()


@dataclass(frozen=True)
class Exchanger(Law):
    """effectiveness * least rate (W/K): heat over the difference of both inlet temperatures.

    UA (W/K); hot, cold: the rates of both streams; effectiveness of (N = UA / least rate, least / largest rate).
    """

    UA: float
    hot: Flow
    cold: Flow
    effectiveness: Effectiveness = crossflow

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.hot.reads, *self.cold.reads)

    def factor(self, inputs: Inputs) -> Array | float:
        a, b = np.broadcast_arrays(self.hot.at(inputs), self.cold.at(inputs))
        least, most = np.minimum(a, b), np.maximum(a, b)
        moving = least > 0.0
        N = self.UA / np.where(moving, least, 1.0)
        ratio = np.where(moving, least / np.where(most > 0.0, most, 1.0), 0.0)
        values = np.where(moving, self.effectiveness(N, ratio) * least, 0.0)
        return float(values[0]) if values.shape == (1,) else values
