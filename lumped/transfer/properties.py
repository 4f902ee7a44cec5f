"""Properties of the fluids that cool motors, from kept libraries."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import ceil, floor

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


def water(T: float) -> Fluid:
    """Liquid water at T (degC) (SecondaryCoolantProps)."""
    from scp.water import Water

    return _liquid(Water(), T)


def ethylene_glycol(T: float, mass_fraction: float) -> Fluid:
    """Water with ethylene glycol by MASS fraction (0 to 0.6) at T (degC) (SecondaryCoolantProps: Melinder 2010)."""
    from scp.ethylene_glycol import EthyleneGlycol

    return _liquid(EthyleneGlycol(mass_fraction), T)


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
