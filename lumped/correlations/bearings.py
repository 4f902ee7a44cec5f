"""Bearings and brushes: friction, and the way heat takes through a bearing."""

from lumped.correlations.info import Info, checked

CONTACT_PRESSURE_PA = 2.0e4  # usual spring pressure of carbon brushes, 15 to 25 kPa
BRUSH_FRICTION = 0.2  # carbon on copper, 0.15 to 0.3
KYLANDER = (0.45, 0.12, 33.0)  # K s/(W m2), m, m/s


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
