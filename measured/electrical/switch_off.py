"""Back to the instant of switching off: what the winding's mean was, from readings taken while it cooled.

Three ways, each with a standard uncertainty:
- the 150 % rule: the fall of the first minute is 1.5 times that of the second;
- the semi-logarithmic line of IEC 60034-1 (8.6.2.3.3, table 5), with its limits of time by rating;
- one or two exponentials, by the corrected Akaike criterion (Burnham and Anderson 2002).
"""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.errors import InputError

DELAYS_S = ((50.0, 30.0), (200.0, 90.0), (5000.0, 120.0))  # rated power up to (kW) -> delay allowed (s)
FACTOR = 1.5  # the rule's own: the first minute falls 1.5 times as far as the second


@dataclass(frozen=True)
class Extrapolated:
    """at_s : the instant after switching off the value stands for;  value (degC), sd (K);  words : how it was found"""

    method: str
    at_s: float
    value: float
    sd: float
    words: str

    def document(self) -> dict[str, Any]:
        return dict(vars(self))


@dataclass(frozen=True)
class Cooling:
    """Readings after switching off.  time (n,) s, T (n,) degC, ambient degC, reading_sd K (scatter of one reading)."""

    time: Array
    T: Array
    ambient: float
    reading_sd: float

    def __post_init__(self) -> None:
        t = np.asarray(self.time, float)
        if t.size < 3 or t.size != np.size(self.T) or np.any(np.diff(t) <= 0) or t[0] < 0:
            raise InputError("no cooling curve", "readings after switching off", "3 or more readings at rising times")

    @property
    def falls(self) -> bool:
        return bool(self.T[-1] < self.T[0])


def allowed_delay(rated_kW: float) -> float:
    """Time (s) within which a reading counts as taken at the instant of switching off (IEC 60034-1, table 5)."""
    for up_to, delay in DELAYS_S:
        if rated_kW <= up_to:
            return delay
    raise InputError(f"{rated_kW:g} kW is beyond 5000 kW", "rated power", "limits of time by agreement")


def rule_150(cooling: Cooling) -> Extrapolated:
    """T(0) = T(60) + 1.5 (T(60) - T(120)), the readings drawn straight between their times."""
    t, T = cooling.time, cooling.T
    if t[0] > 60.0 or t[-1] < 120.0:
        right = "readings from before 60 s to after 120 s"
        raise InputError(f"readings from {t[0]:g} s to {t[-1]:g} s", "150 % rule", right)
    weights = (1.0 + FACTOR) * _between(t, 60.0) - FACTOR * _between(t, 120.0)
    sd = cooling.reading_sd * float(np.linalg.norm(weights))
    return Extrapolated("150 % rule", 0.0, float(weights @ T), sd, "first minute falls 1.5 times as far as the second")


def _between(t: Array, at: float) -> Array:
    """Weights that draw a straight line between the neighbours of an instant."""
    return np.array([float(np.interp(at, t, unit)) for unit in np.eye(t.size)])


def semilog(cooling: Cooling, rated_kW: float, within_s: float = 300.0) -> Extrapolated:
    """IEC 60034-1: a first reading in time counts as it is; one up to twice as late is extrapolated to the limit.

    The logarithm of the rise over ambient is fitted by a straight line to the readings of the first `within_s`.
    """
    limit, first = allowed_delay(rated_kW), float(cooling.time[0])
    if first <= limit:
        words = f"first reading {first:g} s after switching off, within the {limit:g} s that count as none"
        return Extrapolated("IEC 60034-1", first, float(cooling.T[0]), cooling.reading_sd, words)
    if first > 2.0 * limit:
        right = f"not later than {2 * limit:g} s for {rated_kW:g} kW; or the test again"
        raise InputError(f"first reading {first:g} s after switching off", "IEC 60034-1", right)
    if not cooling.falls:
        words = "readings rise after switching off: the highest counts"
        at, most = float(cooling.time[np.argmax(cooling.T)]), float(cooling.T.max())
        return Extrapolated("IEC 60034-1", at, most, cooling.reading_sd, words)
    return semilog_at(cooling, limit, within_s)


