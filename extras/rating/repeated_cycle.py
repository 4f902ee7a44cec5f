"""A drive cycle that follows on itself: the share of its load that holds for ever, and how long all of it holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from extras.rating.envelope import reached
from extras.rating.operation import Operation
from extras.rating.points import REPEATS_K, Model
from thermoscope import InputError, Record, ThermoscopeError, plugin as th

LONGEST_S = 7 * 86400.0  # a week of the same cycle; heavier machines do not settle slower


@dataclass(frozen=True)
class Lap:
    """One lap of a cycle. record : its inputs and boundaries at load 1;  loads : the inputs that a load multiplies"""

    record: Record
    loads: tuple[str, ...]

    def at(self, load: float) -> Record:
        inputs = {n: load * np.asarray(u) if n in self.loads else u for n, u in self.record.inputs.items()}
        return replace(self.record, inputs=inputs)

    def mean(self, op: Operation) -> tuple[Operation, float]:
        """Where its mean lies: the operation, and the load of the same mean square."""
        inputs = {n: float(np.mean(u)) for n, u in self.record.inputs.items()}
        boundaries = {b: float(np.mean(T)) for b, T in self.record.boundaries.items()}
        square = float(np.mean(np.square(self.record.inputs[op.main])))
        average = op.moved({n: inputs[n] for n in op.inputs if n not in self.loads}, boundaries)
        return average, square**0.5 / abs(op.inputs[op.main])


def share_for_ever(model: Model, op: Operation, limits: Mapping[str, float], lap: Lap) -> tuple[float, str]:
    """The share of the cycle's load that may be carried lap after lap, and the place that limits.

    inf, "" where no share within reach does. Raises InputError where a limit is exceeded without any load.
    """
    around, load = lap.mean(op)
    if load == 0.0:
        raise InputError(f"'{op.main}' is zero all along", "--cycle", "a cycle with a load")
    limit = reached(
        lambda share: model.again_and_again(around, lap.at(share), share * load, None), limits, "cycle", None
    )
    return limit.load, limit.at


def time_to_limit(model: Model, op: Operation, limits: Mapping[str, float], lap: Lap) -> float:
    """Seconds from cold until the whole cycle, lap after lap, reaches the first limit; inf if it never does."""
    around, _ = lap.mean(op)
    most, stand, laps = np.array(list(limits.values())), model.start(around, None, None), 0
    span = float(lap.record.time[-1] - lap.record.time[0])
    while laps * span < LONGEST_S:
        try:
            T, end = model.run(lap.record, stand)
        except ThermoscopeError:
            return laps * span
        over = np.flatnonzero(np.any(most <= T, axis=1))
        if over.size:
            return laps * span + _crossing(lap.record.time, T - most, int(over[0]))
        if np.abs(end.x - stand.x).max() < REPEATS_K:
            break
        stand, laps = model.at(around, end.x), laps + 1
    return float("inf")


def _crossing(time: th.Array, excess: th.Array, k: int) -> float:
    """Seconds of the lap at which the first place is at its limit, straight between samples k - 1 and k."""
    if k == 0:
        return 0.0
    a, b = float(excess[k - 1].max()), float(excess[k].max())
    return float(time[k - 1] - time[0] + (time[k] - time[k - 1]) * a / (a - b))
