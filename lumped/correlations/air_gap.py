"""The annular gap between rotor and stator."""

import math

from lumped.correlations.info import Info, checked
from lumped.transfer.properties import Fluid, air

AXIAL_RE = 3e3  # lower end of what was measured; below, the law is held there


def taylor_film(omega: float, rotor_radius: float, gap: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Film between ONE wall of a smooth gap and its air, h (W/m2/K); rotor and stator see one each, in series.

    Ta = omega rotor_radius gap / nu * sqrt(gap / rotor_radius); Nu = h gap / k = 2 (Ta < 41),
    0.212 Ta^0.63 Pr^0.27 (41 to 100), 0.386 Ta^0.5 Pr^0.27 (above); the branches meet at their crossings.
    Two films of Nu = 2 in series are pure conduction k / gap.
    omega (rad/s), rotor_radius (m), gap (m); fluid defaults to air at 80 degC.
    Range: gap/rotor_radius < 0.25, Ta < 1e4. Source: G. I. Taylor 1935, Proc. R. Soc. A 151, 494, after Boglietti et
    al. 2009, IEEE Trans. Ind. Electron. 56, 871 (some prints say 0.202, which jumps at Ta = 41).
    """
    fluid = fluid or air(80.0)
    Ta = abs(omega) * rotor_radius * gap / fluid.nu * math.sqrt(gap / rotor_radius)
    Nu = max(2.0, min(0.212 * Ta**0.63, 0.386 * Ta**0.5) * fluid.Pr**0.27)
    numbers = {"Nu": Nu, "Ta": Ta, "gap/radius": gap / rotor_radius}
    info = checked("taylor_film", "Taylor 1935", numbers, {"gap/radius": (0, 0.25), "Ta": (0, 1e4)})
    return Nu * fluid.k / gap, info


def becker_kaye(omega: float, rotor_radius: float, gap: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """The whole smooth gap from rotor to stator, h (W/m2/K).

    X = Ta_m^2 / F_g^2, Ta_m = omega r_m^(1/2) gap^(3/2) / nu; Nu = 2 h gap / k = 2 (X < 1700), 0.128 X^0.367 (to 1e4),
    0.409 X^0.241 (to 1e7); the branches meet at their crossings.
    omega (rad/s), rotor_radius (m), gap (m); fluid defaults to air at 80 degC.
    Range: X < 1e7, gap/mean radius < 0.25.
    Source: Becker and Kaye 1962, J. Heat Transfer 84, 97, in Howey, Childs, Holmes 2012, IEEE Trans. Ind. Electron. 59.
    """
    fluid = fluid or air(80.0)
    mean = rotor_radius + 0.5 * gap
    Ta = abs(omega) * math.sqrt(mean) * gap**1.5 / fluid.nu
    # F_g of Becker and Kaye: 1 for a thin gap
    x = (gap / mean) / (1.0 - gap / (2.0 * mean))
    S = 0.0571 * (1.0 - 0.652 * x) + 0.00056 / (1.0 - 0.652 * x)
    X = (Ta / (math.pi**2 / (41.19 * math.sqrt(S)) / (1.0 - gap / (2.0 * mean)))) ** 2
    Nu = max(2.0, min(0.128 * X**0.367, 0.409 * X**0.241))
    numbers = {"Nu": Nu, "Ta": Ta, "X": X, "gap/radius": gap / mean}
    info = checked("becker_kaye", "Becker & Kaye 1962", numbers, {"X": (0, 1e7), "gap/radius": (0, 0.25)})
    return Nu * fluid.k / (2.0 * gap), info


def romanazzi_howey(omega: float, rotor_radius: float, gap: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Gap with salient poles (switched reluctance, DC field poles), one wall, h (W/m2/K).

    Nu = 0.181 X^0.207, held at 2 where the formula falls below conduction. Only the abstract of the source was
    read: that X is the squared Taylor number omega^2 r_m gap^3 / nu^2 and that Nu is per
    wall is inferred (unsquared, Nu stays below conduction at every speed), and so is the range.
    Range: Ta < 1e4.
    Source: Romanazzi and Howey 2015, arXiv 1502.05902.
    """
    fluid = fluid or air(80.0)
    Ta = abs(omega) * math.sqrt(rotor_radius + 0.5 * gap) * gap**1.5 / fluid.nu
    Nu = max(2.0, 0.181 * (Ta * Ta) ** 0.207)
    info = checked("romanazzi_howey", "Romanazzi & Howey 2015", {"Nu": Nu, "Ta": Ta}, {"Ta": (0, 1e4)})
    return Nu * fluid.k / gap, info


def kosterin_finatev(
    omega: float, axial_speed: float, rotor_radius: float, gap: float, fluid: Fluid | None = None
) -> tuple[float, Info]:
    """Smooth gap with air blown through it, film of one wall, h (W/m2/K).

    Nu = 0.022 (1 + (D omega r / (pi r u))^2)^0.8714 Re^0.8 Pr^0.5 on D = 2 gap and the axial speed u, not below the gap
    without through-flow (Taylor); below Re 3000, where the formula grows again, in a straight line to that gap.
    omega (rad/s), axial_speed (m/s). Range: Re from 3e3 to 3e4.
    Source: Kosterin and Finat'ev 1963, as collected by Howey, Childs, Holmes 2012 (read in citations).
    """
    fluid = fluid or air(80.0)
    D, u = 2 * gap, abs(axial_speed)
    Re, least = u * D / fluid.nu, AXIAL_RE * fluid.nu / D
    still = taylor_film(omega, rotor_radius, gap, fluid)[0]
    swirl = (1 + (D * abs(omega) / (math.pi * max(u, least))) ** 2) ** 0.8714
    blown = max(still, 0.022 * swirl * max(Re, AXIAL_RE) ** 0.8 * fluid.Pr**0.5 * fluid.k / D)
    h = still + (blown - still) * min(u / least, 1.0)
    numbers = {"Nu": h * D / fluid.k, "Re": Re}
    return h, checked("kosterin_finatev", "Kosterin & Finat'ev 1963", numbers, {"Re": (AXIAL_RE, 3e4)})


def gazley_slotting(depth: float, gap: float, Ta: float) -> tuple[float, Info]:
    """Factor on a gap's film from slots in one wall: 1 up to Ta 400, 1.1 from 4000 on for slots deeper than the gap.

    Gazley found slots to matter by less than a tenth except in the most turbulent flow, where they add some.
    Range: Ta < 1e4. Source: Gazley 1958, Trans. ASME 80, 79 (stated trend; the line between is ours).
    """
    strong = min(max(math.log10(max(Ta, 1e-9) / 400.0), 0.0), 1.0)
    factor = 1.0 + 0.1 * strong * min(depth / gap, 1.0)
    return factor, checked("gazley_slotting", "Gazley 1958", {"Ta": Ta, "depth/gap": depth / gap}, {"Ta": (0, 1e4)})
