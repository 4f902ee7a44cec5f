"""Forced flow inside ducts, jackets and channels."""

import math

from lumped.correlations.info import Info, checked
from lumped.transfer.properties import Fluid, air

LAMINAR, TURBULENT, COIL_TURBULENT = 2300.0, 4000.0, 22001.0  # Reynolds numbers, VDI Heat Atlas G1 and G3


def hausen_laminar(Re: float, Pr: float, diameter: float, length: float, developed: float = 3.66) -> float:
    """Nu = developed + 0.065 X / (1 + 0.04 X^(2/3)), X = diameter/length Re Pr: laminar, entering with even speed.

    Source: Hausen 1943 in the form of Mills 1995; developed = 3.66 for a circle at constant wall temperature.
    """
    X = diameter / length * Re * Pr
    return developed + 0.065 * X / (1.0 + 0.04 * X ** (2.0 / 3.0))


def gnielinski_turbulent(Re: float, Pr: float) -> float:
    """Nu of turbulent flow in a smooth duct, f = (0.79 ln Re - 1.64)^-2.

    Range: 3000 < Re < 5e6, 0.5 < Pr < 2000. Source: Gnielinski 1976, Int. Chem. Eng. 16, 359 (ht).
    """
    import ht

    return ht.turbulent_Gnielinski(Re, Pr, (0.79 * math.log(Re) - 1.64) ** -2)


def duct_film(
    speed: float, diameter: float, length: float, fluid: Fluid | None = None, developed: float = 3.66
) -> tuple[float, Info]:
    """Mean film of a duct, h (W/m2/K).

    Nu is `hausen_laminar` below Re 2300, `gnielinski_turbulent` above 4000, linear between.
    speed (m/s), diameter: hydraulic, 4 A/P (m), length (m); fluid defaults to air at 40 degC;
    developed: laminar Nu far from the entry (3.66 circle, staton_rectangle, 7.54 parallel plates).
    Range: Re < 5e6, 0.5 < Pr < 2000. Source: Gnielinski 2013, Int. J. Heat Mass Transfer 63, 134 (transition).
    """
    fluid = fluid or air(40.0)
    Re, Pr = abs(speed) * diameter / fluid.nu, fluid.Pr
    share = min(max((Re - LAMINAR) / (TURBULENT - LAMINAR), 0.0), 1.0)
    Nu = (1.0 - share) * hausen_laminar(min(Re, LAMINAR), Pr, diameter, length, developed)
    if share > 0.0:
        Nu += share * gnielinski_turbulent(max(Re, TURBULENT), Pr)
    info = checked("duct_film", "Gnielinski 2013", {"Nu": Nu, "Re": Re, "Pr": Pr}, {"Re": (0, 5e6), "Pr": (0.5, 2000)})
    return Nu * fluid.k / diameter, info


def shah_london(side_ratio: float) -> float:
    """Developed laminar Nu of a rectangle at constant heat flux (4.36 for a circle); side_ratio 0 to 1.

    Source: Shah and London 1978 (ht).
    """
    import ht

    return ht.Nu_laminar_rectangular_Shan_London(side_ratio)


