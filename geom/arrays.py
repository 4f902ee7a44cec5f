"""What annotations call arrays of numbers, and numbers by name."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]
Number = Array | float  # one for all, or one each
Numbers = Mapping[str, float]


def sample_columns(at: Array, time: Array, columns: Array) -> Array:
    """Columns (n_time, k) on straight lines between their instants, at others; beyond the ends as there."""
    return np.column_stack([np.interp(at, time, column) for column in columns.T])
