"""What the logger wrote: placement, lag, clock, bias, drift, 0.1 K steps, gaps; and inputs that are a little wrong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

Array = NDArray[np.float64]
LOSS_MAP, FLOW, AMBIENT_K, BIAS_K, DRIFT_K_H, CLOCK_S, MISSING = 0.05, 0.03, 0.5, 0.5, 0.5, 1.0, 0.01


@dataclass(frozen=True)
class Sensor:
    """One thermometer of the true machine for all tests.

    cell : where it really sits;  bias (K), lag (s) as it is;  fault : changes (time, T cell, ambient) to the readings
    """

    name: str
    cell: int
    bias: float
    lag: float
    noise: float = 0.05
    changes: tuple = field(default=())


def lagged(time: Array, T: Array, tau: float) -> Array:
    """First-order lag (s) on an even grid, exact for temperatures linear between the times."""
    dt = time[1] - time[0]
    keep = np.exp(-dt / tau)
    share = tau / dt * (1.0 - keep)
    return np.asarray(lfilter([1.0 - share, share - keep], [1.0, -keep], T - T[0]) + T[0])


def read(sensor: Sensor, time: Array, T: Array, ambient: Array, at: Array, rng: np.random.Generator) -> Array:
    """Readings (degC) at the times `at`.

    time, T, ambient : (n,) of the fine run
    """
    seen = lagged(time, T, sensor.lag) + sensor.bias + rng.uniform(-1, 1) * DRIFT_K_H * time / 3600.0
    for change in sensor.changes:
        seen = change(time, seen, ambient)
    late = rng.uniform(-1, 1) * CLOCK_S
    return np.round(np.interp(at - late, time, seen) + sensor.noise * rng.standard_normal(at.size), 1)


def with_gaps(readings: Mapping[str, Array], rng: np.random.Generator) -> dict[str, Array]:
    """About 1 % of the lines missing (NaN), in blocks of up to three: the logger was busy."""
    n = next(iter(readings.values())).size
    lost = np.zeros(n, bool)
    for start in np.flatnonzero(rng.uniform(size=n) < MISSING / 2.0):
        lost[start : start + int(rng.integers(1, 4))] = True
    return {name: np.where(lost, np.nan, y) for name, y in readings.items()}


def recorded(inputs: Mapping[str, Array], rng: np.random.Generator) -> dict[str, Array]:
    """Inputs as written down: flows wrong by 3 %, ambient and bench by 0.5 K."""
    out = {}
    for name, u in inputs.items():
        if "flow" in name:
            u = u * (1.0 + FLOW * rng.standard_normal())
        if name.startswith("T_"):
            u = np.round(u + AMBIENT_K * rng.uniform(-1, 1) + 0.05 * rng.standard_normal(u.size), 1)
        out[name] = u
    return out
