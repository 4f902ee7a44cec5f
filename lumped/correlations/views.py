"""View factors F12: the share of what surface 1 sends out diffusely that falls on surface 2."""

from __future__ import annotations

import math


def coaxial_discs(radius_1: float, radius_2: float, distance: float) -> float:
    """Two parallel discs on one axis (m): rotor face to end shield.

    S = 1 + (1 + R2^2)/R1^2, F = (S - sqrt(S^2 - 4 (r2/r1)^2)) / 2, Ri = ri/distance. Worked: equal discs one radius
    apart, F = 0.382. Source: Incropera et al. 2007, table 13.2.
    """
    R1, R2 = radius_1 / distance, radius_2 / distance
    S = 1 + (1 + R2**2) / R1**2
    return 0.5 * (S - math.sqrt(S**2 - 4 * (radius_2 / radius_1) ** 2))


def parallel_rectangles(width: float, length: float, distance: float) -> float:
    """Two equal aligned rectangles (m). Worked: unit squares one apart, F = 0.1998 (Incropera et al. 2007, 13.2)."""
    X, Y = width / distance, length / distance
    x, y = math.sqrt(1 + X * X), math.sqrt(1 + Y * Y)
    log = 0.5 * math.log((x * y) ** 2 / (1 + X * X + Y * Y))
    arcs = X * y * math.atan(X / y) + Y * x * math.atan(Y / x) - X * math.atan(X) - Y * math.atan(Y)
    return 2 / (math.pi * X * Y) * (log + arcs)