def schmidt_helical(speed: float, diameter: float, coil_diameter: float, fluid: Fluid) -> tuple[float, Info]:
    """Film of a helical channel (spiral jacket), h (W/m2/K).

    Laminar below Re_crit(coil): Nu = 3.66 + 0.08 (1 + 0.8 (d/D)^0.9) Re^m Pr^(1/3), m = 0.5 + 0.2903 (d/D)^0.194;
    turbulent above 22000 by ht (whose own branch changes there); linear in Re between.
    diameter: hydraulic (m), coil_diameter: of the helix (m). Range: Re < 2e5; 0.5 < Pr < 2000 as of a straight duct,
    since Schmidt names none.
    Source: E. F. Schmidt 1967, Chem. Ing. Tech. 39, 781; VDI Heat Atlas G3.
    """
    import fluids
    import ht

    Re, Pr, ratio = abs(speed) * diameter / fluid.nu, fluid.Pr, diameter / coil_diameter
    critical = fluids.helical_transition_Re_Schmidt(diameter, coil_diameter)
    share = min(max((Re - critical) / (COIL_TURBULENT - critical), 0.0), 1.0)
    low, high = min(Re, critical), max(Re, COIL_TURBULENT)
    laminar = 3.66 + 0.08 * (1 + 0.8 * ratio**0.9) * low ** (0.5 + 0.2903 * ratio**0.194) * Pr ** (1 / 3)
    Nu = (1.0 - share) * laminar
    if share > 0.0:
        Nu += share * ht.helical_turbulent_Nu_Schmidt(high, Pr, diameter, coil_diameter)
    source, limits = "Schmidt 1967; Pr by Gnielinski 1976", {"Re": (0.0, 2e5), "Pr": (0.5, 2000.0)}
    info = checked("schmidt_helical", source, {"Nu": Nu, "Re": Re, "Pr": Pr}, limits)
    return Nu * fluid.k / diameter, info


def staton_rectangle(side_ratio: float) -> float:
    """Developed laminar Nu of a rectangle at constant wall temperature; side_ratio a from 0 to 1.

    7.49 - 17.02 a + 22.43 a^2 - 9.94 a^3. Source: Staton and Cavagnino 2008, IEEE Trans. Ind. Electron. 55, 3509.
    """
    return 7.49 - 17.02 * side_ratio + 22.43 * side_ratio**2 - 9.94 * side_ratio**3


def gnielinski_annulus(
    speed: float, inner: float, outer: float, length: float, fluid: Fluid | None = None
) -> tuple[float, Info]:
    """Concentric annulus heated inside, outside insulated, h (W/m2/K): axial flow between shells or through a gap.

    Turbulent above Re 4000: f (1.8 log10 Re* - 1.5)^-2, Re* = Re ((1 + a^2) ln a + 1 - a^2) / ((1 - a)^2 ln a), factor
    0.75 a^-0.17, a = inner/outer; k1 = 1.07 + 900/Re - 0.63/(1 + 10 Pr); entry 1 + (D/L)^(2/3). Laminar below 2300:
    developed Nu 3.66 + 1.2 a^-0.8 with Hausen's entry; linear between.
    speed (m/s); inner, outer: diameters (m); length (m). Range: Re < 1e6, 0.6 < Pr < 1000.
    Source: Gnielinski 2009, Heat Transfer Eng. 30, 431; VDI Heat Atlas G2 (laminar).
    """
    fluid = fluid or air(40.0)
    D, a = outer - inner, inner / outer
    Re, Pr = abs(speed) * D / fluid.nu, fluid.Pr
    share = min(max((Re - LAMINAR) / (TURBULENT - LAMINAR), 0.0), 1.0)
    Nu = (1.0 - share) * hausen_laminar(min(Re, LAMINAR), Pr, D, length, 3.66 + 1.2 * a**-0.8)
    if share > 0.0:
        turbulent = max(Re, TURBULENT)
        star = turbulent * ((1 + a * a) * math.log(a) + 1 - a * a) / ((1 - a) ** 2 * math.log(a))
        f = 0.75 * a**-0.17 * (1.8 * math.log10(star) - 1.5) ** -2
        k1 = 1.07 + 900 / turbulent - 0.63 / (1 + 10 * Pr)
        entry = 1 + (D / length) ** (2 / 3)
        Nu += share * ((f / 8) * turbulent * Pr / (k1 + 12.7 * math.sqrt(f / 8) * (Pr ** (2 / 3) - 1)) * entry)
    limits = {"Re": (0, 1e6), "Pr": (0.6, 1000)}
    return Nu * fluid.k / D, checked("gnielinski_annulus", "Gnielinski 2009", {"Nu": Nu, "Re": Re, "Pr": Pr}, limits)
