"""Load profiles: levels held for some minutes with ramps one logging interval long."""

import numpy as np

from hidden.truth.body import Array

Rng = np.random.Generator


def log_times(minutes: float, log_s: float) -> Array:
    return np.arange(0.0, 60.0 * minutes + 1.0, log_s)


def fine_times(at: Array, fine_s: float) -> Array:
    return np.arange(0.0, at[-1] + 0.5 * fine_s, fine_s)


def between(fine: Array, at: Array, name: str, value: Array) -> Array:
    """A signal between its logging times: currents (`_A`) with even steps of their square, switches (`_on`) thrown
    half way, all others linear."""
    if name.endswith("_on"):
        return value[np.searchsorted(at - 0.5 * (at[1] - at[0]), fine, side="right") - 1]
    if name.endswith("_A"):
        return np.sqrt(np.interp(fine, at, value**2))
    return np.interp(fine, at, value)


def levels(at: Array, rng: np.random.Generator, low: float, high: float, minutes: float) -> Array:
    """Random levels, each held for about `minutes`; the first is in the upper half."""
    every = max(1, round(60.0 * minutes / (at[1] - at[0])))
    drawn = rng.uniform(low, high, at.size // every + 1)
    drawn[0] = max(drawn[0], 0.5 * (low + high))
    return drawn[np.arange(at.size) // every]


def until(at: Array, minutes: float, level: float) -> Array:
    """A level that ends after some minutes."""
    return np.where(at <= 60.0 * minutes, level, 0.0)


def steady(at: Array, level: float) -> Array:
    return np.full(at.size, level)


def air(at: Array, rng: np.random.Generator) -> Array:
    """Room temperature (degC): 18 to 26, swinging by half a kelvin."""
    return 22.0 + 4.0 * rng.uniform(-1, 1) + 0.5 * np.sin(at / 1100.0 + 6.0 * rng.uniform())
