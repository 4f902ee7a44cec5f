"""The T-circuit of a hollow cylinder."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class TCircuit:
    """Resistances (K/W) of a hollow cylinder: faces, ends (alike), radial star point to the mean node (negative)."""

    outer: float
    inner: float
    radial_mean: float
    end: float


def mellor(outer_radius: float, inner_radius: float, length: float, k_radial: float, k_axial: float) -> TCircuit:
    """T-equivalent circuit, exact for the mean temperature of a uniformly heated hollow cylinder; inner_radius > 0.

    Source: Mellor, Roberts, Turner 1991, IEE Proc. B 138, 205.
    """
    d = outer_radius**2 - inner_radius**2
    log, radial = math.log(outer_radius / inner_radius), 4 * math.pi * k_radial * length
    outer = (1 - 2 * inner_radius**2 * log / d) / radial
    inner = (2 * outer_radius**2 * log / d - 1) / radial
    squares = outer_radius**2 + inner_radius**2
    mean = -(squares - 4 * outer_radius**2 * inner_radius**2 * log / d) / (2 * radial * d)
    end = length / (2 * math.pi * k_axial * d)
    return TCircuit(outer, inner, mean, end)
