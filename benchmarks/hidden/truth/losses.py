"""Losses (W). T in degC, currents in A, speeds in rpm."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ALPHA = 0.00393


def copper(R20: float, current: float, T: Array, skin: float = 0.0, rpm: float = 0.0) -> Array:
    """Per-cell loss of a winding of 3 R20 in all; skin: extra share at 1000 rpm, growing with the square."""
    return 3.0 * R20 * current**2 * (1.0 + ALPHA * (T - 20.0)) * (1.0 + skin * (rpm / 1000.0) ** 2)


def bertotti(T: Array, f: float, hysteresis: float, eddy: float, excess: float) -> Array:
    """Bertotti 1988 at constant flux: hysteresis f + eddy f^2 + excess f^1.5, f relative to the rated; eddies fade as
    the steel warms (0.1 %/K)."""
    return hysteresis * f + eddy * f**2 / (1.0 + 0.001 * (T - 40.0)) + excess * f**1.5


def friction(T: Array, f: float, P: float, thinning: float = 0.006) -> Array:
    """Grease-lubricated bearing: P f^1.1 at 40 degC, less as the grease thins."""
    return P * f**1.1 * np.exp(-thinning * (T - 40.0))
