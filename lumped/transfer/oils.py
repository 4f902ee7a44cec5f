"""Oils by the three numbers of their data sheets: viscosity at 40 and at 100 degC, density at 15 degC."""

import math
from dataclasses import dataclass
from functools import lru_cache

from geom.constants import ZERO_C
from geom.errors import InputError
from lumped.transfer.properties import Fluid, range_words

COLDEST, HOTTEST = -20.0, 160.0  # degC: colder, wax thickens mineral oils beyond the line of D341
LUBRICANT = 0.6278  # kg/m3/K, thermal expansion at 15 degC times density: API MPMS 11.1, table 54D
WATER_15C = 999.1  # kg/m3: density over it is the specific gravity of Cragoe


@dataclass(frozen=True)
class DataSheet:
    """Kinematic viscosities (mm2/s) at 40 and 100 degC, density (kg/m3) at 15 degC."""

    at_40C: float
    at_100C: float
    density: float

    def __post_init__(self) -> None:
        if not self.at_40C > self.at_100C:
            what = f"{self.at_40C:g} mm2/s at 40 degC and {self.at_100C:g} at 100 degC"
            raise InputError(what, "oil", "a viscosity that falls with temperature")

    def __call__(self, T: float) -> Fluid:
        return _oil(self, T)


# MB 236.14, called ATF 134: viscosities as its users give them, density as such fluids have it, to 1 %.
ATF = DataSheet(29.0, 6.5, 845.0)


@lru_cache(4096)
def _oil(sheet: DataSheet, T: float) -> Fluid:
    """At T (degC): viscosity by ASTM D341 (Walther), density by API MPMS 11.1 (54D), the rest by Cragoe 1929.

    Cragoe, NBS Miscellaneous Publication 97: cp = (1685 + 3.4 T) / s^0.5, k = 0.1172 (1 - 0.00054 T) / s, s the
    specific gravity. T -20 to 160 degC.
    """
    if not COLDEST <= T <= HOTTEST:
        raise InputError(f"T = {T:g} degC", "oil", range_words(COLDEST, HOTTEST))
    s, expansion = sheet.density / WATER_15C, LUBRICANT / sheet.density
    shrunk = expansion * (T - 15.0)
    rho = sheet.density * math.exp(-shrunk * (1.0 + 0.8 * shrunk))
    cp, k = (1685.0 + 3.4 * T) / math.sqrt(s), 0.1172 * (1.0 - 0.00054 * T) / s
    # log log (nu + 0.7), nu in mm2/s, falls in a straight line over the logarithm of the absolute temperature.
    one, two = (math.log10(math.log10(nu + 0.7)) for nu in (sheet.at_40C, sheet.at_100C))
    warm, hot = math.log10(40.0 + ZERO_C), math.log10(100.0 + ZERO_C)
    along = (math.log10(T + ZERO_C) - warm) / (hot - warm)
    nu = float(10.0**10.0 ** (one + along * (two - one)) - 0.7)
    return Fluid(rho, cp, k, rho * 1e-6 * nu, expansion * (1.0 + 1.6 * shrunk))
