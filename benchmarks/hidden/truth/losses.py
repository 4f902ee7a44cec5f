"""Losses (W). T in degC, currents in A, speeds in rpm."""

from __future__ import annotations

import numpy as np

from hidden.truth.body import Array
from hidden.truth.draw import Draw
from hidden.truth.machine import LossLaw

ALPHA = 0.00393


def copper(R20: float, current: float, T: Array) -> Array:
    """Per-cell loss of a winding of 3 R20 in all."""
    return 3.0 * R20 * current**2 * (1.0 + ALPHA * (T - 20.0))


def joule(R20: float, input_A: str = "current_A") -> LossLaw:
    """Loss of a winding under one of the inputs."""
    return lambda T, u: copper(R20, u[input_A], T)


def bertotti(T: Array, f: float, hysteresis: float, eddy: float, excess: float) -> Array:
    """Bertotti 1988 at constant flux: hysteresis f + eddy f^2 + excess f^1.5, f relative to the rated; eddies fade as
    the steel warms (0.1 %/K)."""
    return hysteresis * f + eddy * f**2 / (1.0 + 0.001 * (T - 40.0)) + excess * f**1.5


def steel(d: Draw, rated_rpm: float, hysteresis: float, eddy: float, excess: float) -> LossLaw:
    """A core at the speed over the rated one; its three parts (W) are drawn."""
    kh, ke, kx = hysteresis * d.factor("iron", 0.15), eddy * d.factor("eddy", 0.2), excess * d.factor("excess", 0.3)
    return lambda T, u: bertotti(T, abs(u["speed_rpm"]) / rated_rpm, kh, ke, kx)


def magnet_eddy(P: float, rated_rpm: float) -> LossLaw:
    """Eddies in magnets: P f^1.9 at 40 degC, less as they warm."""
    return lambda T, u: P * (abs(u["speed_rpm"]) / rated_rpm) ** 1.9 / (1.0 + 0.0005 * (T - 40.0))


def bearing(P: float, rated_rpm: float, thinning: float = 0.006) -> LossLaw:
    """Grease-lubricated: P f^1.1 at 40 degC, f relative to the rated speed; less as the grease thins (per K)."""
    return lambda T, u: P * (abs(u["speed_rpm"]) / rated_rpm) ** 1.1 * np.exp(-thinning * (T - 40.0))
