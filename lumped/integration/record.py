"""The record a network runs over."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """time (nt,) s; inputs and boundaries: name -> (nt,) or scalar; initial: degC everywhere or per place.

    Inputs and boundaries are linear between the times; a time given twice is a jump.
    """

    time: Array
    inputs: Mapping[str, Array | float]
    boundaries: Mapping[str, Array | float]
    initial: float | Mapping[str, float] = 20.0
