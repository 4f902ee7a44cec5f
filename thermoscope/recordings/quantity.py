"""What a column may measure: its units, and what it is good for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """units : unit -> (factor, offset) into the unit of memory;  feeds : the network input it drives by default

    degC : of a sensor that does not read degC by itself, what its readings in the unit of memory say (degC)
    sigma_K : usual standard deviation of such a sensor, where a sheet gives none
    """

    units: dict[str, tuple[float, float]]
    feeds: str = ""
    degC: Callable[[Array], Array] | None = None
    sigma_K: float = 0.5
