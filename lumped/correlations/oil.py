"""Oil on faces: free jets, and the film that runs off."""

import math

import numpy as np

from geom.arrays import Array
from lumped.correlations.info import Info, checked
from lumped.transfer.properties import Fluid

G = 9.80665  # m/s2
JET, FILM = "Liu, Lienhard, Lombara 1991", "Leveque 1928 on the film of Nusselt 1916"
JET_LIMITS = {"Re": (88.0, 4e3), "Pr": (4.86, 1e5)}  # a stagnation zone and an even nozzle; oil warm at its wall alone
FILM_LIMITS = {"film Re": (0.0, 400.0), "entry": (2.9, 1e12)}  # laminar; beyond, oil is warm through
RINGS = np.geomspace(1e-3, 1.0, 81)  # of a wetted disc: its mean is right to 0.1 %


def _local(r: Array, speed: float, diameter: float, fluid: Fluid) -> Array:
    """Film (W/m2/K) at distances (m) from the middle of a free jet."""
    Re, x = abs(speed) * diameter / fluid.nu, r / diameter
    below, edge = 0.745 * Re**0.5, 0.1773 * Re ** (1 / 3)
    thickness = 0.1713 / x**2 + 5.147 * x / max(Re, 1e-300)
    warmed = np.maximum(0.5 * x**2 - 5.051e-5 * Re ** (2 / 3), 1e-300)
    outer = 0.407 * Re ** (1 / 3) * x ** (-2 / 3) / (thickness ** (2 / 3) * warmed ** (1 / 3))
    Nu = np.minimum(below, np.where(x < edge, 0.632 * (Re / x) ** 0.5, outer)) * fluid.Pr ** (1 / 3)
    return np.asarray(Nu * fluid.k / diameter)


def _mean(h: Array) -> float:
    """Of a disc, of films at RINGS of its radius; inside the first they are alike."""
    area = RINGS**2
    return float(h[0] * area[0] + 0.5 * (h[1:] + h[:-1]) @ np.diff(area))


def free_jet(speed: float, diameter: float, radius: float, fluid: Fluid) -> tuple[float, Info]:
    """Mean film of a disc that a free round jet of liquid hits in the middle, onto the jet's temperature, h (W/m2/K).

    Nu / (Re^1/2 Pr^1/3) = the smaller of 0.745 and 0.632 (d/r)^1/2, up to r = 0.1773 d Re^1/3, where the boundary
    layer is the film; beyond, 0.407 Re^1/3 Pr^1/3 (d/r)^2/3 / [t^2/3 (r^2 / 2 d^2 - 5.051e-5 Re^2/3)^1/3], t = 0.1713
    (d/r)^2 + 5.147 r / (d Re). Of even heat flux; no hydraulic jump, no splashing. Under the jet oil takes up 7 % more.
    speed, diameter d: of the jet (m/s, m); radius: of the disc (m). Range: Re = speed d / nu from 88 to 4000, Pr from
    4.86. Source: Liu, Lienhard and Lombara 1991, J. Heat Transfer 113, 571.
    """
    h = _mean(_local(RINGS * radius, speed, diameter, fluid)) if speed else 0.0
    numbers = {"Nu": h * diameter / fluid.k, "Re": abs(speed) * diameter / fluid.nu, "Pr": fluid.Pr}
    return h, checked("free_jet", JET, numbers, JET_LIMITS)


def falling_film(flow: float, length: float, fluid: Fluid) -> tuple[float, Info]:
    """Mean film of liquid that runs down a wall, onto the temperature it comes with, h (W/m2/K).

    h l / k = 0.8076 (Pr s / L)^1/3, s = (3 Re)^1/3 l its thickness, Re = flow / nu, l = (nu^2 / g)^1/3: Leveque's
    entry with the shear of a laminar film on an upright wall.
    flow: per width (m2/s); length: L along the run (m). Range: Re < 400, without turbulence; entry = Re^4/3 Pr l / L
    from 2.9, where the liquid is not yet warm through; there the film is 18 % low, at twice that 10 %.
    Source: Leveque 1928, Ann. Mines 13; Nusselt 1916, Z. VDI 60, 541.
    """
    scale, Re = (fluid.nu**2 / G) ** (1 / 3), abs(flow) / fluid.nu
    Nu = 0.8076 * (fluid.Pr * (3.0 * Re) ** (1 / 3) * scale / length) ** (1 / 3)
    numbers = {"Nu": Nu, "film Re": Re, "entry": Re ** (4 / 3) * fluid.Pr * scale / length}
    return Nu * fluid.k / scale, checked("falling_film", FILM, numbers, FILM_LIMITS)


def sprayed_face(
    flow: float, nozzles: int, diameter: float, area: float, run: float, fluid: Fluid, drip: bool = False
) -> tuple[float, Info]:
    """Mean film of a face under equal nozzles, from which the oil runs off, h (W/m2/K): an end winding.

    Each nozzle has its share of the face, a disc: around its middle holds `free_jet`, farther off `falling_film` of
    the whole flow over the width area / run, whichever is larger.
    flow: of all nozzles (m3/s); diameter: of a nozzle (m); area (m2); run: way of the oil along the face (m); drip:
    whether it falls without a jet. Range: of both.
    Source: Liu, Lienhard and Lombara 1991; Leveque 1928. That the larger holds is ours.
    """
    speed = abs(flow) / (nozzles * 0.25 * math.pi * diameter**2)
    off, film = falling_film(flow * run / area, run, fluid)
    if drip:
        return off, film
    radius = math.sqrt(area / (nozzles * math.pi))
    h = _mean(np.maximum(_local(RINGS * radius, speed, diameter, fluid), off)) if flow else 0.0
    numbers = {**film.numbers, "Nu": h * diameter / fluid.k, "Re": speed * diameter / fluid.nu, "Pr": fluid.Pr}
    return h, checked("sprayed_face", f"{JET}; {FILM}", numbers, {**JET_LIMITS, **FILM_LIMITS})
