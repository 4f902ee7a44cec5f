"""Coolants by name: water, glycol mixtures with a stated share, oils, air."""

from collections.abc import Callable
from functools import partial

from geom.errors import InputError
from lumped.transfer import properties
from lumped.transfer.oils import ATF, DataSheet

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
