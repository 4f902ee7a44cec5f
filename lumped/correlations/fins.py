"""Natural and forced convection between fins."""

import math
from collections.abc import Callable

from geom.constants import GRAVITY as G
from lumped.correlations.info import Info, checked
from lumped.correlations.natural import Of
from lumped.transfer.properties import Fluid, air

INVERSE_METRE = 11.8 / 0.0254  # the paper's 11.8 per inch


def van_de_pol_tierney(
    depth: float, spacing: float, height: float, surface: float, ambient: float, of: Of = air
) -> tuple[float, Info]:
    """Vertical channels between fins (a U open to the front) in still air, h over the channel's walls (W/m2/K).

    depth: of the fins (m), spacing: between them (m), height: along gravity (m). Characteristic length
    r = 2 depth spacing / (2 depth + spacing); properties at the wall, expansion at the fluid.
    Range: Ra* = (r/height) Gr_r Pr below 1e4. Source: Van de Pol and Tierney 1973, J. Heat Transfer 95, 542; checked
    against spacing 4/8/12/20 mm, depth 20 mm, height 0.25 m, 40 K: 0.9/3.4/4.4/4.9 W/m2/K (5 %).
    """
    wall, r, a = of(surface), 2 * depth * spacing / (2 * depth + spacing), spacing / depth
    Gr = G * of(ambient).beta * abs(surface - ambient) * r**3 / wall.nu**2
    Ra = r / height * Gr * wall.Pr
    bracket = (1 + a / 2) * (
        1 + (1 - math.exp(-0.83 * a)) * (9.14 * math.sqrt(a) * math.exp(-INVERSE_METRE * spacing) - 0.61)
    )
    Z = 24 * (1 - 0.483 * math.exp(-0.17 / a)) / bracket**3
    Nu = Ra / Z * -math.expm1(-Z * (0.5 / Ra) ** 0.75) if Ra > 0 else 0.0
    info = checked("van_de_pol_tierney", "Van de Pol & Tierney 1973", {"Nu": Nu, "Ra*": Ra}, {"Ra*": (0, 1e4)})
    return Nu * wall.k / r, info


def jones_smith(spacing: float, surface: float, ambient: float, of: Of = air) -> tuple[float, Info]:
    """Horizontal fins open up or down in still air, h (W/m2/K).

    Nu_s = 6.7e-4 Ra_s (1 - exp(-(7460/Ra_s)^0.44))^1.7, length = spacing (m).
    Range: 2e2 < Ra_s < 6e5. Source: Jones and Smith 1970, J. Heat Transfer 92, 6 (some motor papers print 7640).
    """
    fluid = of(0.5 * (surface + ambient))
    Ra = G * fluid.beta * abs(surface - ambient) * spacing**3 / fluid.nu**2 * fluid.Pr
    Nu = 6.7e-4 * Ra * (-math.expm1(-((7460 / Ra) ** 0.44))) ** 1.7 if Ra > 0 else 0.0
    info = checked("jones_smith", "Jones & Smith 1970", {"Nu": Nu, "Ra": Ra}, {"Ra": (2e2, 6e5)})
    return Nu * fluid.k / spacing, info


def elenbaas(spacing: float, length: float, surface: float, ambient: float, of: Of = air) -> tuple[float, Info]:
    """Parallel vertical plates, also circular fins on a horizontal cylinder taken as plates, h (W/m2/K).

    Nu_s = (Ra_s spacing / length / 24) (1 - exp(-35 length / (spacing Ra_s)))^(3/4); spacing, length along gravity (m).
    Range: Ra_s spacing / length from 0.1 to 1e5. Source: Elenbaas 1942, Physica 9, 1 (35 for the square plate).
    """
    fluid = of(0.5 * (surface + ambient))
    Ra = G * fluid.beta * abs(surface - ambient) * spacing**3 / fluid.nu**2 * fluid.Pr * spacing / length
    Nu = Ra / 24 * (-math.expm1(-35 / Ra)) ** 0.75 if Ra > 0 else 0.0
    info = checked("elenbaas", "Elenbaas 1942", {"Nu": Nu, "Ra S/L": Ra}, {"Ra S/L": (0.1, 1e5)})
    return Nu * fluid.k / spacing, info


def heiles(
    speed: float, diameter: float, length: float, turbulence: float = 1.7, fluid: Fluid | None = None
) -> tuple[float, Info]:
    """Blown channels between the fins of a totally enclosed motor, mean h over their walls (W/m2/K).

    h = turbulence rho cp D v / (4 L) (1 - exp(-m)), m = 0.1448 L^0.946 / D^1.16 (k / (rho cp v))^0.214, SI.
    speed: mean in the channel (m/s), diameter: 4 A / P with the open side counted (m), length: of the fin (m);
    turbulence 1.6 to 1.8. Range: D from 5 to 50 mm, v up to 30 m/s (as used; the paper's own range was not read).
    Source: Heiles 1952, Elin-Zeitschrift 4, 158, after Staton and Cavagnino 2008, IEEE Trans. Ind. Electron. 55, 3509.
    """
    fluid = fluid or air(40.0)
    v, heat = abs(speed), fluid.rho * fluid.cp
    limits = {"v": (0.0, 30.0), "D": (0.005, 0.05)}
    if v == 0.0:
        return 0.0, checked("heiles", "Heiles 1952", {"v": 0.0, "D": diameter}, limits)
    m = 0.1448 * length**0.946 / diameter**1.16 * (fluid.k / (heat * v)) ** 0.214
    h = turbulence * heat * diameter * v / (4 * length) * -math.expm1(-m)
    return h, checked("heiles", "Heiles 1952", {"v": v, "D": diameter}, limits)


def mean_of_decay(share_at_end: float) -> float:
    """Mean over an open channel of the air speed's share of the cowl's, falling in a straight line from 1."""
    return 0.5 * (1.0 + share_at_end)


def straight_decay(share_at_end: float, x: float) -> float:
    """Share of the cowl's air speed where the share x of the channel is passed (0 to 1): in a straight line."""
    return 1.0 + (share_at_end - 1.0) * x


def heiles_decaying(
    speed: float,
    diameter: float,
    length: float,
    decay: Callable[[float], float],
    turbulence: float = 1.7,
    fluid: Fluid | None = None,
    pieces: int = 20,
) -> tuple[float, Info]:
    """Blown fin channel whose air leaks out along its way, mean h over the fin (W/m2/K).

    Heiles' film of the whole channel at the speed of each of `pieces` equal lengths, averaged; decay: share of the
    cowl's speed over the share of the length, e.g. straight_decay. Source: Heiles 1952 with the leakage that
    Staton and Cavagnino 2008 describe; Motor-CAD starts from 1 at the cowl to 0.2 at the far end.
    """
    at = [(k + 0.5) / pieces for k in range(pieces)]
    films = [heiles(speed * decay(x), diameter, length, turbulence, fluid) for x in at]
    return math.fsum(h for h, _ in films) / pieces, films[0][1]
