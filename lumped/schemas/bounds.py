"""What a number in a file may be, for every key: readers, schemas, messages and the page of keys follow this table.

A key says its unit in its name, so most bounds are those of a unit. They are far beyond any machine: what they refuse
is a slip (a sign, a decimal point, a unit), never an unusual design.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

COLDEST, HOTTEST = -100.0, 3000.0  # degC: no test bench is colder; copper, steel and insulation are gone before
TINY = 1e-12  # stands for "above zero" where a number divides
LEAST_J_K = 1e-9  # a millionth of a thermocouple's bead; a node that stores nothing has no capacity at all


@dataclass(frozen=True)
class Bounds:
    """low, high : both allowed;  whole : no fraction"""

    low: float
    high: float
    whole: bool = False

    def hold(self, value: Any) -> bool:
        """Is it a number within the bounds? True and false are no numbers, and nan lies nowhere."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            return False
        return self.low <= value <= self.high and (not self.whole or math.floor(value) == value)

    @property
    def words(self) -> str:
        """As a message and the page of keys say it."""
        return f"a {'whole ' if self.whole else ''}number from {self.low:g} to {self.high:g}"


# Longest first where one ends like another: W_m2K before K.
UNITS = {
    "W_m2K": Bounds(0.0, 1e7),
    "W_K": Bounds(0.0, 1e7),
    "K_W": Bounds(TINY, 1e9),
    "J_kgK": Bounds(1.0, 1e5),
    "J_K": Bounds(LEAST_J_K, 1e10),
    "kg_m3": Bounds(1e-3, 3e4),
    "kg_m2": Bounds(0.0, 1e6),
    "Nms": Bounds(0.0, 1e6),
    "percent_K": Bounds(-10.0, 10.0),
    "per_K": Bounds(-1.0, 1.0),
    "1_K": Bounds(-1.0, 1.0),
    "degC": Bounds(COLDEST, HOTTEST),
    "C": Bounds(COLDEST, HOTTEST),
    "K": Bounds(0.0, 1e4),
    "ohm": Bounds(0.0, 1e9),
    "mOhm": Bounds(0.0, 1e12),
    "W": Bounds(0.0, 1e9),
    "kW": Bounds(1e-3, 1e6),
    "V": Bounds(0.0, 1e7),
    "A": Bounds(0.0, 1e7),
    "H": Bounds(TINY, 1e3),
    "Hz": Bounds(1e-9, 1e9),
    "Vs": Bounds(TINY, 1e4),
    "rpm": Bounds(0.0, 1e6),
    "m2": Bounds(0.0, 1e6),
    "m": Bounds(1e-4, 1e5),
    "mm": Bounds(1e-3, 1e6),
    "l": Bounds(1e-6, 1e6),
    "kg": Bounds(1e-9, 1e7),
    "bar": Bounds(0.0, 1e3),
    "l_min": Bounds(1e-9, 1e8),
    "L_per_min": Bounds(1e-6, 1e8),
    "m3_h": Bounds(0.0, 1e8),
    "m_s": Bounds(0.0, 1e3),
    "s": Bounds(0.0, 1e9),
    "percent": Bounds(0.0, 100.0),
    "share": Bounds(0.0, 1.0),
    "efficiency": Bounds(0.01, 1.0),
    "prior_sd": Bounds(1e-9, 10.0),
    "exponent": Bounds(-10.0, 10.0),
    "factor": Bounds(0.0, 1e6),
}

ANY = Bounds(-1e12, 1e12)  # keeps out what overflows, and no more
AIR_C = Bounds(-60.0, 200.0)  # where the tables of fluids hold
COOLANT_C = Bounds(-40.0, 200.0)  # from where glycol mixtures freeze to where oils are used

