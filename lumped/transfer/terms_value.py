"""Temperature laws in ordinary NumPy, for what looks at a network from outside the compiled kernel."""

from __future__ import annotations

import numpy as np

from geom.constants import SIGMA, ZERO_C
from lumped.transfer.laws import (
    AtUsualTemperature,
    Conductivity,
    FilmTable,
    Inputs,
    Law,
    Linear,
    Power,
    Radiation,
    StreamTable,
    Table,
    TemperatureLaw,
)


def coefficient(law: Law, inputs: Inputs, hot: float, cold: float) -> float:
    """A law at an instant's inputs and two temperatures (degC), in all."""
    follows = law.temperature
    size = float(np.mean(follows.size(inputs))) if isinstance(follows, StreamTable) else None
    return float(np.mean(law.factor(inputs))) * temperature_value(follows, hot, cold, size)


def separated(law: Law) -> Law:
    """A law whose factor holds all that inputs do to it: for what is linear in these; `turned` goes with it."""
    return AtUsualTemperature(law) if isinstance(law.temperature, StreamTable) else law


def turned(law: TemperatureLaw, hot: float, cold: float) -> float:
    """The law at two temperatures (degC) over what it is at its usual ones, at the usual size of an input."""
    usual = float(law.at(law.usual, law.degC)) if isinstance(law, StreamTable) else 1.0
    return temperature_value(law, hot, cold) / usual


def temperature_value(law: TemperatureLaw, hot: float, cold: float, size: float | None = None) -> float:
    """The law at two temperatures (degC), and at a size of the input that it sees, if any: else at the usual one."""
    if isinstance(law, StreamTable):
        return float(law.at(law.usual if size is None else size, hot + cold, hot - cold))
    if isinstance(law, Power):
        return float(abs(hot - cold) ** law.exponent)
    if isinstance(law, Radiation):
        h, c = hot + ZERO_C, cold + ZERO_C
        return SIGMA * (h * h + c * c) * (h + c)
    if isinstance(law, Linear):
        return 1.0 + law.alpha * (hot - law.reference)
    if isinstance(law, Conductivity):
        return 1.0 / (1.0 + law.alpha * (hot - law.reference))
    if isinstance(law, Table):
        d = hot - cold if law.difference[0] < 0.0 else abs(hot - cold)
        return float(np.interp(d, law.difference, law.value))
    if isinstance(law, FilmTable):
        return float(law.at(hot - cold, hot + cold))
    return 1.0


def loss_slope(law: TemperatureLaw, T: float, inputs: Inputs) -> float:
    """How a loss that counts as 1 changes per K at T (degC) and an instant's inputs; 0 of a law that no loss has."""
    if isinstance(law, Linear):
        return law.alpha
    if isinstance(law, Conductivity):
        return -law.alpha * temperature_value(law, T, T) ** 2
    if isinstance(law, StreamTable):
        size = float(np.mean(law.size(inputs)))
        return float(law.at(size, T + 0.5) - law.at(size, T - 0.5))
    return 0.0
