"""What the logger wrote: placement, lag, clock, bias, drift, steps, gaps; and inputs that are a little wrong."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.signal import lfilter

from hidden.truth.body import Array


@dataclass(frozen=True)
class Logger:
    """How a bench measures. step (s) of the log, fine (s) of the truth in between, steps_K of the readings

    lag : (least, most) s of a thermometer, whose data sheet says the mean;  placed : scatter of its place (of the body)
    flow : share by which a recorded flow may be wrong;  missing : share of the lines
    """

    step: float = 30.0
    fine: float = 5.0
    steps_K: float = 0.1
    lag: tuple[float, float] = (5.0, 15.0)
    placed: float = 0.12
    bias_K: float = 0.5
    drift_K_h: float = 0.5
    noise_K: float = 0.05
    clock_s: float = 1.0
    ambient_K: float = 0.5
    flow: float = 0.03
    missing: float = 0.01


@dataclass(frozen=True)
class Sensor:
    """One thermometer of the true machine for all tests.

    cell : where it really sits;  bias (K), lag (s) as it is;  changes : (time, T cell, ambient) to the readings
    """

    name: str
    cell: int
    bias: float
    lag: float
    changes: tuple = field(default=())


def lagged(time: Array, T: Array, tau: float) -> Array:
    """First-order lag (s) on an even grid, exact for temperatures linear between the times."""
    dt = time[1] - time[0]
    keep = np.exp(-dt / tau)
    share = tau / dt * (1.0 - keep)
    return np.asarray(lfilter([1.0 - share, share - keep], [1.0, -keep], T - T[0]) + T[0])


def read(
    sensor: Sensor, logger: Logger, time: Array, T: Array, ambient: Array, at: Array, rng: np.random.Generator
) -> Array:
    """Readings (degC) at the times `at`.

    time, T, ambient : (n,) of the fine run
    """
    seen = lagged(time, T, sensor.lag) + sensor.bias + rng.uniform(-1, 1) * logger.drift_K_h * time / 3600.0
    for change in sensor.changes:
        seen = change(time, seen, ambient)
    late = rng.uniform(-1, 1) * logger.clock_s
    noisy = np.interp(at - late, time, seen) + logger.noise_K * rng.standard_normal(at.size)
    return np.round(noisy / logger.steps_K) * logger.steps_K


def with_gaps(readings: Mapping[str, Array], rng: np.random.Generator, missing: float) -> dict[str, Array]:
    """About this share of the lines missing (NaN), in blocks of up to three: the logger was busy."""
    n = next(iter(readings.values())).size
    lost = np.zeros(n, bool)
    for start in np.flatnonzero(rng.uniform(size=n) < missing / 2.0):
        lost[start : start + int(rng.integers(1, 4))] = True
    return {name: np.where(lost, np.nan, y) for name, y in readings.items()}


def recorded(inputs: Mapping[str, Array], logger: Logger, rng: np.random.Generator) -> dict[str, Array]:
    """Inputs as written down: flows wrong by some percent, ambient and bench by up to half a kelvin."""
    out = {}
    for name, u in inputs.items():
        if "flow" in name:
            u = u * (1.0 + logger.flow * rng.standard_normal())
        if name.startswith("T_"):
            u = np.round(u + logger.ambient_K * rng.uniform(-1, 1) + 0.05 * rng.standard_normal(u.size), 1)
        out[name] = u
    return out
