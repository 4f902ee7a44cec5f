"""How long a machine may stay at every point of load and speed: the map of its continuous and short-time fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from extras.rating.envelope import until
from extras.rating.operation import Operation
from extras.rating.points import Model
from thermoscope.plugin import Array


def holding_times(
    model: Model, op: Operation, limits: Mapping[str, float], loads: Sequence[float], speeds: Sequence[float]
) -> Array:
    """(n_speed, n_load) seconds from cold until a limit is reached; inf where it may stay for ever."""
    return np.array([[_time(model, op, list(limits.values()), load, n) for load in loads] for n in speeds])


def _time(model: Model, op: Operation, most: Sequence[float], load: float, speed: float) -> float:
    if np.all(model.rest(op, load, speed) < np.asarray(most)):
        return float("inf")
    return until(model, op, most, load, speed, None)
