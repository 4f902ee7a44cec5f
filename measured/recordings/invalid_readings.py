"""What a logger writes where it read nothing: found, left out, and said."""

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array

KINDS = {
    "nines of loggers": (9999.0, 9999.9, 99999.0, 999.9, 999.0, -999.0, -999.9, -9999.0),
    "open or broken thermocouples": (1370.0, 1372.0, 1820.0, -200.0, -270.0),
    "DS18B20 without an answer": (-127.0,),
    "16-bit registers and their tenths": (32767.0, -32768.0, 65535.0, 3276.7, -3276.8, 6553.5),
}
CODES = np.concatenate([*KINDS.values()])
ENDLESS = 1e30  # and beyond: 9.9e37 and its kin
LARGEST_THERMOCOUPLE = 1820.0  # codes up to it are limits of thermocouples, and may be speeds
FAR = 2.0  # times the span of the other readings, beyond them: nearer, a speed may be what it says
LEAST = 50.0  # in the unit of the file, of that distance; enough for temperatures, which seldom leap as far


def coded(values: Array, far: float = 0.0) -> NDArray[np.bool_]:
    """Which readings (as the file has them) are a logger's codes: of that very value, and beyond all others.

    far : least distance in spans of the other readings, for what may leap
    """
    exact = np.isin(values, CODES) | (np.abs(values) >= ENDLESS)
    read = np.isfinite(values)
    if read.sum() > 1 and np.all(exact[read]) and np.unique(values[read]).size == 1:
        return exact  # never read at all
    others = values[~exact & np.isfinite(values)]
    if not exact.any() or not others.size:
        return np.zeros(values.size, bool)
    low, high = float(np.min(others)), float(np.max(others))
    distance = max(LEAST, far * (high - low))
    return exact & ((values < low - distance) | (values > high + distance))


def code_note(column: str, values: Array, invalid: NDArray[np.bool_], first_line: int) -> str:
    """What was left out of a column, and where it begins."""
    which = ", ".join(f"{v:g}" for v in np.unique(values[invalid]))
    line = int(np.flatnonzero(invalid)[0]) + first_line
    code = "are a logger's code for no reading and are left out"
    return f"{column}: {int(invalid.sum())} readings of {which} {code}, first in line {line}"
