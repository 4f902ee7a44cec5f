"""Film coefficients (W/m2/K), written here on purpose with other correlations than the library's.

T in degC, dT in K, v in m/s, lengths in m. All work element by element.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
PRANDTL = 0.71
SIGMA = 5.670374419e-8


def air_k(T: ArrayLike) -> Array:
    """Conductivity of air (W/m/K), straight line through Incropera's table A.4, 0 to 150 degC within 1 %."""
    return 0.0243 + 7.1e-5 * np.asarray(T)


def air_nu(T: ArrayLike) -> Array:
    """Kinematic viscosity of air at 1 bar (m2/s), power law in the absolute temperature."""
    return 1.338e-5 * ((np.asarray(T) + 273.15) / 273.15) ** 1.76


def rayleigh(dT: ArrayLike, T: ArrayLike, length: float) -> Array:
    """Ra = g beta dT L^3 Pr / nu^2 at film temperature T."""
    beta = 1 / (np.asarray(T) + 273.15)
    return 9.81 * beta * np.abs(dT) * length**3 * PRANDTL / air_nu(T) ** 2


def natural_plate(dT: ArrayLike, T: ArrayLike, height: float) -> Array:
    """Upright plate, all Ra < 1e12: Churchill & Chu 1975."""
    wall = (1 + (0.492 / PRANDTL) ** (9 / 16)) ** (8 / 27)
    nu = (0.825 + 0.387 * rayleigh(dT, T, height) ** (1 / 6) / wall) ** 2
    return nu * air_k(T) / height


def natural_third(dT: ArrayLike, T: ArrayLike, coefficient: float) -> Array:
    """Nu = coefficient Ra^(1/3), in which the length cancels; 0.13 upright, 0.10 mixed sides (McAdams 1954)."""
    return coefficient * rayleigh(dT, T, 1.0) ** (1 / 3) * air_k(T)


def radiation(T: ArrayLike, ambient: float, emissivity: float) -> Array:
    """eps sigma (T^4 - Ta^4) / (T - Ta)."""
    a, b = np.asarray(T) + 273.15, ambient + 273.15
    return emissivity * SIGMA * (a**2 + b**2) * (a + b)


def blunt_face(v: float, T: ArrayLike, diameter: float) -> Array:
    """Flow against or past a blunt disc: Nu = 0.25 Re^0.63, the form of Hilpert's and Zukauskas' bluff bodies."""
    return 0.25 * (v * diameter / air_nu(T)) ** 0.63 * air_k(T) / diameter


def mixed(natural: ArrayLike, forced: ArrayLike) -> Array:
    """Natural and forced convection across each other, exponent 3 (Churchill 1977)."""
    return (np.asarray(natural) ** 3 + np.asarray(forced) ** 3) ** (1 / 3)


def end_space(v: float) -> float:
    """Surfaces in a stirred end space: Hamdi's set, 10 (1 + 0.3 v) (compared in Staton, Boglietti, Cavagnino 2005)."""
    return 10.0 * (1 + 0.3 * v)


def duct(v: float, T: float, diameter: float, length: float) -> float:
    """Short duct, laminar to turbulent: Hausen 1959, blended (power 4) with 3.66 below Re = 2300."""
    re = v * diameter / float(air_nu(T))
    turbulent = 0.037 * max(re**0.75 - 180, 0.0) * PRANDTL**0.42 * (1 + (diameter / length) ** (2 / 3))
    return (3.66**4 + turbulent**4) ** 0.25 * float(air_k(T)) / diameter


def annulus(speed: float, T: float, radius: float, gap: float) -> float:
    """Either surface of the air gap to the air in it: Becker & Kaye 1962, whole-gap Nu on 2 gap; speed in rad/s.

    Of the two films in series each is twice the whole: h = Nu k / gap. The branches are joined by taking the largest.
    """
    taylor2 = speed**2 * radius * gap**3 / float(air_nu(T)) ** 2
    nu = max(2.0, min(0.128 * taylor2**0.367, 0.409 * taylor2**0.241))
    return nu * float(air_k(T)) / gap


def turning_shaft(speed: float, T: ArrayLike, diameter: float) -> Array:
    """Shaft turning in still air: Nu = 0.133 Re^(2/3) Pr^(1/3) (Kreith 1968), 5 W/m2/K at rest; speed in rad/s."""
    re = speed * diameter**2 / 2 / air_nu(T)
    return np.maximum(5.0, 0.133 * re ** (2 / 3) * PRANDTL ** (1 / 3) * air_k(T) / diameter)
