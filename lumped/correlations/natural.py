"""Natural convection from plain outer surfaces."""

import math
from collections.abc import Callable

from geom.constants import GRAVITY as G
from lumped.correlations.info import Info, checked
from lumped.transfer.properties import Fluid, air

MOST_CURVED = 5.0  # end of its range
Of = Callable[[float], Fluid]


def _grashof(L: float, hot: float, cold: float, fluid: Fluid) -> float:
    return G * fluid.beta * abs(hot - cold) * L**3 / fluid.nu**2


def churchill_chu_cylinder(diameter: float, surface: float, ambient: float, of: Of = air) -> tuple[float, Info]:
    """Horizontal cylinder in still fluid, h (W/m2/K).

    Nu = (0.60 + 0.387 Ra^(1/6) / (1 + (0.559/Pr)^(9/16))^(8/27))^2, properties at film temperature.
    diameter (m); surface, ambient (degC); of: T (degC) -> Fluid.
    Range: Ra < 1e12. Source: Churchill and Chu 1975, Int. J. Heat Mass Transfer 18, 1049 (ht).
    """
    import ht

    fluid = of(0.5 * (surface + ambient))
    Gr = _grashof(diameter, surface, ambient, fluid)
    Nu = ht.Nu_horizontal_cylinder_Churchill_Chu(fluid.Pr, Gr)
    info = checked("churchill_chu_cylinder", "Churchill & Chu 1975", {"Nu": Nu, "Ra": Gr * fluid.Pr}, {"Ra": (0, 1e12)})
    return Nu * fluid.k / diameter, info


def churchill_chu_plate(height: float, surface: float, ambient: float, of: Of = air) -> tuple[float, Info]:
    """Vertical plate or end shield in still fluid, h (W/m2/K).

    Nu = (0.825 + 0.387 Ra^(1/6) / (1 + (0.492/Pr)^(9/16))^(8/27))^2, properties at film temperature.
    height (m); surface, ambient (degC).  Worked value: tests/lumped/correlations.
    Range: Ra < 1e12. Source: Churchill and Chu 1975, Int. J. Heat Mass Transfer 18, 1323 (ht).
    """
    import ht

    fluid = of(0.5 * (surface + ambient))
    Gr = _grashof(height, surface, ambient, fluid)
    Nu = ht.Nu_vertical_plate_Churchill(fluid.Pr, Gr)
    info = checked("churchill_chu_plate", "Churchill & Chu 1975", {"Nu": Nu, "Ra": Gr * fluid.Pr}, {"Ra": (0, 1e12)})
    return Nu * fluid.k / height, info


def mcadams_plate(
    area_over_perimeter: float, surface: float, ambient: float, upward: bool = True, of: Of = air
) -> tuple[float, Info]:
    """Horizontal plate in still fluid, h (W/m2/K): base, feet, top of a box.

    Heat carried away freely (hot facing up): 0.54 Ra^(1/4) below 1e7, 0.15 Ra^(1/3) above; held back: 0.27 Ra^(1/4).
    area_over_perimeter (m); upward: the hot side faces up (or the cold side down). The two branches meet at their
    crossing Ra = 4.8e6 instead of jumping at 1e7.
    Range: Ra 1e4 to 1e11 (free), 1e5 to 1e10 (held back).
    Source: McAdams 1954, Heat Transmission, in Incropera et al. 2007 eq. 9.30-9.32.
    """
    fluid = of(0.5 * (surface + ambient))
    Ra = _grashof(area_over_perimeter, surface, ambient, fluid) * fluid.Pr
    Nu = max(0.54 * Ra**0.25, 0.15 * Ra ** (1 / 3)) if upward else 0.27 * Ra**0.25
    limits = (1e4, 1e11) if upward else (1e5, 1e10)
    info = checked("mcadams_plate", "McAdams 1954", {"Nu": Nu, "Ra": Ra}, {"Ra": limits})
    return Nu * fluid.k / area_over_perimeter, info


def popiel_cylinder(height: float, diameter: float, surface: float, ambient: float, of: Of = air) -> tuple[float, Info]:
    """Slender vertical cylinder in still fluid, h (W/m2/K): vertical machines, shafts.

    The plate's Nu times 1 + B X^C, X = sqrt(32) Gr^(-1/4) height/diameter, B and C functions of Pr. The usual rule that
    a cylinder with diameter/height >= 35/Gr^(1/4) is a plate would jump by 5 % there; here the factor fades by itself.
    X is held at 5: the formula would grow without bound as the difference vanishes.
    height, diameter (m); surface, ambient (degC).
    Range: 0.01 < Pr < 100, Ra < 1e12, X < 5 (ours). Source: Popiel 2008, Heat Transfer Eng. 29, 521 (ht).
    """
    import ht

    fluid = of(0.5 * (surface + ambient))
    Gr, slender = _grashof(height, surface, ambient, fluid), height / diameter
    X = math.sqrt(32.0) * slender / Gr**0.25 if Gr > 0.0 else math.inf
    least = 32.0**2 * (slender / MOST_CURVED) ** 4
    factor = ht.Nu_vertical_cylinder_Popiel_Churchill(fluid.Pr, max(Gr, least), height, diameter)
    factor /= ht.Nu_vertical_plate_Churchill(fluid.Pr, max(Gr, least))
    Nu = factor * ht.Nu_vertical_plate_Churchill(fluid.Pr, Gr)
    numbers = {"Nu": Nu, "Ra": Gr * fluid.Pr, "Pr": fluid.Pr, "X": X}
    limits = {"Ra": (0.0, 1e12), "Pr": (0.01, 100.0), "X": (0.0, MOST_CURVED)}
    return Nu * fluid.k / height, checked("popiel_cylinder", "Popiel 2008", numbers, limits)
