"""Arrays as short text for a page: whole numbers, differences of neighbours without a sign, deflate, base64."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

from geom.arrays import Array, Ints

UNKNOWN = -1  # whole numbers of a column begin at zero: this one stands for what is not finite
LEVEL = 8  # of deflate: 9 makes a page half a percent shorter and takes two and a half times as long


def packed_integers(values: Ints) -> dict[str, Any]:
    """Rows of whole numbers (n, k), each as the difference from the row before it: meshes are regular.

    A difference n is 2 n, and -n is 2 n - 1: the upper bytes of small ones are then zero, whatever their sign.
    """
    steps = np.diff(values, axis=0, prepend=np.zeros((1, values.shape[1]), np.int64))
    unsigned = np.where(steps < 0, -2 * steps - 1, 2 * steps).astype("<u4")
    planes = np.ascontiguousarray(unsigned.T).view(np.uint8).reshape(-1, 4).T  # equal bytes side by side deflate well
    data = zlib.compress(np.ascontiguousarray(planes).tobytes(), LEVEL)
    return {"columns": values.shape[1], "data": base64.b64encode(data).decode("ascii")}


def packed_numbers(values: Array, step: Array | float | None = None) -> dict[str, Any]:
    """Rows of numbers (n, k), each column in its own step (k,), or in 65,535 steps over its range; NaN stays NaN."""
    finite = np.isfinite(values)
    low = np.where(finite, values, np.inf).min(axis=0, initial=np.inf)
    low = np.where(np.isfinite(low), low, 0.0)
    above = np.where(finite, values - low, 0.0)
    fine = np.maximum(above.max(axis=0, initial=0.0), 1e-12) / 65535
    steps = np.broadcast_to(fine if step is None else step, low.shape)
    whole = np.where(finite, np.round(above / steps), UNKNOWN).astype(np.int64)
    return {**packed_integers(whole), "low": low.tolist(), "step": steps.tolist()}