def semilog_at(cooling: Cooling, at_s: float = 0.0, within_s: float = 300.0) -> Extrapolated:
    """The straight line through ln(T - ambient), read at an instant."""
    early = cooling.time <= within_s
    t, rise = cooling.time[early], cooling.T[early] - cooling.ambient
    if t.size < 3 or np.min(rise) <= 0:
        raise InputError("readings not above ambient", "semi-logarithmic fit", "3 or more readings above ambient")
    line, unscaled = np.polyfit(t, np.log(rise), 1, w=rise, cov="unscaled")
    left = rise * (np.polyval(line, t) - np.log(rise))
    scale = max(float(left @ left) / (t.size - 2), cooling.reading_sd**2)
    x = np.array([at_s, 1.0])
    T = float(np.exp(x @ line))
    sd = T * float(np.sqrt(scale * x @ unscaled @ x))
    return Extrapolated("semi-logarithmic", at_s, cooling.ambient + T, sd, f"line through {t.size} readings")


def exponentials(cooling: Cooling, at_s: float = 0.0) -> Extrapolated:
    """T = T_end + A exp(-t / tau) [+ A2 exp(-t / tau2)], the better of both, read at an instant."""
    one, two = _fit(cooling, 1), _fit(cooling, 2)
    best = two if two is not None and (one is None or two.score < one.score - 2.0) else one
    if best is None:
        raise InputError(f"{cooling.time.size} readings", "exponential fit", "5 readings or more")
    T, sd = best.at(at_s)
    taus = " and ".join(f"{tau:.0f} s" for tau in best.taus)
    return Extrapolated("exponentials", at_s, T, sd, f"time constants {taus}, {cooling.time.size} readings")


@dataclass(frozen=True)
class _Fitted:
    """score : corrected Akaike criterion;  at(t) -> value, sd"""

    taus: tuple[float, ...]
    score: float
    at: Callable[[float], tuple[float, float]]


def _fit(cooling: Cooling, terms: int) -> _Fitted | None:
    """Variable projection: the time constants by a bounded search, everything linear in closed form."""
    from scipy.optimize import least_squares

    t, T, n = cooling.time, cooling.T, cooling.time.size
    free = 1 + 2 * terms
    if n < free + 2:
        return None

    def basis(tau: Array, at: Array) -> Array:
        return np.column_stack([np.ones_like(at), *(np.exp(-at / s) for s in tau)])

    def left(log_tau: Array) -> Array:
        X = basis(np.exp(log_tau), t)
        return np.asarray(X @ np.linalg.lstsq(X, T, rcond=None)[0] - T)

    span = t[-1] - t[0]
    start = np.log([0.3 * span] if terms == 1 else [0.15 * span, 2.0 * span])
    low, high = np.log([span / 40.0] * terms), np.log([4.0 * span] if terms == 1 else [0.6 * span, 20.0 * span])
    solution = least_squares(left, start, bounds=(low, high))
    tau = np.exp(solution.x)
    coefficients = np.linalg.lstsq(basis(tau, t), T, rcond=None)[0]
    square = float(solution.fun @ solution.fun)
    scale = max(square / (n - free), cooling.reading_sd**2)

    def slopes(at: Array) -> Array:
        """Derivatives by coefficients and time constants' logarithms."""
        decays = [c * np.exp(-at / s) * at / s for c, s in zip(coefficients[1:], tau, strict=True)]
        return np.column_stack([basis(tau, at), *decays])

    covariance = scale * np.linalg.pinv(slopes(t).T @ slopes(t))

    def at(instant: float) -> tuple[float, float]:
        x = np.array([instant])
        g = slopes(x)[0]
        return float((basis(tau, x) @ coefficients)[0]), float(np.sqrt(g @ covariance @ g))

    floor = max(square / n, cooling.reading_sd**2 / 100.0)
    score = n * np.log(floor) + 2 * free + 2 * free * (free + 1) / max(n - free - 1, 1)
    return _Fitted(tuple(float(s) for s in tau), float(score), at)


def all_ways(cooling: Cooling, rated_kW: float) -> list[Extrapolated]:
    """The way IEC 60034-1 prescribes first, then every other way that these readings allow."""
    others: list[Callable[[Cooling], Extrapolated]] = [semilog_at, rule_150, exponentials]
    out = [semilog(cooling, rated_kW)]
    for way in others:
        with suppress(InputError):
            out.append(way(cooling))
    return out
