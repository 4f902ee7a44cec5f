"""Temperature laws in ordinary NumPy, for what looks at a network from outside the compiled kernel."""

from __future__ import annotations

import numpy as np

from geom.constants import SIGMA, ZERO_C
from lumped.transfer.laws import (
    FILMS,
    FIRST_C,
    STEP_K,
    Conductivity,
    FilmTable,
    Linear,
    Power,
    Radiation,
    Table,
    TemperatureLaw,
)


def temperature_value(law: TemperatureLaw, hot: float, cold: float) -> float:
    """The law at two temperatures (degC)."""
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
        films = np.reshape(law.value, (FILMS, -1))
        along = [np.interp(abs(hot - cold), law.difference, row) for row in films]
        return float(np.interp(0.5 * (hot + cold), FIRST_C + STEP_K * np.arange(FILMS), along))
    return 1.0


def loss_slope(law: TemperatureLaw, T: float) -> float:
    """How a loss that counts as 1 changes per K at T (degC); 0 of a law that no loss has."""
    if isinstance(law, Linear):
        return law.alpha
    if isinstance(law, Conductivity):
        return -law.alpha * temperature_value(law, T, T) ** 2
    return 0.0
