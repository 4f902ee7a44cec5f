"""The annular gap between rotor and stator."""

from __future__ import annotations

import math

from lumped.correlations.info import Info, checked
from lumped.properties import Fluid, air


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


def _geometric_factor(gap: float, mean_radius: float) -> float:
    """F_g of Becker and Kaye: 1 for a thin gap."""
    x = (gap / mean_radius) / (1.0 - gap / (2.0 * mean_radius))
    S = 0.0571 * (1.0 - 0.652 * x) + 0.00056 / (1.0 - 0.652 * x)
    return math.pi**2 / (41.19 * math.sqrt(S)) / (1.0 - gap / (2.0 * mean_radius))


def becker_kaye(omega: float, rotor_radius: float, gap: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """The whole smooth gap from rotor to stator, h (W/m2/K).

    X = Ta_m^2 / F_g^2, Ta_m = omega r_m^(1/2) gap^(3/2) / nu; Nu = 2 h gap / k = 2 (X < 1700), 0.128 X^0.367 (to 1e4),
    0.409 X^0.241 (to 1e7); the branches meet at their crossings.
    omega (rad/s), rotor_radius (m), gap (m); fluid defaults to air at 80 degC.
    Source: Becker and Kaye 1962, J. Heat Transfer 84, 97, in Howey, Childs, Holmes 2012, IEEE Trans. Ind. Electron. 59.
    """
    fluid = fluid or air(80.0)
    mean = rotor_radius + 0.5 * gap
    Ta = abs(omega) * math.sqrt(mean) * gap**1.5 / fluid.nu
    X = (Ta / _geometric_factor(gap, mean)) ** 2
    Nu = max(2.0, min(0.128 * X**0.367, 0.409 * X**0.241))
    numbers = {"Nu": Nu, "Ta": Ta, "X": X, "gap/radius": gap / mean}
    info = checked("becker_kaye", "Becker & Kaye 1962", numbers, {"X": (0, 1e7), "gap/radius": (0, 0.25)})
    return Nu * fluid.k / (2.0 * gap), info


def romanazzi_howey(omega: float, rotor_radius: float, gap: float, fluid: Fluid | None = None) -> tuple[float, Info]:
    """Gap with salient poles (switched reluctance, DC field poles), one wall, h (W/m2/K).

    Nu = 0.181 X^0.207, held at 2 where the formula falls below conduction. Only the abstract of Romanazzi and Howey
    2015 (arXiv 1502.05902) was read: that X is the squared Taylor number omega^2 r_m gap^3 / nu^2 and that Nu is per
    wall is inferred (unsquared, Nu stays below conduction at every speed), and so is the range.
    """
    fluid = fluid or air(80.0)
    Ta = abs(omega) * math.sqrt(rotor_radius + 0.5 * gap) * gap**1.5 / fluid.nu
    Nu = max(2.0, 0.181 * (Ta * Ta) ** 0.207)
    info = checked("romanazzi_howey", "Romanazzi & Howey 2015", {"Nu": Nu, "Ta": Ta}, {"Ta": (0, 1e4)})
    return Nu * fluid.k / gap, info
