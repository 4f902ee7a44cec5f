"""Coolants by name: water, glycol mixtures with a stated share, air, oils by the three numbers of their data sheets."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial

from geom.constants import ZERO_C
from geom.errors import InputError
from lumped.transfer import properties
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


Coolant = Callable[[float], properties.Fluid]


def glycol(kind: str, mass_percent: float | None = None, volume_percent: float | None = None) -> Coolant:
    """Water with "ethylene" or "propylene" glycol; its share either by mass or by volume of the parts before mixing.

    Motor data sheets often mean volume and property tables mass: 50 % by volume is 53 % by mass.
    """
    if (mass_percent is None) == (volume_percent is None):
        raise InputError("share of glycol not stated once", f"{kind} glycol", "mass_percent or volume_percent")
    by_volume = (volume_percent or 0.0) / 100
    share = properties.mass_fraction_of(by_volume, kind) if mass_percent is None else mass_percent / 100
    if not 0.0 <= share <= 0.6:
        raise InputError(f"{100 * share:.3g} % by mass", f"{kind} glycol", "0 to 60 % by mass")
    mixture = {"ethylene": properties.ethylene_glycol, "propylene": properties.propylene_glycol}[kind]
    return partial(mixture, mass_fraction=share)


PLAIN: dict[str, Coolant] = {"water": properties.water, "oil": properties.oil, "ATF": ATF, "air": properties.air}
MIXED = {"ethylene glycol": "ethylene", "propylene glycol": "propylene"}
NAMES = (*PLAIN, *MIXED)


def coolant(
    name: str,
    mass_percent: float | None = None,
    volume_percent: float | None = None,
    altitude_m: float = 0.0,
    pressure_bar: float = properties.ATMOSPHERE_BAR,
    sheet: DataSheet | None = None,
) -> Coolant:
    """T (degC) -> Fluid, by name; a share for glycols only, an altitude for air, a data sheet for oil only.

    pressure_bar : absolute; where water boils. Mixtures are known up to 100 degC, below where they boil.
    """
    if sheet is not None:
        if name != "oil":
            raise InputError("viscosities were given", name, 'name = "oil" with the numbers of its data sheet')
        return sheet
    if name in MIXED:
        return glycol(MIXED[name], mass_percent, volume_percent)
    if mass_percent is not None or volume_percent is not None:
        raise InputError("a share was given", name, f"a share only for {' and '.join(MIXED)}")
    if name == "water":
        return partial(properties.water, pressure_bar=pressure_bar)
    return partial(properties.air, altitude_m=altitude_m) if name == "air" else PLAIN[name]
