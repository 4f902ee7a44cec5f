"""Ohmmeter and voltmeter as they err: a gain and an offset for each session within the data sheet, and steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from simulated.physics.draws import Draws

Array = NDArray[np.float64]
SHEETS = {"ohm": (0.25e-2, 2e-3, 2e-3), "volt": (0.1e-2, 1.0, 0.1)}  # gain, offset, step in ohm or V


def read(kind: str, true: Array | float, session: str, draws: Draws) -> Array:
    """Readings of one session, in which the meter's error does not change."""
    gain, offset, step = SHEETS[kind]
    errors = draws.stream(f"meter.{kind}.{session}").uniform(-1.0, 1.0, 2)
    draws.taken[f"meter.{kind}.{session}.gain"] = float(gain * errors[0])
    draws.taken[f"meter.{kind}.{session}.offset"] = float(offset * errors[1])
    seen = np.asarray(true, float) * (1 + gain * errors[0]) + offset * errors[1]
    return np.asarray(np.round(seen / step) * step)


def thermometer(true: Array | float, session: str, draws: Draws) -> Array:
    """A thermometer with a bias of 0.2 K (1 sigma) per session, read to 0.1 K."""
    seen = np.asarray(true, float) + draws.normal(f"thermometer.{session}.bias_K", 0.2, 0.4)
    return np.asarray(np.round(seen, 1))


def emf(cold_V: float, alpha: float, magnets: Array | float) -> Array:
    """Line-to-line back-EMF (V) at 383 rpm; the magnets lose `alpha` per K above 20 degC."""
    return cold_V * (1 + alpha * (np.asarray(magnets, float) - 20.0))
