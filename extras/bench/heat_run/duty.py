"""Whether the run was the duty it is rated for: steady state found in the record, cycles, equivalent load."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from extras.bench.heat_run.limits import GRADIENT_K_H
from extras.bench.measuring.warming import equilibrium, fit_eq8, spaced_window
from thermoscope import InputError, plugin as th

DUTIES = tuple(f"S{n}" for n in range(1, 11))
CYCLIC, BY_LOAD = ("S3", "S4", "S5", "S6", "S7", "S8"), ("S9", "S10")
HALF_HOUR = 30.0  # min
START_K = 5.0  # of the coolant: how cold a machine is when a short-time run begins
LOAD_SHARE = 0.01  # by which a test's load may differ from the equivalent one
POWER_MIN, POWER_SHARE = 30.0, 0.05  # UNECE R85: 30 minutes, within 5 % of the power at the start
Series = Sequence[tuple[float, float]]


@dataclass(frozen=True)
class Operation:
    """A duty as declared.  rated_min : of S2;  cycle_min : of S3 to S8

    loads : (minutes or share, load) of S9 and S10;  test_load : at which the heat run stood, both in one unit
    """

    name: str = "S1"
    rated_min: float = 0.0
    cycle_min: float = 0.0
    loads: tuple[tuple[float, float], ...] = ()
    test_load: float = 0.0


@dataclass(frozen=True)
class Duty:
    """steady_min : when steady state began;  drift_K_h : at the end;  tau95_min, rest_K : by eq. 8, where it fits

    missing : why the run is not that duty, "" where it is;  milder : the duty itself would be hotter than the run
    """

    name: str
    minutes: float | None = None
    steady_min: float | None = None
    drift_K_h: float | None = None
    tau95_min: float | None = None
    rest_K: float | None = None
    equivalent_load: float | None = None
    missing: str = ""
    milder: bool = True
    words: str = ""


def duty_of(operation: Operation, warming: Series, coolant_C: float) -> Duty:
    """What the record of temperature under load, (min, degC), says of a duty."""
    name = operation.name
    if len(warming) < 4:
        return Duty(name, missing="no temperature was logged under load", milder=False)
    minutes, T = np.array(warming, float).T
    if name == "S2":
        return _short_time(operation, minutes, T, coolant_C)
    if name in CYCLIC:
        return _cycles(operation, minutes, T)
    steady = _steady(name, minutes, T, spaced_window(minutes, HALF_HOUR))
    if name not in BY_LOAD:
        return steady
    load, level = equivalent_load(operation.loads), operation.test_load
    words = f"run at load {level:g}, the equivalent load is {load:.3g}"
    missing = steady.missing or (words if abs(level / load - 1.0) > LOAD_SHARE else "")
    milder = level < (1.0 + LOAD_SHARE) * load
    return replace(steady, equivalent_load=load, missing=missing, milder=milder, words=words)


def equivalent_load(loads: Series) -> float:
    """The constant load of the same mean copper loss: root mean square over time."""
    weights, levels = np.array(loads, float).T
    return float(np.sqrt(weights @ levels**2 / weights.sum()))


def _steady(name: str, minutes: th.Array, T: th.Array, window: float) -> Duty:
    """Steady since the change over every window stayed within the gradient of the standard, two windows at least."""
    duty = Duty(name, float(minutes[-1]))
    try:
        end = equilibrium(minutes, T, GRADIENT_K_H / 60.0 * window, window)
    except InputError as fault:
        return replace(duty, missing=f"{fault.what}: {fault.right} is needed")
    knots = np.interp(minutes[-1] - window * np.array([2.0, 1.0, 0.0]), minutes, T)
    before, drift = 60.0 / window * np.diff(knots)
    tau, rest = _outlook(minutes, T)
    if end.reached:
        words = f"steady since {end.from_min:.0f} min"
        return replace(duty, steady_min=end.from_min, drift_K_h=drift, tau95_min=tau, words=words)
    worst = max(before, drift, key=abs)
    missing = f"not steady: {worst:+.1f} K/h within the last {2 * window:.0f} min, {GRADIENT_K_H:g} K/h are allowed"
    return replace(duty, drift_K_h=drift, tau95_min=tau, rest_K=rest, missing=missing)


def _outlook(minutes: th.Array, T: th.Array) -> tuple[float | None, float | None]:
    """When 95 % of the rise is done (min), and what is still to come (K), by eq. 8; None where it does not fit."""
    try:
        curve = fit_eq8(minutes, T)
    except (InputError, RuntimeError):
        return None, None
    return (curve.rise_min(), curve.a - float(T[-1])) if curve.b < 0 and curve.c < 0 else (None, None)


def _cycles(operation: Operation, minutes: th.Array, T: th.Array) -> Duty:
    """The points of successive cycles at which the last one is hottest, as a curve that has to be steady."""
    last = minutes > minutes[-1] - operation.cycle_min
    hottest = float(minutes[last][np.argmax(T[last])])
    points = np.arange(hottest, minutes[0] - 1e-9, -operation.cycle_min)[::-1]
    steady = _steady(operation.name, points, np.interp(points, minutes, T), max(HALF_HOUR, operation.cycle_min))
    swing, below = float(np.ptp(T[last])), float(T[last].max() - T[-1])
    words = f"{points.size} cycles, {swing:.1f} K from valley to peak; switched off {below:.1f} K below the peak"
    return replace(steady, minutes=float(minutes[-1]), tau95_min=None, rest_K=None, words=words)


def _short_time(operation: Operation, minutes: th.Array, T: th.Array, coolant_C: float) -> Duty:
    run, rated = float(minutes[-1] - minutes[0]), operation.rated_min
    start = abs(float(T[0]) - coolant_C)
    missing = f"run for {run:.1f} min of {rated:g} min" if run < rated - 1e-6 else ""
    if start > START_K:
        missing = f"started {start:.1f} K off the coolant; {START_K:g} K are allowed"
    milder = run < rated and start <= START_K
    return Duty("S2", run, missing=missing, milder=milder, words=f"run for {run:.0f} min, rated {rated:g} min")


def power_30_minutes(power: Series) -> dict[str, Any]:
    """Mean power (kW) of 30 minutes and whether it stayed within 5 % of its start.  power : (s, kW)"""
    seconds, kW = np.array(power, float).T
    start = seconds[0] + 60.0 * POWER_MIN
    if seconds[-1] < start - 1e-6:
        right = f"{POWER_MIN:g} min"
        raise InputError(f"{(seconds[-1] - seconds[0]) / 60.0:.1f} min of power", "[power_30min]", right)
    if kW.min() <= 0:
        raise InputError(f"{kW.min():g} kW", "[power_30min]", "powers above 0")
    within = seconds <= start + 1e-6
    mean = float(np.trapezoid(kW[within], seconds[within]) / np.ptp(seconds[within]))
    off = float(np.max(np.abs(kW[within] / kW[0] - 1.0)))
    return {"power_kW": mean, "largest_change_percent": 100.0 * off, "valid": off <= POWER_SHARE}
