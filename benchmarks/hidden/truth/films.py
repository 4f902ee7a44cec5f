"""Heat transfer coefficients (W/m2/K) of films, and losses (W). T in degC, lengths in m, speeds in m/s or rpm, A."""

from collections.abc import Callable

import numpy as np

from hidden.truth.body import Array, Skeleton
from hidden.truth.draw import Draw
from hidden.truth.machine import Film, FilmLaw, Inputs, LossLaw

G0, SIGMA, ZERO = 9.81, 5.670374e-8, 273.15


def air(T: Array) -> tuple[Array, Array, Array, float]:
    """Conductivity (W/m/K), kinematic viscosity (m2/s), expansion (1/K) and Prandtl number of dry air, 0 to 200 degC.

    Sutherland's law and the ideal gas at 1 atm: k and mu within 1 % of the tables of Incropera.
    """
    K = T + ZERO
    mu = 1.458e-6 * K**1.5 / (K + 110.4)
    return 2.646e-3 * K**1.5 / (K + 245.4 * 10.0 ** (-12.0 / K)), mu * K / 352.98, 1.0 / K, 0.71


def cylinder_still(T: Array, Ta: Array, D: float) -> Array:
    """Horizontal cylinder in still air."""
    return _churchill_chu(T, Ta, D, 0.60, 0.559)


def plate_still(T: Array, Ta: Array, H: float) -> Array:
    """Vertical plate in still air."""
    return _churchill_chu(T, Ta, H, 0.825, 0.492)


def _churchill_chu(T: Array, Ta: Array, L: float, least: float, by_Pr: float) -> Array:
    """Churchill and Chu 1975."""
    k, nu, beta, Pr = air(0.5 * (T + Ta))
    Ra = G0 * beta * np.abs(T - Ta) * L**3 / nu**2 * Pr
    Nu = (least + 0.387 * Ra ** (1 / 6) / (1.0 + (by_Pr / Pr) ** (9 / 16)) ** (8 / 27)) ** 2
    return Nu * k / L


def wind(T: Array, Ta: Array, v: Array, L: float) -> Array:
    """Blunt body in a wind: Nu = 0.24 Re^0.63 Pr^0.33."""
    k, nu, _, Pr = air(0.5 * (T + Ta))
    return 0.24 * (np.abs(v) * L / nu) ** 0.63 * Pr**0.33 * k / L


def mixed(forced: Array, still: Array) -> Array:
    """Churchill 1977: cubes add."""
    return np.asarray((forced**3 + still**3) ** (1 / 3))


def radiation(T: Array, Ta: Array, emissivity: float) -> Array:
    a, b = T + ZERO, Ta + ZERO
    return emissivity * SIGMA * (a**2 + b**2) * (a + b)


def free_film(still: Callable[[Array, Array, float], Array], size: float, share: float, emissivity: float) -> FilmLaw:
    """Still air on a face of a size (m), a share of what a correlation says, and radiation."""
    return lambda T, Ta, u: share * still(T, Ta, size) + radiation(T, Ta, emissivity)


def gap(T: Array, rpm: float, r: float, g: float) -> Array:
    """Rotor to stator, one film over the whole gap: Nu of Taylor-Couette flow, smoothly joined to conduction."""
    k, nu, _, Pr = air(T)
    Ta = np.abs(rpm) * np.pi / 30.0 * np.sqrt(r) * g**1.5 / nu
    Nu = (2.0**8 + (0.212 * Ta**0.63 * Pr**0.27) ** 8) ** (1 / 8)
    return np.asarray(Nu * k / (2.0 * g))


def across_gap(s: Skeleton, rotor: str, stator: str, area: float, r: float, g: float) -> Film:
    """The gap's film between the cells of two bodies that face each other; its area (m2) in all."""
    inner, outer = s.cells(rotor), s.cells(stator)
    n = min(inner.size, outer.size)

    def h(T: Array, Ta: Array, u: Inputs) -> Array:
        return gap(0.5 * (T + Ta), u["speed_rpm"], r, g)

    return Film("gap", inner[:n], outer[:n], np.full(n, area / n), h)


