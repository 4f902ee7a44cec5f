"""Bearings, brushes and commutator: friction and the way heat takes through them."""

from __future__ import annotations

import math

from lumped.correlations.info import Info, checked

CONTACT_PRESSURE_PA = 2.0e4  # usual spring pressure of carbon brushes, 15 to 25 kPa
BRUSH_FRICTION = 0.2  # carbon on copper, 0.15 to 0.3
CARBON_BRUSH_DROP = 2.0  # V, both brushes together (IEC 60034-2-1: 1 V each)
KYLANDER = (0.45, 0.12, 33.0)  # K s/(W m2), m, m/s
BRUSH_K = {"electrographite": 30.0, "carbon-graphite": 15.0, "metal-graphite": 40.0}  # W/m/K along the brush


def kylander_bearing(diameter: float, omega: float) -> tuple[float, Info]:
    """Thermal resistance of a ball bearing, inner to outer race (K/W).

    R = 0.45 (0.12 - d) (33 - omega d), mean diameter d (m), omega (rad/s).
    Range: d 0.02 to 0.11 m, omega d from 0 to 30 m/s. Source: Kylander 1995, thesis, Chalmers, as used by Trigeol et
    al. 2006 (read in citations, not in the original).
    """
    v = abs(omega) * diameter
    scale, largest, fastest = KYLANDER
    R = scale * (largest - diameter) * (fastest - v)
    return R, checked("kylander_bearing", "Kylander 1995", {"d": diameter, "v": v}, {"d": (0.02, 0.11), "v": (0, 30)})


def skf_friction(load: float, bore: float, omega: float, coefficient: float = 0.0015) -> float:
    """Friction of a rolling bearing (W): coefficient * load / 2 * bore * omega; load (N), bore (m), omega (rad/s).

    coefficient: 0.0015 deep-groove ball, 0.0011 cylindrical roller. Source: SKF general catalogue, one coefficient
    for loads of a tenth of the dynamic rating, good lubrication and usual speed.
    """
    return 0.5 * coefficient * load * bore * abs(omega)


def brush_friction(
    area: float, speed: float, pressure: float = CONTACT_PRESSURE_PA, coefficient: float = BRUSH_FRICTION
) -> float:
    """Rubbing of all brushes (W): coefficient * pressure (Pa) * contact area (m2) * surface speed (m/s). Coulomb."""
    return coefficient * pressure * area * abs(speed)


def brush_resistance(length: float, area: float, k: float = BRUSH_K["electrographite"]) -> float:
    """Along a brush from commutator to holder (K/W): length (m) over k (W/m/K) times section (m2). Fourier."""
    return length / (k * area)


def commutator_share(drop_V: float, current: float, friction_W: float) -> tuple[float, float]:
    """(to the commutator, to the brushes) of contact and rubbing loss (W): half each for the drop, as copper takes
    nine tenths of the rubbing heat (ratio of the effusivities sqrt(k rho cp) of copper and carbon)."""
    drop = drop_V * abs(current)
    return 0.5 * drop + 0.9 * friction_W, 0.5 * drop + 0.1 * friction_W


def mean_surface_speed(diameter: float, speed_rpm: float) -> float:
    """m/s"""
    return math.pi * diameter * abs(speed_rpm) / 60.0
