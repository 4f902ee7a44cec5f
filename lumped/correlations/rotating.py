"""Rotating discs and shafts: film and windage."""

import math

from lumped.correlations.info import Info, checked
from lumped.transfer.properties import Fluid, air

DISC_CRITICAL = 2.4e5  # of the rim's speed and radius: where a free disc turns turbulent
TORQUE_LAWS = ((10.0, 1.0), (2.0, 0.6), (1.03, 0.5), (0.065, 0.2))  # Bilgen and Boulos 1973, the largest holds


def rotating_disc(omega: float, radius: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Mean film of a free rotating disc: rotor end faces, h (W/m2/K).

    Nu_r = 0.36 Re^(1/2) laminar up to Re = omega r^2 / nu = 2.4e5; beyond, the rim is turbulent, locally
    0.0151 Re^0.8, averaged over the area with the
    laminar core kept, so that the mean has no jump.
    omega (rad/s), radius (m). Range: Re < 1e7. Source: Howey, Childs, Holmes 2012, IEEE Trans. Ind. Electron. 59.
    """
    fluid = fluid or air(50.0)
    Re = abs(omega) * radius**2 / fluid.nu
    core = min(Re, DISC_CRITICAL)
    laminar = 0.36 * core**0.5 * (core / Re) ** 0.5 if Re > 0 else 0.0
    turbulent = 0.0151 * (2 / 2.6) * (Re**0.8 - DISC_CRITICAL**1.3 / Re**0.5) if Re > DISC_CRITICAL else 0.0
    Nu = laminar + turbulent
    return Nu * fluid.k / radius, checked("rotating_disc", "Howey et al. 2012", {"Nu": Nu, "Re": Re}, {"Re": (0, 1e7)})


def levich_disc(omega: float, radius: float, fluid: Fluid) -> tuple[float, Info]:
    """Mean film of a disc that turns in much liquid, laminar: a rotor's end face in oil, h (W/m2/K).

    Nu_r = 0.62048 Re^(1/2) Pr^(1/3) / (1 + 0.2980 Pr^(-1/3) + 0.14514 Pr^(-2/3)), Re = omega r^2 / nu; alike all over.
    omega (rad/s), radius (m). Range: Re < 2.4e5, Pr > 20 (exact to 0.1 % from 100 on).
    Source: Levich 1942; Newman 1966, J. Phys. Chem. 70, 1327.
    """
    Re, Pr = abs(omega) * radius**2 / fluid.nu, fluid.Pr
    Nu = 0.62048 * Re**0.5 * Pr ** (1 / 3) / (1 + 0.2980 * Pr ** (-1 / 3) + 0.14514 * Pr ** (-2 / 3))
    limits = {"Re": (0.0, DISC_CRITICAL), "Pr": (20.0, 1e5)}
    return Nu * fluid.k / radius, checked("levich_disc", "Newman 1966", {"Nu": Nu, "Re": Re, "Pr": Pr}, limits)


def rotating_shaft(omega: float, diameter: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Film of a rotating shaft in still air, h (W/m2/K): Nu = 0.133 Re^(2/3) Pr^(1/3), Re = omega D^2 / (2 nu).

    Range: 1e3 < Re < 4.3e5, 0.7 < Pr < 670. Source: Etemad 1955 in Kays and Bjorklund 1958, Trans. ASME 80, 70.
    """
    fluid = fluid or air(50.0)
    Re = abs(omega) * diameter**2 / (2 * fluid.nu)
    Nu = 0.133 * Re ** (2 / 3) * fluid.Pr ** (1 / 3)
    return Nu * fluid.k / diameter, checked("rotating_shaft", "Etemad 1955", {"Nu": Nu, "Re": Re}, {"Re": (1e3, 4.3e5)})


def saari_windage(
    omega: float, rotor_radius: float, gap: float, length: float, roughness: float = 1.0, fluid: Fluid | None = None
) -> tuple[float, Info]:
    """Friction of the air in the gap (W): P = roughness C pi rho omega^3 r^4 length.

    C of Re = omega r gap / nu: 10 d/Re, 2 d/Re^0.6 (from Re 64 as printed), 1.03 d/Re^0.5 (from 500), 0.065 d/Re^0.2
    (from 1e4), d = (gap/r)^0.3. As printed C jumps by 6 % at 64 and 4 % at 500; here the larger rules, so that the
    branches meet (at 56, 763 and 1e4). omega (rad/s), lengths (m). Range: Re < 1e6.
    Source: Saari 1998, thesis, Helsinki University of Technology (after Bilgen and Boulos 1973).
    """
    fluid = fluid or air(80.0)
    Re, d = abs(omega) * rotor_radius * gap / fluid.nu, (gap / rotor_radius) ** 0.3
    C = max(d * scale / Re**exponent for scale, exponent in TORQUE_LAWS) if Re > 0.0 else 0.0
    power = roughness * C * math.pi * fluid.rho * abs(omega) ** 3 * rotor_radius**4 * length
    return power, checked("saari_windage", "Saari 1998", {"Re": Re, "C": C}, {"Re": (0, 1e6)})


def disc_windage(
    omega: float, outer_radius: float, inner_radius: float = 0.0, fluid: Fluid | None = None
) -> tuple[float, Info]:
    """Friction of ONE end face of a rotor (W): P = C rho omega^3 (r2^5 - r1^5) / 4.

    C = 3.87 / Re^0.5 laminar, 0.146 / Re^0.2 turbulent, Re = omega r2^2 / nu; the larger rules, so they meet at
    Re = 5.5e4. omega (rad/s), radii (m). Range: Re < 1e7.
    Source: Saari 1998, thesis, Helsinki University of Technology; his C counts both faces, so half of it here.
    """
    fluid = fluid or air(60.0)
    Re = abs(omega) * outer_radius**2 / fluid.nu
    C = max(3.87 / Re**0.5, 0.146 / Re**0.2) if Re > 0 else 0.0
    power = 0.25 * C * fluid.rho * abs(omega) ** 3 * (outer_radius**5 - inner_radius**5)
    return power, checked("disc_windage", "Saari 1998", {"Re": Re, "C": C}, {"Re": (0, 1e7)})
