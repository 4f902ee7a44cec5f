"""Faults of the measurement, as they happen to readings (time, T, ambient) -> T."""

from collections.abc import Callable, Iterable

import numpy as np

from hidden.truth.body import Array
from hidden.truth.change import Change
from hidden.truth.readings import lagged


def reading(sensor: str, happens: Callable[[Array, Array, Array], Array]) -> Change:
    return Change(readings={sensor: happens})


def bias(sensor: str, kelvin: float) -> Change:
    return reading(sensor, lambda time, T, air: T + kelvin)


def slow(sensor: str, seconds: float) -> Change:
    """A sensor that came loose: another first-order lag."""
    return reading(sensor, lambda time, T, air: lagged(time, T, seconds))


def gain(sensor: str, share: float) -> Change:
    return reading(sensor, lambda time, T, air: 20.0 + (1.0 + share) * (T - 20.0))


def stem(sensor: str, share: float) -> Change:
    """Heat along the leads: the reading is drawn towards the room."""
    return reading(sensor, lambda time, T, air: T + share * (air - T))


def late(sensor: str, seconds: float) -> Change:
    return reading(sensor, lambda time, T, air: np.interp(time - seconds, time, T))


def drift(sensor: str, kelvin_hour: float) -> Change:
    return reading(sensor, lambda time, T, air: T + kelvin_hour * time / 3600.0)


def frozen(sensor: str, share: float) -> Change:
    """The logger repeats one value from this share of the test on."""
    return Change(shown={sensor: lambda y: np.where(np.arange(y.size) > share * y.size, y[int(share * y.size)], y)})


def clipped(sensor: str, share: float) -> Change:
    """A range too small: nothing above this share of the rise."""
    return Change(shown={sensor: lambda y: np.minimum(y, np.round(y[0] + share * (y.max() - y[0]), 1))})


def swapped(a: str, b: str) -> Change:
    return Change(swaps=((a, b),))


def offset(name: str, kelvin: float) -> Change:
    """An input is written down too high: the room's thermometer hangs where it is warmer."""
    return Change(inputs={name: lambda time, u: u + kelvin})


def factor(name: str, times: float) -> Change:
    """An input is written down times a number: the range of the meter."""
    return Change(inputs={name: lambda time, u: times * u})


def clock(sensors: Iterable[str], seconds: float) -> Change:
    """All thermometers are logged on a clock that is late."""
    return Change(readings={s: late(s, seconds).readings[s] for s in sensors})