def stirred(r: float, k1: float, k2: float) -> FilmLaw:
    """End space, Schubert 1968: k1 (1 + k2 v^0.9), v the tip speed of a rotor of radius r."""
    return lambda T, Ta, u: k1 * (1.0 + k2 * (abs(u["speed_rpm"]) * np.pi / 30.0 * r) ** 0.9)


def water(T: Array) -> tuple[Array, Array, Array]:
    """Dynamic viscosity (Pa s), conductivity (W/m/K), Prandtl number of 50/50 water and glycol, 10 to 90 degC."""
    mu = 3.7e-3 * np.exp(-0.0288 * (T - 20.0) + 1.15e-4 * (T - 20.0) ** 2)
    k = 0.389 + 6.2e-4 * (T - 20.0)
    return mu, k, mu * (3312.0 + 4.8 * (T - 20.0)) / k


def channel(T: Array, litres_min: float, area: float, D: float) -> Array:
    """Coolant channel of cross section `area` (m2): laminar 4.36, Gnielinski 1976 when turbulent, joined smoothly."""
    mu, k, Pr = water(T)
    Re = np.maximum(1050.0 * litres_min / 60000.0 / area * D / mu, 1.0)
    f = (0.79 * np.log(np.maximum(Re, 3000.0)) - 1.64) ** -2
    turbulent = f / 8 * np.maximum(Re - 1000.0, 0.0) * Pr / (1.0 + 12.7 * np.sqrt(f / 8) * (Pr ** (2 / 3) - 1.0))
    share = 1.0 / (1.0 + np.exp(-(Re - 3000.0) / 300.0))
    return np.asarray((share * turbulent + (1.0 - share) * 4.36 * (1.0 + 0.0003 * Re)) * k / D)


ALPHA = 0.00393


def copper(R20: float, current: float, T: Array) -> Array:
    """Per-cell loss of a winding of 3 R20 in all."""
    return 3.0 * R20 * current**2 * (1.0 + ALPHA * (T - 20.0))


def joule(R20: float, input_A: str = "current_A") -> LossLaw:
    """Loss of a winding under one of the inputs."""
    return lambda T, u: copper(R20, u[input_A], T)


def bertotti(T: Array, f: float, hysteresis: float, eddy: float, excess: float) -> Array:
    """Bertotti 1988 at constant flux: hysteresis f + eddy f^2 + excess f^1.5, f relative to the rated; eddies fade as
    the steel warms (0.1 %/K)."""
    return hysteresis * f + eddy * f**2 / (1.0 + 0.001 * (T - 40.0)) + excess * f**1.5


def steel(d: Draw, rated_rpm: float, hysteresis: float, eddy: float, excess: float) -> LossLaw:
    """A core at the speed over the rated one; its three parts (W) are drawn."""
    kh, ke, kx = hysteresis * d.factor("iron", 0.15), eddy * d.factor("eddy", 0.2), excess * d.factor("excess", 0.3)
    return lambda T, u: bertotti(T, abs(u["speed_rpm"]) / rated_rpm, kh, ke, kx)


def magnet_eddy(P: float, rated_rpm: float) -> LossLaw:
    """Eddies in magnets: P f^1.9 at 40 degC, less as they warm."""
    return lambda T, u: P * (abs(u["speed_rpm"]) / rated_rpm) ** 1.9 / (1.0 + 0.0005 * (T - 40.0))


def bearing(P: float, rated_rpm: float, thinning: float = 0.006, power: float = 1.1, at: float = 40.0) -> LossLaw:
    """Grease-lubricated: P f^power `at` degC, f relative to the rated speed; less as the grease thins (per K)."""
    return lambda T, u: P * (abs(u["speed_rpm"]) / rated_rpm) ** power * np.exp(-thinning * (T - at))
