"""Arrays as short text for a page: whole numbers, differences of neighbours, deflate, base64."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
LEVEL = 8  # of deflate: 9 makes a page half a percent shorter and takes two and a half times as long


def packed_integers(values: NDArray[np.int64]) -> dict[str, Any]:
    """Rows of whole numbers (n, k), each as the difference from the row before it: meshes are regular."""
    steps = np.diff(values, axis=0, prepend=np.zeros((1, values.shape[1]), np.int64)).astype("<i4")
    planes = np.ascontiguousarray(steps.T).view(np.uint8).reshape(-1, 4).T  # equal bytes side by side deflate well
    data = zlib.compress(np.ascontiguousarray(planes).tobytes(), LEVEL)
    return {"columns": values.shape[1], "data": base64.b64encode(data).decode("ascii")}


def packed_numbers(values: Array, step: Array | None = None) -> dict[str, Any]:
    """Rows of numbers (n, k), each column in its own step (k,), or in 65,535 steps over its range."""
    low = values.min(axis=0)
    if step is None:
        step = np.maximum(np.ptp(values, axis=0), 1e-12) / 65535
    whole = np.round((values - low) / step).astype(np.int64)
    return {**packed_integers(whole), "low": low.tolist(), "step": step.tolist()}


def unpacked(packed: dict[str, Any]) -> Array:
    """What the page reads: (n, k)."""
    columns = packed["columns"]
    planes = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), np.uint8).reshape(4, -1)
    steps = np.ascontiguousarray(planes.T).view("<i4").reshape(columns, -1).T
    whole = np.cumsum(steps, axis=0)
    return whole * np.array(packed.get("step", 1)) + np.array(packed.get("low", 0))
