"""Units at the door: files say what they like, memory holds degC, A, rpm, m/s, m3/h, l/min, N*m, W, V, ohm.

Units in the table are known by heart; any other goes to pint, which refuses one of another dimension.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.reader import known

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """units : unit -> (factor, offset) into the unit of memory;  feeds : the network input it drives by default"""

    units: dict[str, tuple[float, float]]
    feeds: str = ""


QUANTITIES = {
    "temperature": Quantity({"degC": (1, 0), "K": (1, -273.15), "degF": (5 / 9, -160 / 9)}),
    "current": Quantity({"A": (1, 0), "mA": (1e-3, 0), "kA": (1e3, 0)}, "current_A"),
    "speed": Quantity({"rpm": (1, 0), "1/min": (1, 0), "rad/s": (30 / pi, 0), "Hz": (60, 0)}, "speed_rpm"),
    "vehicle_speed": Quantity({"m/s": (1, 0), "km/h": (1 / 3.6, 0), "mph": (0.44704, 0)}, "vehicle_speed_mps"),
    "air_flow": Quantity({"m3/h": (1, 0), "m3/s": (3600, 0), "l/s": (3.6, 0)}, "fan_flow_m3h"),
    "water_flow": Quantity({"l/min": (1, 0), "L/min": (1, 0), "m3/h": (1000 / 60, 0)}, "flow_l_min"),
    "torque": Quantity({"N*m": (1, 0), "Nm": (1, 0), "kN*m": (1e3, 0)}, "torque_Nm"),
    "power": Quantity({"W": (1, 0), "kW": (1e3, 0)}, "power_W"),
    "voltage": Quantity({"V": (1, 0), "mV": (1e-3, 0), "kV": (1e3, 0)}, "voltage_V"),
    "resistance": Quantity({"ohm": (1, 0), "mohm": (1e-3, 0), "kohm": (1e3, 0)}),
    "back_emf": Quantity({"V": (1, 0), "mV": (1e-3, 0), "kV": (1e3, 0)}),
    "frequency": Quantity({"Hz": (1, 0), "kHz": (1e3, 0)}, "switching_Hz"),
    "share": Quantity({"%": (1, 0), "1": (100, 0)}, "share_percent"),
    "time": Quantity({"s": (1, 0), "ms": (1e-3, 0), "min": (60, 0), "h": (3600, 0)}),
}

PINT = {"speed": "revolution / minute", "share": "percent", "water_flow": "liter / minute", "air_flow": "m**3 / hour"}


def checked_unit(of: str, unit: Any, where: str) -> str:
    """The unit, if it was given and belongs to the quantity."""
    units = QUANTITIES[of].units
    if not unit:
        first, *others = units
        raise InputError("the unit is missing", where, f'unit = "{first}" (or {", ".join(others)})')
    if unit not in units and _by_pint(of, str(unit)) is None:
        raise InputError(f"unknown unit '{unit}' of a {of}", where, known(str(unit), units))
    return str(unit)


def converted(values: Array, of: str, unit: str) -> Array:
    """Values in the unit of memory."""
    factor, offset = QUANTITIES[of].units.get(unit) or _by_pint(of, unit) or (1.0, 0.0)
    return values * factor + offset


@cache
def _by_pint(of: str, unit: str) -> tuple[float, float] | None:
    """Factor and offset of a unit that is not in the table, None where it is unknown or measures something else."""
    import pint

    registry: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    ours = PINT.get(of, next(iter(QUANTITIES[of].units)))
    try:
        zero, one = (float(registry.Quantity(v, unit).to(ours).magnitude) for v in (0.0, 1.0))
    except (pint.errors.PintError, AttributeError, ValueError, TypeError, SyntaxError, AssertionError):
        return None
    return one - zero, zero
