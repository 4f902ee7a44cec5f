"""Properties of the fluids that cool motors, from kept libraries."""

from dataclasses import dataclass
from functools import cache, lru_cache
from math import ceil, floor

import numpy as np

from geom.constants import ZERO_C
from geom.errors import InputError, MissingDependency

GAS_CONSTANT_AIR = 287.0528  # J/kg/K
CP_AIR = 1005.7  # J/kg/K, dry air, within 0.3 % from -20 to 120 degC (Lemmon et al. 2000)
# Where films that follow a coolant are tabulated: no coolant goes beyond.
TABULATED_C = tuple(float(T) for T in range(-40, 161, 5))


@dataclass(frozen=True)
class Fluid:
    """rho (kg/m3), cp (J/kg/K), k (W/m/K), mu (Pa s), beta: thermal expansion (1/K), at one temperature."""

    rho: float
    cp: float
    k: float
    mu: float
    beta: float

    @property
    def nu(self) -> float:
        """Kinematic viscosity (m2/s)."""
        return self.mu / self.rho

    @property
    def Pr(self) -> float:
        """Prandtl number."""
        return self.mu * self.cp / self.k


def air(T: float, altitude_m: float = 0.0) -> Fluid:
    """Dry air at T (degC) and the standard pressure of an altitude (fluids: US Standard Atmosphere 1976)."""
    from fluids import ATMOSPHERE_1976

    absolute = T + ZERO_C
    rho = _pressure(altitude_m) / (GAS_CONSTANT_AIR * absolute)
    k, mu = ATMOSPHERE_1976.thermal_conductivity(absolute), ATMOSPHERE_1976.viscosity(absolute)
    return Fluid(rho, CP_AIR, k, mu, 1.0 / absolute)


@cache
def _pressure(altitude_m: float) -> float:
    from fluids import ATMOSPHERE_1976

    return float(ATMOSPHERE_1976(altitude_m).P)


def range_words(low: float, high: float) -> str:
    """A range (degC) in tenths that lie in it."""
    return f"{ceil(10 * low) / 10:g} to {floor(10 * high) / 10:g} degC"


def _liquid(source, T: float) -> Fluid:
    if not source.t_min <= T <= source.t_max:
        raise InputError(f"T = {T:g} degC", source.fluid_name, range_words(source.t_min, source.t_max))
    step = 0.1 if source.t_max - 0.1 > T else -0.1
    rho = source.density(T)
    beta = -(source.density(T + step) - rho) / step / rho
    return Fluid(rho, source.specific_heat(T), source.conductivity(T), source.viscosity(T), beta)


ATMOSPHERE_BAR = 1.01325
# Water at its vapour pressure: degC, bar, kg/m3, J/kg/K, W/m/K, Pa s (IAPWS-95; viscosity 2008, conductivity 2011)
HOT_WATER = np.array(
    [
        (100.0, 1.0142, 958.35, 4215.7, 0.67721, 2.8158e-4),
        (110.0, 1.4338, 950.95, 4228.3, 0.68035, 2.5461e-4),
        (120.0, 1.9867, 943.11, 4243.5, 0.68224, 2.3203e-4),
        (130.0, 2.7028, 934.83, 4261.5, 0.68295, 2.1294e-4),
        (140.0, 3.6154, 926.13, 4282.6, 0.68253, 1.9664e-4),
        (150.0, 4.7616, 917.01, 4307.1, 0.68102, 1.8261e-4),
        (160.0, 6.1823, 907.45, 4335.4, 0.67873, 1.7043e-4),
    ]
)


@lru_cache(4096)
def water(T: float, pressure_bar: float = ATMOSPHERE_BAR) -> Fluid:
    """Liquid water at T (degC), up to where it boils at an absolute pressure, at most 160 degC.

    SecondaryCoolantProps up to 100 degC, beyond it IAPWS. That a liquid is under a higher pressure changes it by 0.1 %.
    """
    from scp.water import Water

    cool, (degC, bar, *columns) = Water(), HOT_WATER.T
    boils = float(np.interp(np.log(pressure_bar), np.log(bar), degC))
    if not cool.t_max < T <= boils:
        cool.t_max = boils
        return _liquid(cool, T)
    first, grow = _liquid(cool, cool.t_max), [float(np.interp(T, degC, column / column[0])) for column in columns]
    rho, cp, k, mu = grow
    beta = -float(np.interp(T, degC, np.gradient(np.log(HOT_WATER[:, 2]), degC)))
    return Fluid(first.rho * rho, first.cp * cp, first.k * k, first.mu * mu, beta)


@lru_cache(4096)
def ethylene_glycol(T: float, mass_fraction: float) -> Fluid:
    """Water with ethylene glycol by MASS fraction (0 to 0.6) at T (degC) (SecondaryCoolantProps: Melinder 2010)."""
    from scp.ethylene_glycol import EthyleneGlycol

    return _liquid(EthyleneGlycol(mass_fraction), T)


@lru_cache(4096)
def propylene_glycol(T: float, mass_fraction: float) -> Fluid:
    """Water with propylene glycol by MASS fraction (0 to 0.6) at T (degC) (SecondaryCoolantProps: Melinder 2010)."""
    from scp.propylene_glycol import PropyleneGlycol

    return _liquid(PropyleneGlycol(mass_fraction), T)


OIL, OIL_PRESSURE = "INCOMP::TX22", 1e6  # Pa, above its vapour pressure everywhere


@cache
def oil(T: float) -> Fluid:
    """Mineral oil, 41 mm2/s at 40 degC, as transmission fluids are (Texatherm 22 of CoolProp); T 0 to 350 degC.

    Raises MissingDependency without the package CoolProp.
    """
    try:
        from CoolProp.CoolProp import PropsSI
    except ImportError:
        raise MissingDependency("oil needs the package CoolProp: pip install 'thermoscope[oil]'") from None
    low, high = (PropsSI(end, OIL) - ZERO_C for end in ("Tmin", "Tmax"))
    if not low <= T <= high:
        raise InputError(f"T = {T:g} degC", "oil", range_words(low, high))

    def of(what: str, T: float) -> float:
        return float(PropsSI(what, "T", T + ZERO_C, "P", OIL_PRESSURE, OIL))

    step = 0.1 if high - 0.1 > T else -0.1
    beta = -(of("D", T + step) - of("D", T)) / step / of("D", T)
    return Fluid(of("D", T), of("C", T), of("L", T), of("V", T), beta)


GLYCOL_DENSITY = {"ethylene": 1113.2, "propylene": 1036.1}  # kg/m3 at 20 degC, CRC Handbook
WATER_DENSITY = 998.2  # kg/m3 at 20 degC, where glycol is mixed by volume


def mass_fraction_of(volume_fraction: float, glycol: str = "ethylene") -> float:
    """Mass fraction of a mixture declared by volume of the parts before mixing, at 20 degC."""
    heavy = volume_fraction * GLYCOL_DENSITY[glycol]
    return heavy / (heavy + (1.0 - volume_fraction) * WATER_DENSITY)
