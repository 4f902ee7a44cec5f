"""Losses (W). T in degC, currents in A, speeds in rpm."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ALPHA = 0.00393


def copper(R20: float, current: float, T: Array) -> Array:
    """Per-cell loss of a winding of 3 R20 in all."""
    return 3.0 * R20 * current**2 * (1.0 + ALPHA * (T - 20.0))


def joule(R20: float, input_A: str = "current_A") -> Callable[[Array, Mapping[str, float]], Array]:
    """Loss of a winding under one of the inputs."""
    return lambda T, u: copper(R20, u[input_A], T)


def bertotti(T: Array, f: float, hysteresis: float, eddy: float, excess: float) -> Array:
    """Bertotti 1988 at constant flux: hysteresis f + eddy f^2 + excess f^1.5, f relative to the rated; eddies fade as
    the steel warms (0.1 %/K)."""
    return hysteresis * f + eddy * f**2 / (1.0 + 0.001 * (T - 40.0)) + excess * f**1.5


def bearing(P: float, rated_rpm: float, thinning: float = 0.006) -> Callable[[Array, Mapping[str, float]], Array]:
    """Grease-lubricated: P f^1.1 at 40 degC, f relative to the rated speed; less as the grease thins (per K)."""
    return lambda T, u: P * (abs(u["speed_rpm"]) / rated_rpm) ** 1.1 * np.exp(-thinning * (T - 40.0))
