"""Forced convection on outer surfaces."""

from lumped.correlations.info import Info, checked
from lumped.transfer.properties import Fluid, air

CRITICAL_RE = 5e5  # of a smooth plate in quiet air (Incropera); a rough one turns turbulent earlier


def flat_plate(speed: float, length: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Mean film of a flat plate along the wind, h (W/m2/K): end shields, housings.

    Nu = 0.664 Re^(1/2) Pr^(1/3) up to Re 5e5, then the same plus the turbulent part 0.037 (Re^0.8 - 5e5^0.8) Pr^(1/3):
    both regimes meet, and far above the known (0.037 Re^0.8 - 871) Pr^(1/3) results.
    speed (m/s), length along the wind (m). Range: Re < 1e8, 0.6 < Pr < 60. Source: Incropera 2007 eq. 7.30, 7.38.
    """
    fluid = fluid or air(30.0)
    Re, Pr = abs(speed) * length / fluid.nu, fluid.Pr
    Nu = 0.664 * min(Re, CRITICAL_RE) ** 0.5 * Pr ** (1 / 3)
    Nu += 0.037 * (max(Re, CRITICAL_RE) ** 0.8 - CRITICAL_RE**0.8) * Pr ** (1 / 3)
    numbers = {"Nu": Nu, "Re": Re, "Pr": Pr}
    return Nu * fluid.k / length, checked("flat_plate", "Incropera 2007", numbers, {"Re": (0, 1e8), "Pr": (0.6, 60)})


def churchill_bernstein(speed: float, diameter: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Cylinder across the wind, h (W/m2/K).

    Range: Re Pr > 0.2 (below, the film tends to the still Nu = 0.3), Re < 1e7.
    Source: Churchill and Bernstein 1977, J. Heat Transfer 99, 300 (ht).
    """
    import ht

    fluid = fluid or air(30.0)
    Re = abs(speed) * diameter / fluid.nu
    Nu = ht.Nu_cylinder_Churchill_Bernstein(Re, fluid.Pr)
    numbers = {"Nu": Nu, "Re": Re, "Re Pr": Re * fluid.Pr}
    limits = {"Re": (0, 1e7), "Re Pr": (0.2, 1e8)}
    return Nu * fluid.k / diameter, checked("churchill_bernstein", "Churchill & Bernstein 1977", numbers, limits)
