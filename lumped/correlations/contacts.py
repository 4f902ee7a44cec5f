"""Contacts, gaps and radiation between solids."""

import math

from geom.constants import SIGMA, ZERO_C
from lumped.correlations.info import Info, checked

K_AIR = 0.026  # W/m/K, of still air at 25 degC

# Effective air gaps (m) after the Motor-CAD default tables.
GAPS = {
    "stator lamination - housing, good": 0.01e-3,
    "lamination - metal, average": 0.03e-3,
    "metal - metal, average": 0.005e-3,
    "stainless - aluminium": 0.0073e-3,
    "stainless - stainless": 0.0112e-3,
    "bearing": 0.3e-3,
    "brush holder - brush": 0.1e-3,
    "commutator - shaft": 0.005e-3,
}


# Contact coefficients (W/m2/K), from loose to pressed. Holman; Mills.
PRESSED = {
    "aluminium - aluminium": (2200.0, 12000.0),
    "steel - aluminium": (4000.0, 45000.0),
    "stainless - stainless": (1700.0, 3700.0),
    "stainless - aluminium": (3000.0, 4500.0),
    "copper - copper": (10000.0, 25000.0),
    "ceramic - metal": (1500.0, 8500.0),
}


def contact_film(pair: str) -> tuple[float, float]:
    """(geometric mean W/m2/K, log-sd) of a pair in PRESSED: the prior of a contact; the limits are two sd apart."""
    low, high = PRESSED[pair]
    return math.sqrt(low * high), 0.5 * math.log(high / low) / 2.0


def gap_film(gap: float, k: float = K_AIR) -> float:
    """k / gap (W/m2/K): a contact as an effective gap of still air; gap (m), k (W/m/K)."""
    return k / gap


def cooper_mikic_yovanovich(
    k: float, slope: float, roughness: float, pressure: float, hardness: float, k_gas: float = K_AIR
) -> tuple[float, Info]:
    """Pressed contact of rough metals with gas between them, h (W/m2/K).

    1.25 k slope / roughness (p / H)^0.95 plus the gas in a gap of Y = 1.53 roughness (p / H)^-0.097.
    k: harmonic mean 2 k1 k2 / (k1 + k2); slope: of the asperities (1); roughness: rms of both (m);
    pressure, hardness (Pa).
    Range: 1e-6 < p/H < 0.02. Source: Cooper, Mikic, Yovanovich 1969, Int. J. Heat Mass Transfer 12, 279.
    """
    load = pressure / hardness
    solid = 1.25 * k * slope / roughness * load**0.95
    gas = k_gas / (1.53 * roughness * load**-0.097)
    info = checked("cooper_mikic_yovanovich", "CMY 1969", {"p/H": load, "h solid": solid}, {"p/H": (1e-6, 0.02)})
    return solid + gas, info


def radiation_film(emissivity: float, hot: float, cold: float, view: float = 1.0) -> tuple[float, Info]:
    """sigma e F (Th^2 + Tc^2)(Th + Tc) (W/m2/K); hot, cold (degC). Range: e, F from 0 to 1. Stefan-Boltzmann."""
    a, b = hot + ZERO_C, cold + ZERO_C
    h = SIGMA * emissivity * view * (a * a + b * b) * (a + b)
    return h, checked("radiation_film", "Stefan-Boltzmann", {"e": emissivity, "F": view}, {"e": (0, 1), "F": (0, 1)})


def groove_emissivity(emissivity: float, depth: float, spacing: float) -> float:
    """Apparent emissivity of the opening of a rectangular groove between fins: e / (e + (1 - e) opening/walls).

    One isothermal grey enclosure: radiation leaving the opening of area `spacing` from walls 2 depth + spacing.
    Source: Incropera et al. 2007, two-surface enclosure (13.18) with the opening black.
    """
    return emissivity / (emissivity + (1.0 - emissivity) * spacing / (2.0 * depth + spacing))


def concentric_cylinders(inner_area: float, outer_area: float, inner: float, outer: float) -> float:
    """Effective emissivity of a gap, on the inner area: 1 / (1/e1 + A1/A2 (1/e2 - 1)) (Incropera 13.20)."""
    return 1.0 / (1.0 / inner + inner_area / outer_area * (1.0 / outer - 1.0))


def coaxial_discs(radius_1: float, radius_2: float, distance: float) -> float:
    """View factor of two parallel discs on one axis (m): rotor face to end shield.

    The share of what surface 1 sends out diffusely that falls on surface 2.

    S = 1 + (1 + R2^2)/R1^2, F = (S - sqrt(S^2 - 4 (r2/r1)^2)) / 2, Ri = ri/distance. Worked: equal discs one radius
    apart, F = 0.382. Source: Incropera et al. 2007, table 13.2.
    """
    R1, R2 = radius_1 / distance, radius_2 / distance
    S = 1 + (1 + R2**2) / R1**2
    return 0.5 * (S - math.sqrt(S**2 - 4 * (radius_2 / radius_1) ** 2))


def parallel_rectangles(width: float, length: float, distance: float) -> float:
    """View factor of two equal aligned rectangles (m).

    Worked: unit squares one apart, F = 0.1998. Source: Incropera et al. 2007, table 13.2.
    """
    X, Y = width / distance, length / distance
    x, y = math.sqrt(1 + X * X), math.sqrt(1 + Y * Y)
    log = 0.5 * math.log((x * y) ** 2 / (1 + X * X + Y * Y))
    arcs = X * y * math.atan(X / y) + Y * x * math.atan(Y / x) - X * math.atan(X) - Y * math.atan(Y)
    return 2 / (math.pi * X * Y) * (log + arcs)
