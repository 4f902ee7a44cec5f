"""Units at the door: files say what they like, memory holds degC, A, rpm, m/s, m3/h, l/min, N*m, W, V, ohm.

Units in the table are known by heart; any other goes to pint, which refuses one of another dimension.
"""

import re
from collections.abc import Mapping
from functools import cache
from math import isfinite, pi
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.constants import ZERO_C
from geom.errors import InputError
from geom.plugins import plugins
from lumped.schemas.reader import excerpt, suggestion
from measured.recordings.quantity import Quantity

MASS = {"kg/s": 60.0, "kg/min": 1.0, "kg/h": 1 / 60, "g/s": 0.06}  # kg/min
AIR = 1.2  # kg/m3, at 20 degC and sea level
WATER = {m: (x, 0.0) for m, x in MASS.items()}  # of 1 kg/l: at 90 degC 4 % more volume, of half glycol 7 % less
QUANTITIES: dict[str, Quantity] = {
    "temperature": Quantity({"degC": (1, 0), "K": (1, -ZERO_C), "degF": (5 / 9, -160 / 9)}),
    "current": Quantity({"A": (1, 0), "mA": (1e-3, 0), "kA": (1e3, 0)}, "current_A"),
    "speed": Quantity({"rpm": (1, 0), "1/min": (1, 0), "rad/s": (30 / pi, 0), "Hz": (60, 0)}, "speed_rpm"),
    "vehicle_speed": Quantity({"m/s": (1, 0), "km/h": (1 / 3.6, 0), "mph": (0.44704, 0)}, "vehicle_speed_mps"),
    "air_flow": Quantity(
        {"m3/h": (1, 0), "m3/s": (3600, 0), "l/s": (3.6, 0), **{m: (60 * x / AIR, 0) for m, x in MASS.items()}},
        "fan_flow_m3h",
    ),
    "water_flow": Quantity({"l/min": (1, 0), "L/min": (1, 0), "m3/h": (1000 / 60, 0), **WATER}, "flow_l_min"),
    "torque": Quantity({"N*m": (1, 0), "Nm": (1, 0), "kN*m": (1e3, 0)}, "torque_Nm"),
    "power": Quantity({"W": (1, 0), "kW": (1e3, 0)}, "power_W"),
    "voltage": Quantity({"V": (1, 0), "mV": (1e-3, 0), "kV": (1e3, 0)}, "voltage_V"),
    "resistance": Quantity({"ohm": (1, 0), "mohm": (1e-3, 0), "kohm": (1e3, 0)}),
    "back_emf": Quantity({"V": (1, 0), "mV": (1e-3, 0), "kV": (1e3, 0)}),
    "frequency": Quantity({"Hz": (1, 0), "kHz": (1e3, 0)}, "switching_Hz"),
    "share": Quantity({"%": (1, 0), "1": (100, 0), "W/m2": (0.1, 0)}, "share_percent"),  # of a sun of 1000 W/m2
    "flow_share": Quantity({"%": (1, 0), "1": (100, 0)}, "flow_percent"),
    "fraction": Quantity({"1": (1, 0), "%": (0.01, 0)}),
    "time": Quantity({"s": (1, 0), "ms": (1e-3, 0), "min": (60, 0), "h": (3600, 0)}),
    **plugins("quantities"),
}

MEMORY_UNIT = {
    name: next((unit for unit, how in q.units.items() if how == (1, 0)), "") for name, q in QUANTITIES.items()
} | {"share": "% where the input's name ends in _percent, else 0 to 1"}  # what memory holds

ROOM_K, ROOM_F = (253.0, 318.0), (59.0, 95.0)  # where a machine at rest starts, in K and in degF
LONGEST = 40  # characters
SWITCHED = ("share", "flow_share", "fraction")  # what true and false can be
LARGEST = 1e9  # of anything that is not a temperature, in the unit of memory
_ONE = r"(?:1|[A-Za-zµμΩ°_]+)(?:(?:\*\*|\^)-?[1-4])?"
UNIT = re.compile(rf"{_ONE}(?:\s*[*/·]\s*{_ONE})*|%")  # no powers beyond the fourth: pint would compute any

PINT = {
    "speed": "revolution / minute",
    "share": "percent",
    "flow_share": "percent",
    "fraction": "dimensionless",
    "water_flow": "liter / minute",
    "air_flow": "m**3 / hour",
}


def checked_unit(of: str, unit: Any, where: str) -> str:
    """The unit, if it was given and belongs to the quantity."""
    units = QUANTITIES[of].units
    if unit is None or unit == "":
        first, *others = units
        more = f" (or {', '.join(others)})" if others else ""
        raise InputError("the unit is missing", where, f'write unit = "{first}"{more}')
    if not isinstance(unit, str):
        raise InputError(f"unit = {excerpt(unit)} is not a unit", where, f"one of {', '.join(units)}, in quotes")
    if unit not in units and _by_pint(of, unit) is None:
        others = [f'"{name}"' for name, quantity in QUANTITIES.items() if name != of and unit in quantity.units]
        belongs = f"quantity = {' or '.join(others)} has it; " if others else ""
        raise InputError(f"unknown unit {excerpt(unit)} of a {of}", where, f"{belongs}{suggestion(unit, units)}")
    return unit


def checked_input(of: str, name: str, where: str) -> str:
    """The input a column feeds, unless its name says another unit than the one memory holds."""
    suffix = QUANTITIES[of].feeds.rpartition("_")[2]
    for unit in QUANTITIES[of].units:
        word = unit.replace("/", "_").replace("*", "")
        if suffix and word.isidentifier() and name.endswith(f"_{word}") and not name.endswith(f"_{suffix}"):
            right = f'input = "{name.removesuffix(word)}{suffix}": a {of} is held in {suffix} whatever its unit here'
            raise InputError(f"input '{name}' says {word}", where, right)
    return name


def memory_quantity(of: str, name: str) -> str:
    """The quantity as memory holds it: a share is percent where its input's name says so, else 0 to 1."""
    return "fraction" if of == "share" and not name.endswith("_percent") else of


def converted(values: Array, of: str, unit: str, settings: Mapping[str, float] | None = None) -> Array:
    """Values in the unit of memory; of a sensor of another quantity degC, with what its column says of the sensor."""
    factor, offset = _scale(of, unit)
    si, degC = values * factor + offset, QUANTITIES[of].degC
    return si if degC is None else np.asarray(degC(si, **(settings or QUANTITIES[of].settings)), float)


def usual_sigma(of: str, unit: str) -> float:
    """Standard deviation of such a sensor in the unit of its column."""
    return QUANTITIES[of].sigma / abs(_scale(of, unit)[0])


def _scale(of: str, unit: str) -> tuple[float, float]:
    """Factor and offset into the unit of memory."""
    return QUANTITIES[of].units.get(unit) or _by_pint(of, unit) or (1.0, 0.0)


@cache
def _by_pint(of: str, unit: str) -> tuple[float, float] | None:
    """Factor and offset of a unit that is not in the table, None where it is unknown or measures something else."""
    import pint

    if not UNIT.fullmatch(unit) or len(unit) > LONGEST:
        return None
    registry: Any = pint.UnitRegistry(autoconvert_offset_to_baseunit=True)
    ours = PINT.get(of, next(iter(QUANTITIES[of].units)))
    try:
        zero, one = (float(registry.Quantity(v, unit).to(ours).magnitude) for v in (0.0, 1.0))
    except (pint.errors.PintError, AttributeError, ValueError, TypeError, SyntaxError, AssertionError):
        return None
    return (one - zero, zero) if isfinite(zero) and isfinite(one - zero) and one != zero else None
