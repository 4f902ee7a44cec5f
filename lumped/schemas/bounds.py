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


ANY = Bounds(-1e12, 1e12)  # keeps out what overflows, and no more
UNIT_ROWS = (  # least, most, units
    (0.0, 1e7, "W_m2K W_K V A"),
    (TINY, 1e9, "K_W"),
    (1.0, 1e5, "J_kgK"),
    (LEAST_J_K, 1e10, "J_K"),
    (1e-3, 3e4, "kg_m3"),
    (0.0, 1e6, "kg_m2 Nms rpm m2 factor"),
    (-10.0, 10.0, "percent_K exponent"),
    (-1.0, 1.0, "per_K 1_K"),
    (COLDEST, HOTTEST, "degC C"),
    (0.0, 1e4, "K"),
    (0.0, 1e9, "ohm W s"),
    (0.0, 1e12, "mOhm"),
    (1e-3, 1e6, "kW mm"),
    (TINY, 1e3, "H"),
    (1e-9, 1e9, "Hz"),
    (TINY, 1e4, "Vs"),
    (1e-4, 1e5, "m"),
    (1e-6, 1e6, "l"),
    (1e-9, 1e7, "kg"),
    (0.0, 1e3, "bar m_s"),
    (1e-9, 1e8, "l_min"),
    (1e-6, 1e8, "L_per_min"),
    (0.0, 1e8, "m3_h"),
    (0.0, 100.0, "percent"),
    (0.0, 1.0, "share"),
    (0.01, 1.0, "efficiency"),
    (1e-9, 10.0, "prior_sd"),
)
# Keys without a unit in their name, or tighter than their unit; "table.key" where a key means something else there.
KEY_ROWS = (
    (ANY.low, ANY.high, "inputs load value low high values intervals coefficients at_speed at_torque"),
    (ANY.low, ANY.high, "electrical.factor mechanical.factor"),
    (0.0, 1.0, "emissivity view_factor view speed_at_end no_load rolling iron_in_poles regeneration shares"),
    (0.0, 1.0, "armature_in_end_windings windage_in_gap"),
    (TINY, 1e12, "at speed_at excitation_at"),
    (1e-9, 1e6, "at_rpm"),
    (1.0, 1e6, "up_to_rpm"),
    (1e-3, 1e3, "up_to_m_s"),
    (TINY, 1e6, "m_s_per_unit"),
    (1.0, 1e9, "settles_s"),
    (1e-3, 86400.0, "sample_s step_s"),
    (1e-6, 1e7, "period_s magnetising_A reference_A reference_V"),
    (1e-3, 1e9, "duration_s on_s"),
    (-1e9, 1e9, "shift_s"),
    (1e-3, 1e6, "limit_s rated_kW"),
    (0.0, 86400.0, "lag_s filter_s"),
    (1e-6, 1e3, "current_lag_s"),
    (0.0, 1e6, "max_gap_s coil_diameter_mm doubt hours_since_run"),
    (1e-3, 100.0, "sigma_K resolution_K wheel_radius_m"),
    (0.0, 100.0, "model_error_K brakes_m_s2"),
    (0.0, 10.0, "turbulence k3 end_space_k3"),
    (0.0, 1e4, "k1 k2 end_space_k2 before after difference_K switching_J"),
    (1e-4, 100.0, "size_m"),
    (0.0, 9000.0, "altitude_m"),
    (1.0, 1e5, "axial_mm"),
    (-60.0, 200.0, "fluid_degC"),  # where the tables of fluids hold
    (-40.0, 200.0, "at_degC inlet_C property_C"),  # from where glycol mixtures freeze to where oils are used
    (COLDEST, HOTTEST, "cold.at_degC initial boundaries"),
    (0.0, 60.0, "mass_percent"),
    (1e-9, 1e7, "supply_V"),
    (1e-3, 1e4, "gear"),
    (0.0, 1e3, "drag_area_m2"),
    (0.0, 1e9, "Kp Ki offset resolution"),
    (1e-9, 1e9, "reading resistance_ohm"),
    (1e-6, 1e6, "rpm speed_rpm"),
    (1e-9, 1e12, "parameters.prior_sd"),
    (-10.0, 10.0, "acts_on"),
    (-1e6, 1e6, "position_mm"),
    (0.0, 1e12, "range"),
    (0.0, 5.0, "remanence_T"),
    (0.0, 4.0, "power.exponent"),
    (1.0, 10.0, "mixed.exponent"),
    (0.0, 0.0125, "alpha_stator_1_K alpha_cage_1_K"),  # no cooling down to -60 degC
)
WHOLE_ROWS = (
    (1, 64, "cells"),
    (1, 500, "pole_pairs"),
    (1, 1000, "starts"),
    (1, 1e4, "parallel"),
    (1, 1e5, "cycles"),
    (1, 1e9, "number"),
    (0, 1e4, "bends"),
    (0, 1e9, "lines"),
    (0, 2**32 - 1, "seed"),
    (-1, 1, "sign"),
)
UNITS = {unit: Bounds(low, high) for low, high, units in UNIT_ROWS for unit in units.split()}
KEYS = {key: Bounds(low, high) for low, high, keys in KEY_ROWS for key in keys.split()}
KEYS |= {key: Bounds(low, high, whole=True) for low, high, keys in WHOLE_ROWS for key in keys.split()}
ENDINGS = sorted(UNITS, key=len, reverse=True)  # the longest first where one ends like another: W_m2K before K


def bounds(key: str, table: str = "") -> Bounds:
    """What a number under this key may be; `table` is the name of the table it stands in."""
    for name in (f"{table}.{key}", key):
        if name in KEYS:
            return KEYS[name]
    unit = next((unit for unit in ENDINGS if key == unit or key.endswith(f"_{unit}")), None)
    return ANY if unit is None else UNITS[unit]
