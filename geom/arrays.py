"""What annotations call arrays of numbers, and numbers by name."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]
Number = Array | float  # one for all, or one each
Numbers = Mapping[str, float]
