"""Temperatures without thermocouples: the winding's mean from its resistance, the magnets' from the back-EMF.

eq. 1   dT_w = (R / R0 - 1) / beta         beta of copper 0.392 to 0.393 %/K
eq. 2   dT_m = (B_r / B_r0 - 1) / alpha    alpha of NdFeB -0.10 to -0.11 %/K

Formulas take numbers and arrays alike; the classes hold what belongs to a machine.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.errors import InputError
from measured.electrical.meters import Meter
from measured.electrical.propagation import PropagatedUncertainty, Reading, propagate

# 1/K: the middle of the published 0.392 to 0.393 %/K, and half its width.
COPPER = Reading("beta", 0.3925e-2, 0.0005e-2)
NDFEB = Reading("alpha", -0.105e-2, 0.005e-2)  # 1/K: the middle of -0.10 to -0.11 %/K, and half its width


def winding_rise(R: Any, R0: Any, beta: Any, cold_C: Any = 20.0, reference_C: float | None = None) -> Any:
    """Rise (K) of a winding over its cold temperature (eq. 1).

    reference_C : temperature at which beta holds; None takes beta as it stands at the cold temperature, as eq. 1 does
    """
    shift = 0.0 if reference_C is None else cold_C - reference_C
    return (R / R0 - 1.0) * (1.0 / beta + shift)


def magnet_rise(E: Any, E0: Any, alpha: Any, curve: Saturation | None = None) -> Any:
    """Rise (K) of magnets from back-EMF at one and the same speed (eq. 2); without a curve B_r follows the EMF."""
    ratio = E / E0 if curve is None else curve(E) / curve(E0)
    return (ratio - 1.0) / alpha


@dataclass(frozen=True)
class Saturation:
    """B_r as a function of the back-EMF, e.g. from field solutions: monotone cubic through the points.

    emf (n,) V at the speed of the readings, rising;  remanence (n,) T, rising
    """

    emf: tuple[float, ...]
    remanence: tuple[float, ...]

    def __post_init__(self) -> None:
        rising = np.all(np.diff(self.emf) > 0) and np.all(np.diff(self.remanence) > 0)
        if len(self.emf) != len(self.remanence) or len(self.emf) < 2 or not rising:
            raise InputError("no curve B_r(EMF)", "saturation", "two rising lists of one length, two points or more")

    def __call__(self, emf: Any) -> Any:
        from scipy.interpolate import PchipInterpolator

        low, high = self.emf[0], self.emf[-1]
        if np.min(emf) < low - 1e-9 or np.max(emf) > high + 1e-9:
            worst = float(np.min(emf) if np.min(emf) < low else np.max(emf))
            raise InputError(f"{worst:.4g} V lies outside the saturation curve", "saturation", f"{low:g} to {high:g} V")
        remanence = PchipInterpolator(self.emf, self.remanence)(emf)
        return float(remanence) if np.ndim(emf) == 0 else remanence


@dataclass(frozen=True)
class Winding:
    """A winding measured cold.  cold_ohm at cold_C;  beta with its range (1/K), at reference_C (None: at cold_C)."""

    cold_ohm: float
    cold_C: float
    meter: Meter
    beta: Reading = COPPER
    reference_C: float | None = None

    def temperature(self, ohm: Any) -> Any:
        """Mean temperature (degC) of the winding."""
        rise = winding_rise(ohm, self.cold_ohm, self.beta.value, self.cold_C, self.reference_C)
        return self.cold_C + rise

    def rise(self, ohm: float) -> PropagatedUncertainty:
        """Rise over the cold temperature (K), with its uncertainty."""
        cold, warm = self.meter.reading("cold resistance", self.cold_ohm), self.meter.reading("resistance", ohm)

        def result(R0: Any, R: Any, beta: Any) -> Any:
            return winding_rise(R, R0, beta, self.cold_C, self.reference_C)

        return propagate(result, (cold, warm, self.beta))

    def reading_sd(self, ohm: float) -> float:
        """Scatter (K) of single readings against each other: the resolution of the range, evenly spread."""
        step = self.meter.range_for(ohm).resolution
        return float(step / np.sqrt(12.0) * abs(winding_rise(2.0, 1.0, self.beta.value)) / self.cold_ohm)


@dataclass(frozen=True)
class Magnets:
    """Magnets of a machine whose back-EMF was measured cold, at cold_rpm."""

    cold_V: float
    cold_C: float
    cold_rpm: float
    meter: Meter
    alpha: Reading = NDFEB
    curve: Saturation | None = None

    def at_cold_speed(self, volt: Any, rpm: Any) -> Any:
        """The voltage as it would be at the speed of the cold reading: back-EMF is proportional to speed."""
        return volt * self.cold_rpm / rpm

    def temperature(self, volt: Any, rpm: Any) -> Any:
        """Mean temperature (degC) of the magnets."""
        return self.cold_C + magnet_rise(self.at_cold_speed(volt, rpm), self.cold_V, self.alpha.value, self.curve)

    def rise(self, volt: float, rpm: float) -> PropagatedUncertainty:
        """Rise over the cold temperature (K), with its uncertainty."""
        warm = self.meter.reading("back-EMF", volt)
        scaled = Reading(warm.name, self.at_cold_speed(volt, rpm), self.at_cold_speed(warm.limit, rpm))
        cold = self.meter.reading("cold back-EMF", self.cold_V)

        def result(E0: Any, E: Any, alpha: Any) -> Any:
            return magnet_rise(E, E0, alpha, self.curve)

        return propagate(result, (cold, scaled, self.alpha))
