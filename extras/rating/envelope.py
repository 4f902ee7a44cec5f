"""Ratings: the load at which the first limit is reached, for ever, for a time, in a duty, or over a repeated cycle.

T(load) = limit,   sd of the load = sd of T at the limit / (dT / d load)
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.optimize import brentq

from extras.rating.operation import Operation
from extras.rating.points import REPEATS_K, RUNAWAY_C, S3, S6, Model
from thermoscope import InputError, Record, ThermoscopeError, plugin as th

LARGEST = 50.0  # of the reference load; beyond, no temperature limits
CLOSE = 1e-3  # of a load: a tenth of what inputs are known to
DUTIES = ("S1", "S2 60 min", "S2 60 s", "S2 10 s", "S3 40 %", "S6 40 %")
TIMES = {"S2 60 min": 3600.0, "S2 60 s": 60.0, "S2 10 s": 10.0}  # s, as their names say


@dataclass(frozen=True)
class Rating:
    """One rating.  load : of the reference, inf where no load within LARGEST reaches a limit

    at : the place that limits;  slope : d T / d load there (K)
    """

    form: str
    speed: float | None
    load: float
    at: str
    slope: float


class LimitError(InputError):
    """A limit that is exceeded without any load."""


def rated(model: Model, op: Operation, limits: Mapping[str, float], form: str, speed: float | None) -> Rating:
    """The load of a form at a speed (1/min; the reference where None); short times begin where `op` says.

    Raises LimitError where a limit is exceeded without any load.
    """
    return reached(excess(model, op, form, speed), limits, form, speed)


def reached(over: Callable[[float], th.Array], limits: Mapping[str, float], form: str, speed: float | None) -> Rating:
    """The load at which the first limit is reached.  over : load -> temperatures of the places (degC), growing with it

    Raises LimitError where a limit is exceeded without any load.
    """
    names, most = list(limits), np.array(list(limits.values()))

    over = cache(over)

    def worst(load: float) -> float:
        return float(np.max(over(load) - most))

    if worst(0.0) >= 0.0:
        T = over(0.0)
        k = int(np.argmax(T - most))
        if T[k] >= RUNAWAY_C:
            right = "a way for heat to leave every part; effects add one (explain diagnose)"
            raise InputError("the model does not come to rest even without any load", f"rating {form}", right)
        what = f"the limit of '{names[k]}', {most[k]:g} degC, is exceeded without any load ({T[k]:.1f} degC)"
        raise LimitError(what, "--limit", "a higher limit, cooler surroundings or a lower speed")
    high = 1.0
    while worst(high) < 0.0:
        high *= 1.5
        if high > LARGEST:
            return Rating(form, speed, float("inf"), "", 0.0)
    # copper's heat goes with the square of the load: over it the excess is nearly straight, and found in few runs
    load = float(brentq(lambda square: worst(square**0.5), 0.0, high**2, xtol=2.0 * CLOSE * high**2)) ** 0.5
    here, above = over(load), over(load * 1.01)
    k = int(np.argmax(here - most))
    return Rating(form, speed, load, names[k], float((above[k] - here[k]) / (0.01 * load)))


def excess(model: Model, op: Operation, form: str, speed: float | None) -> Callable[[float], th.Array]:
    """load -> largest temperatures (degC) of a form."""
    if form == "S1":
        return lambda load: model.rest(op, load, speed)
    if form in TIMES:
        begin = model.start(op, op.warm, None)
        return lambda load: model.course(op, load, speed, begin, TIMES[form])[1].max(axis=0)
    duty = S3 if form == "S3 40 %" else S6
    return lambda load: model.repeated(op, load, speed, duty)


def until(
    model: Model,
    op: Operation,
    limits: Sequence[float],
    load: float,
    speed: float | None,
    warm: float | None,
    longest: float = 86400.0,
) -> float:
    """Seconds until a limit is reached under a load, from cold or from rest under the load `warm`; inf if never."""
    begin, most = model.start(op, warm, speed), np.asarray(limits)
    x = begin.x  # type: ignore[attr-defined]
    z = np.concatenate([x, [op.boundaries[b] for b in model.network.boundaries]])
    if np.any(model.place_temperatures(z[None])[0] >= most):
        return 0.0

    def left(seconds: float) -> float:
        return float(np.max(model.course(op, load, speed, begin, seconds)[1][-1] - most))

    low, high = 0.0, 1.0  # grown step by step: a run without rest goes astray long after the limit
    while (over := left(high)) < 0.0:
        if high >= longest:
            return float("inf")
        low, high = high, min(4.0 * high, longest)
    low = max(low, 1e-3)
    return float(brentq(left, low, high, rtol=1e-3)) if over > 0.0 > left(low) else low


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
