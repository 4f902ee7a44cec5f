"""The rise of a winding over its coolant by every method that was measured, each with its uncertainty and its verdict.

theta = (R2 - R1) / R1 (k + t1) + t1 - ta      k = 235 K for copper, 225 K for aluminium (IEC 60034-1, 8.6.2)
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from extras.bench.heat_run.limits import DETECTORS, RESISTANCE, STANDARDS, Rating, corrections
from extras.bench.measuring.protocol import Cold, Hot, cooling_of
from thermoscope import plugin as th

Verdict = Literal["passes", "fails", "cannot be judged", "not measured"]
K_OF = {"copper": 235.0, "aluminium": 225.0}  # minus the temperature (degC) at which the resistance would be none
SUPERPOSITION = "superposition"
OFF = ("current", "torque", "power", "voltage", "frequency", "speed", "vehicle_speed")  # gone when it is switched off
LEAST_K = 1e-6  # no way back is exact
SOON_S = 0.1  # after the last sample under load: the machine is off


@dataclass(frozen=True)
class Rise(th.TableRow):
    """Rise over the coolant by one method.  U95_K : expanded uncertainty;  at_s : what instant it stands for

    temperature_degC, rise_K, U95_K : None where it was not measured;  limit_K : None where there is none
    """

    properties = ("margin_K", "verdict")

    method: str
    at_s: float | None = None
    temperature_degC: float | None = None
    rise_K: float | None = None
    U95_K: float | None = None
    limit_K: float | None = None
    how: str = ""

    @property
    def margin_K(self) -> float | None:
        """What is left to the limit after the uncertainty; below zero, what the limit is exceeded by after it."""
        if self.rise_K is None or self.U95_K is None or self.limit_K is None:
            return None
        left = self.limit_K - self.rise_K
        return float(np.sign(left) * max(abs(left) - self.U95_K, 0.0))

    @property
    def verdict(self) -> Verdict:
        if self.rise_K is None or self.U95_K is None:
            return "not measured"
        if self.limit_K is None or abs(self.limit_K - self.rise_K) < self.U95_K:
            return "cannot be judged"
        return "passes" if self.rise_K <= self.limit_K else "fails"


def resistance_rise(R1: Any, R2: Any, t1: Any, ta: Any, k: float = K_OF["copper"]) -> Any:
    """Rise (K) over a coolant of ta of a winding of R1 at t1 cold, and R2 hot."""
    return (R2 - R1) / R1 * (k + t1) + t1 - ta


def resistance_rises(
    cold: Cold,
    hot: Hot,
    meter: th.Meter,
    k: float,
    thermometer_K: float,
    rating: Rating,
    more: Sequence[th.Extrapolated],
) -> list[Rise]:
    """By resistance, for every way back to switching off; `more` are ways besides those of the readings alone."""
    limit = corrections(rating, RESISTANCE)[-1].limit_K
    if not hot.cooling:
        return [Rise(RESISTANCE, limit_K=limit)]
    first, *others = th.all_ways(cooling_of(winding_of(cold, meter, k), hot), rating.rated_kW)
    ways = [replace(first, method=STANDARDS[0]), *others, *more]
    rises = [_rise_of(way, cold, hot.ambient_C, meter, k, thermometer_K) for way in ways]
    return [replace(rise, limit_K=limit) for rise in rises]


def winding_of(cold: Cold, meter: th.Meter, k: float) -> th.Winding:
    """The winding with the standard's k as coefficient, which holds at any temperature."""
    return th.Winding(cold.ohm, cold.machine_C, meter, th.Reading("k", 1.0 / (k + 20.0), 0.0), reference_C=20.0)


def _rise_of(way: th.Extrapolated, cold: Cold, coolant: float, meter: th.Meter, k: float, thermometer_K: float) -> Rise:
    """With the errors of both resistances, both thermometers and the way back to switching off."""
    ohm = cold.ohm * (k + way.value) / (k + cold.machine_C)

    def result(R1: Any, R2: Any, t1: Any, ta: Any, back: Any) -> Any:
        return resistance_rise(R1, R2, t1, ta, k) + back

    readings = (
        meter.reading("cold resistance", cold.ohm),
        meter.reading("hot resistance", ohm),
        th.Reading("cold temperature", cold.machine_C, thermometer_K),
        th.Reading("coolant", coolant, thermometer_K),
        th.Reading("way back to switching off", 0.0, max(way.sd, LEAST_K), "normal"),
    )
    total = th.propagate(result, readings)
    method = f"{RESISTANCE}, {way.method}"
    return Rise(method, way.at_s, way.value, total.value, _expanded(total), None, way.words)