# Keys without a unit in their name, or tighter than their unit; "table.key" where a key means something else there.
KEYS = {
    "at": Bounds(TINY, 1e12),
    "speed_at": Bounds(TINY, 1e12),
    "excitation_at": Bounds(TINY, 1e12),
    "at_rpm": Bounds(1e-9, 1e6),
    "up_to_rpm": Bounds(1.0, 1e6),
    "up_to_m_s": Bounds(1e-3, 1e3),
    "m_s_per_unit": Bounds(TINY, 1e6),
    "settles_s": Bounds(1.0, 1e9),
    "sample_s": Bounds(1e-3, 86400.0),
    "step_s": Bounds(1e-3, 86400.0),
    "period_s": Bounds(1e-6, 1e7),
    "duration_s": Bounds(1e-3, 1e9),
    "on_s": Bounds(1e-3, 1e9),
    "shift_s": Bounds(-1e9, 1e9),
    "limit_s": Bounds(1e-3, 1e6),
    "lag_s": Bounds(0.0, 86400.0),
    "filter_s": Bounds(0.0, 86400.0),
    "current_lag_s": Bounds(1e-6, 1e3),
    "max_gap_s": Bounds(0.0, 1e6),
    "sigma_K": Bounds(1e-3, 100.0),
    "model_error_K": Bounds(0.0, 100.0),
    "resolution_K": Bounds(1e-3, 100.0),
    "emissivity": Bounds(0.0, 1.0),
    "view_factor": Bounds(0.0, 1.0),
    "view": Bounds(0.0, 1.0),
    "speed_at_end": Bounds(0.0, 1.0),
    "no_load": Bounds(0.0, 1.0),
    "rolling": Bounds(0.0, 1.0),
    "turbulence": Bounds(0.0, 10.0),
    "k1": Bounds(0.0, 1e4),
    "k2": Bounds(0.0, 1e4),
    "k3": Bounds(0.0, 10.0),
    "end_space_k2": Bounds(0.0, 1e4),
    "end_space_k3": Bounds(0.0, 10.0),
    "iron_in_poles": Bounds(0.0, 1.0),
    "armature_in_end_windings": Bounds(0.0, 1.0),
    "windage_in_gap": Bounds(0.0, 1.0),
    "size_m": Bounds(1e-4, 100.0),
    "altitude_m": Bounds(0.0, 9000.0),
    "axial_mm": Bounds(1.0, 1e5),
    "coil_diameter_mm": Bounds(0.0, 1e6),
    "fluid_degC": AIR_C,
    "at_degC": COOLANT_C,
    "cold.at_degC": Bounds(COLDEST, HOTTEST),
    "inlet_C": COOLANT_C,
    "property_C": COOLANT_C,
    "mass_percent": Bounds(0.0, 60.0),
    "cells": Bounds(1, 64, whole=True),
    "parallel": Bounds(1, 1e4, whole=True),
    "bends": Bounds(0, 1e4, whole=True),
    "cycles": Bounds(1, 1e5, whole=True),
    "number": Bounds(1, 1e9, whole=True),
    "lines": Bounds(0, 1e9, whole=True),
    "starts": Bounds(1, 1000, whole=True),
    "seed": Bounds(0, 2**32 - 1, whole=True),
    "doubt": Bounds(0.0, 1e6),
    "pole_pairs": Bounds(1, 500, whole=True),
    "sign": Bounds(-1, 1, whole=True),
    "supply_V": Bounds(1e-9, 1e7),
    "wheel_radius_m": Bounds(1e-3, 100.0),
    "gear": Bounds(1e-3, 1e4),
    "drag_area_m2": Bounds(0.0, 1e3),
    "Kp": Bounds(0.0, 1e9),
    "Ki": Bounds(0.0, 1e9),
    "reading": Bounds(1e-9, 1e9),
    "rpm": Bounds(1e-6, 1e6),
    "resistance_ohm": Bounds(1e-9, 1e9),
    "speed_rpm": Bounds(1e-6, 1e6),
    "rated_kW": Bounds(1e-3, 1e6),
    "hours_since_run": Bounds(0.0, 1e6),
    "offset": Bounds(0.0, 1e9),
    "resolution": Bounds(0.0, 1e9),
    "initial": Bounds(COLDEST, HOTTEST),
    "boundaries": Bounds(COLDEST, HOTTEST),
    "inputs": ANY,
    "load": ANY,
    "parameters.prior_sd": Bounds(1e-9, 1e12),
    "value": ANY,
    "low": ANY,
    "high": ANY,
    "values": ANY,
    "intervals": ANY,
    "acts_on": Bounds(-10.0, 10.0),
    "before": Bounds(0.0, 1e4),
    "after": Bounds(0.0, 1e4),
    "position_mm": Bounds(-1e6, 1e6),
    "coefficients": ANY,
    "at_speed": ANY,
    "at_torque": ANY,
    "range": Bounds(0.0, 1e12),
    "remanence_T": Bounds(0.0, 5.0),
    "power.exponent": Bounds(0.0, 4.0),
    "mixed.exponent": Bounds(1.0, 10.0),
    "difference_K": Bounds(0.0, 1e4),
    "magnetising_A": Bounds(1e-6, 1e7),
    "regeneration": Bounds(0.0, 1.0),
    "brakes_m_s2": Bounds(0.0, 100.0),
    "alpha_stator_1_K": Bounds(0.0, 0.0125),
    "alpha_cage_1_K": Bounds(0.0, 0.0125),  # no cooling down to -60 degC
    "switching_J": Bounds(0.0, 1e4),
    "reference_A": Bounds(1e-6, 1e7),
    "reference_V": Bounds(1e-6, 1e7),
    "electrical.factor": ANY,
    "mechanical.factor": ANY,
    "shares": Bounds(0.0, 1.0),
}


def bounds(key: str, table: str = "") -> Bounds:
    """What a number under this key may be; `table` is the name of the table it stands in."""
    for name in (f"{table}.{key}", key):
        if name in KEYS:
            return KEYS[name]
    for unit, limits in UNITS.items():
        if key == unit or key.endswith(f"_{unit}"):
            return limits
    return ANY
