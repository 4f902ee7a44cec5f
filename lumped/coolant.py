"""Coolants by name: water, glycol mixtures with a stated share, oil, air."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from geom.errors import InputError
from lumped.properties import ZERO_C, Fluid, air, ethylene_glycol, mass_fraction_of, propylene_glycol, water

Coolant = Callable[[float], Fluid]

# Unused engine oil: T (K), rho (kg/m3), cp (kJ/kg/K), mu (Pa s), k (W/m/K). Incropera et al. 2007, table A.5.
OIL = np.array([
    (273, 899.1, 1.796, 3.85, 0.147), (280, 895.3, 1.827, 2.17, 0.144), (290, 890.0, 1.868, 0.999, 0.145),
    (300, 884.1, 1.909, 0.486, 0.145), (310, 877.9, 1.951, 0.253, 0.145), (320, 871.8, 1.993, 0.141, 0.143),
    (330, 865.8, 2.035, 0.0836, 0.141), (340, 859.9, 2.076, 0.0531, 0.139), (350, 853.9, 2.118, 0.0356, 0.138),
    (360, 847.8, 2.161, 0.0252, 0.138), (370, 841.8, 2.206, 0.0186, 0.137), (380, 836.0, 2.250, 0.0141, 0.136),
    (390, 830.6, 2.294, 0.0110, 0.135), (400, 825.1, 2.337, 0.00874, 0.134), (410, 818.9, 2.381, 0.00698, 0.133),
    (420, 812.1, 2.427, 0.00564, 0.133), (430, 806.5, 2.471, 0.00470, 0.132),
])  # fmt: skip
OIL_BETA = 7.0e-4  # 1/K, the same table


def oil(T: float) -> Fluid:
    """Unused engine oil at T (degC), -0.15 to 156.85; viscosity is interpolated in its logarithm."""
    kelvin = T + ZERO_C
    low, high = OIL[0, 0], OIL[-1, 0]
    if not low <= kelvin <= high:
        raise InputError(f"T = {T:g} degC", "oil", f"{low - ZERO_C:g} to {high - ZERO_C:g} degC")
    rho, cp, log_mu, k = (
        float(np.interp(kelvin, OIL[:, 0], column)) for column in (OIL[:, 1], OIL[:, 2], np.log(OIL[:, 3]), OIL[:, 4])
    )
    return Fluid(rho, 1000.0 * cp, k, float(np.exp(log_mu)), OIL_BETA)


def glycol(kind: str, mass_percent: float | None = None, volume_percent: float | None = None) -> Coolant:
    """Water with "ethylene" or "propylene" glycol; its share either by mass or by volume of the parts before mixing.

    Motor data sheets often mean volume and property tables mass: 50 % by volume is 53 % by mass.
    """
    if (mass_percent is None) == (volume_percent is None):
        raise InputError("share of glycol not stated once", f"{kind} glycol", "mass_percent or volume_percent")
    share = mass_percent / 100 if mass_percent is not None else mass_fraction_of((volume_percent or 0.0) / 100, kind)
    if not 0.0 <= share <= 0.6:
        raise InputError(f"{100 * share:.3g} % by mass", f"{kind} glycol", "0 to 60 % by mass")
    mixture = {"ethylene": ethylene_glycol, "propylene": propylene_glycol}[kind]
    return partial(mixture, mass_fraction=share)


PLAIN: dict[str, Coolant] = {"water": water, "oil": oil, "air": air}
MIXED = {"ethylene glycol": "ethylene", "propylene glycol": "propylene"}
NAMES = (*PLAIN, *MIXED)


def coolant(
    name: str, mass_percent: float | None = None, volume_percent: float | None = None, altitude_m: float = 0.0
) -> Coolant:
    """T (degC) -> Fluid, by name; a share for glycols only, an altitude for air only."""
    if name in MIXED:
        return glycol(MIXED[name], mass_percent, volume_percent)
    if mass_percent is not None or volume_percent is not None:
        raise InputError("a share was given", name, f"a share only for {' and '.join(MIXED)}")
    return partial(air, altitude_m=altitude_m) if name == "air" else PLAIN[name]