def detector_rise(hottest: th.Reading | None, coolant: float, thermometer_K: float, rating: Rating) -> Rise:
    """By embedded temperature detectors: the hottest of them."""
    limit = corrections(rating, DETECTORS)[-1].limit_K
    if hottest is None:
        return Rise(DETECTORS, limit_K=limit)
    total = th.propagate(lambda T, ta: T - ta, (hottest, th.Reading("coolant", coolant, thermometer_K)))
    how = "hottest detector at the end"
    return Rise(DETECTORS, None, hottest.value, total.value, _expanded(total), limit, how)


def superposed_rise(parts: Iterable[tuple[str, int, float, float]], rating: Rating) -> Rise:
    """Equivalent loading (IEC 60034-29): rises of part tests added; what both contain is measured once and taken off.

    parts : (name, +1 or -1, rise K, standard uncertainty K)
    """
    rows, limit = list(parts), corrections(rating, RESISTANCE)[-1].limit_K
    if not rows:
        return Rise(SUPERPOSITION, limit_K=limit)
    value, sd = sum(sign * rise for _, sign, rise, _ in rows), float(np.linalg.norm([u for *_, u in rows]))
    how = " ".join(f"{'+' if sign > 0 else '-'} {name} {rise:g} K" for name, sign, rise, _ in rows)
    return Rise(SUPERPOSITION, None, None, value, th.NORMAL_95 * sd, limit, how)


def _expanded(total: th.PropagatedUncertainty) -> float:
    return th.NORMAL_95 * total.sd


def deciding(rises: Sequence[Rise], standard: str) -> Rise:
    """The rise that the standard judges by: by its own delays, else fitted back to the instant of switching off."""
    measured = [r for r in rises if r.rise_K is not None]
    first = STANDARDS[0] if standard == STANDARDS[0] else "exponentials"
    order = (f"{RESISTANCE}, {first}", f"{RESISTANCE}, semi-logarithmic", SUPERPOSITION, DETECTORS)
    return next((r for name in order for r in measured if r.method == name), rises[0])


def network_way(
    case: th.MeasuredCase, test: th.Test, place: str, cold: Cold, hot: Hot, winding: th.Winding
) -> th.Extrapolated:
    """Back to switching off along the curve of the case's network, shifted and scaled to the readings."""
    cooling = cooling_of(winding, hot)
    curve = network_cooling(case, test, place, cooling.time)
    start, rest = curve[0], curve[1:]
    X = np.column_stack([np.ones_like(rest), rest])
    weights, *_ = np.linalg.lstsq(X, cooling.T, rcond=None)
    left = cooling.T - X @ weights
    scale = max(float(left @ left) / max(left.size - 2, 1), cooling.reading_sd**2)
    x = np.array([1.0, start])
    sd = float(np.sqrt(scale * x @ np.linalg.pinv(X.T @ X) @ x))
    words = f"curve of the network times {weights[1]:.2f}, off by {np.sqrt(np.mean(left**2)):.2f} K rms"
    return th.Extrapolated(f"network of {case.name}", 0.0, float(x @ weights), sd, words)


def network_cooling(case: th.MeasuredCase, test: th.Test, place: str, seconds: th.Array) -> th.Array:
    """Temperature (degC) of a place when the test ends, and so many seconds after it was switched off.

    What carries no load, such as a pump, goes on as it was at the end of the test.
    """
    network, values = th.standing(case), th.physical(case)
    gone = {network.signal(quantity) for quantity in OFF}
    later = np.concatenate([[SOON_S], np.maximum(seconds, 2 * SOON_S)])
    inputs = {n: np.append(u, np.full(later.size, 0.0 if n in gone else u[-1])) for n, u in test.inputs.items()}
    air = {n: np.append(u, np.full(later.size, u[-1])) for n, u in test.boundaries.items()}
    time = np.append(test.time, test.time[-1] + later)
    channel = next(c for c in test.channels if c.place == place)
    channel = replace(channel, y=np.full(time.size, np.nan), lag_s=0.0)
    run = replace(test, time=time, inputs=inputs, boundaries=air, channels=(channel,), recorded=None, blocks=None)
    y = th.predict(network, run, values).y[test.time.size - 1 :, 0]
    return np.append(y[0], y[2:])
