"""What to measure when, and what a record of it lacks or has wrong.

A record that would give a wrong temperature is refused, step by step; one that is only incomplete says what comes next.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from extras.bench.measuring.warming import equilibrium, spaced_window
from thermoscope import InputError, plugin as th

State = Literal["done", "to do", "refused", "doubtful"]
ROOM_K = 1.0  # the machine counts as cold within this of the room
WAIT_H = 12.0  # usual time after a run until it is
SPEED_SHARE = 0.005  # of the speed; as much of a back-EMF is 5 K of a NdFeB magnet (-0.1 %/K)
DRIFT_K_H = 2.0  # IEC 60034-1: less than 1 K per half hour
INTERVAL_S, SPAN_S = 20.0, 300.0  # s; every 15 s for 5 min is asked for


@dataclass(frozen=True)
class Cold:
    """Before anything is switched on. range_high: upper end of the ohmmeter's range (None: it chose)."""

    room_C: float
    machine_C: float
    ohm: float
    volt: float | None = None
    rpm: float | None = None
    range_high: float | None = None
    hours_since_run: float | None = None


@dataclass(frozen=True)
class Hot:
    """At the end. cooling: ((s after switching off, ohm), ...); volt at rpm; ambient degC."""

    ambient_C: float
    cooling: tuple[tuple[float, float], ...] = ()
    volt: float | None = None
    rpm: float | None = None
    range_high: float | None = None


@dataclass(frozen=True)
class Record:
    """A test as far as it has come. warming: ((min, degC), ...) of any sensor, e.g. on the laminations."""

    rated_kW: float
    cold: Cold | None = None
    warming: tuple[tuple[float, float], ...] = ()
    resolution_K: float = 0.5
    hot: Hot | None = None
    ohmmeter: th.Meter = th.OHMMETER
    voltmeter: th.Meter = th.VOLTMETER
    beta: th.Reading = th.COPPER
    alpha: th.Reading = th.NDFEB
    curve: th.Saturation | None = None


@dataclass(frozen=True)
class Step(th.TableRow):
    """One thing to do: what, when, why, and how the record stands to it."""

    name: str
    when: str
    what: str
    state: State = "to do"
    words: str = ""


@dataclass(frozen=True)
class Protocol:
    """All steps, and the temperatures if none is refused.

    winding, magnets : rise (K) over the cold temperature with its three uncertainties;  ways : back to switching off
    """

    steps: tuple[Step, ...]
    winding: th.PropagatedUncertainty | None = None
    magnets: th.PropagatedUncertainty | None = None
    ways: tuple[th.Extrapolated, ...] = ()
    temperatures: Mapping[str, float] = field(default_factory=dict)

    @property
    def refused(self) -> tuple[Step, ...]:
        return tuple(s for s in self.steps if s.state == "refused")

    @property
    def complete(self) -> bool:
        return all(s.state in ("done", "doubtful") for s in self.steps)

    def document(self) -> dict[str, Any]:
        return {
            "steps": [s.document() for s in self.steps],
            "complete": self.complete,
            "winding_rise_K": self.winding and self.winding.document(),
            "magnet_rise_K": self.magnets and self.magnets.document(),
            "switch_off": [w.document() for w in self.ways],
            "temperatures_degC": dict(self.temperatures),
        }


Check = Callable[[Record], tuple[State, str]]


def protocol(record: Record) -> Protocol:
    """The guided procedure for a record, complete or not."""
    steps = checked_steps(record)
    if any(s.state == "refused" for s in steps) or record.cold is None or record.hot is None:
        return Protocol(steps)
    return _result(record, record.cold, record.hot, steps)


def checked_steps(record: Record) -> tuple[Step, ...]:
    """Every step, and how the record stands to it."""
    return tuple(Step(name, when, what, *check(record)) for name, when, what, check in STEPS)


def _result(record: Record, cold: Cold, hot: Hot, steps: tuple[Step, ...]) -> Protocol:
    winding = magnets = None
    ways: tuple[th.Extrapolated, ...] = ()
    temperatures: dict[str, float] = {}
    if hot.cooling:
        source = th.Winding(cold.ohm, cold.machine_C, record.ohmmeter, record.beta)
        ways = tuple(th.all_ways(cooling_of(source, hot), record.rated_kW))
        temperatures = {f"winding, {w.method}": w.value for w in ways}
        best = min(ways[1:], key=lambda w: (w.method != "exponentials", w.method), default=ways[0])
        # The resistance (ohm) that belongs to a temperature (degC): the law is a straight line
        per_ohm = source.temperature(source.cold_ohm + 1.0) - source.cold_C
        winding = source.rise(source.cold_ohm + (best.value - source.cold_C) / per_ohm)
    if hot.volt is not None and hot.rpm and cold.volt is not None and cold.rpm:
        pm = th.Magnets(cold.volt, cold.machine_C, cold.rpm, record.voltmeter, record.alpha, record.curve)
        magnets = pm.rise(hot.volt, hot.rpm)
        temperatures["magnets"] = float(pm.temperature(hot.volt, hot.rpm))
    return Protocol(steps, winding, magnets, ways, temperatures)


def cooling_of(winding: th.Winding, hot: Hot) -> th.CoolingCurve:
    """Readings after switching off as temperatures."""
    t, ohm = np.array(hot.cooling, float).T
    return th.CoolingCurve(t, winding.temperature(ohm), hot.ambient_C, winding.reading_sd(float(np.median(ohm))))


def _room(record: Record) -> tuple[State, str]:
    if record.cold is None:
        return "to do", ""
    off, hours = record.cold.machine_C - record.cold.room_C, record.cold.hours_since_run
    if abs(off) > ROOM_K:
        return "refused", f"the machine is {off:+.1f} K off the room; wait until it is within {ROOM_K:g} K"
    if hours is not None and hours < WAIT_H:
        return "doubtful", f"{hours:g} h after the last run; {WAIT_H:g} h are usual until the inside is cold too"
    return "done", f"machine {record.cold.machine_C:.1f} degC, room {record.cold.room_C:.1f} degC"


def _guarded(look: Callable[[], str]) -> tuple[State, str]:
    """A check whose InputError is a refusal."""
    try:
        return "done", look()
    except InputError as fault:
        return "refused", f"{fault.what}; {fault.right}"


def _cold_ohm(record: Record) -> tuple[State, str]:
    cold = record.cold
    if cold is None:
        return "to do", ""
    return _guarded(lambda: _range_words(record.ohmmeter, cold.ohm, cold.range_high, "cold resistance"))


def _range_words(meter: th.Meter, value: float, high: float | None, where: str) -> str:
    limit = meter.chosen(value, high, where).limit(value)
    return f"{value:g} {meter.unit} +- {limit:.3g} {meter.unit}"


def _cold_emf(record: Record) -> tuple[State, str]:
    cold = record.cold
    if cold is None or cold.volt is None:
        return "to do", ""
    if not cold.rpm:
        return "refused", "the speed of the cold back-EMF is missing"
    return _guarded(lambda: _range_words(record.voltmeter, cold.volt or 0.0, None, "cold back-EMF"))


def _steady(record: Record) -> tuple[State, str]:
    if not record.warming:
        return "to do", ""
    minutes, T = np.array(record.warming, float).T
    if minutes.size < 4 or minutes[-1] < 60.0:
        return "refused", f"{minutes[-1]:g} min recorded; go on for an hour at least"
    end = equilibrium(minutes, T, record.resolution_K, spaced_window(minutes))
    if abs(end.drift_K_h) > DRIFT_K_H or not end.reached:
        return "refused", f"still {end.drift_K_h:+.1f} K/h; go on until no two readings 10 min apart differ"
    return "done", f"steady at {end.T_e:.1f} degC since {end.from_min:.0f} min, {end.drift_K_h:+.1f} K/h"


def _hot_ohm(record: Record) -> tuple[State, str]:
    hot, cold = record.hot, record.cold
    if hot is None or not hot.cooling:
        return "to do", ""
    times = [t for t, _ in hot.cooling]
    limit = th.allowed_delay(record.rated_kW)
    if times[0] > 2 * limit:
        return "refused", f"first reading after {times[0]:g} s; {2 * limit:g} s is the latest at {record.rated_kW:g} kW"
    if cold is not None and hot.cooling[0][1] <= cold.ohm:
        return "refused", f"{hot.cooling[0][1]:g} ohm is not above the cold {cold.ohm:g} ohm"
    outcome = _guarded(lambda: _range_words(record.ohmmeter, hot.cooling[0][1], hot.range_high, "hot resistance"))
    if outcome[0] == "refused":
        return outcome
    if len(times) < 4 or times[-1] < SPAN_S * 0.8 or max(np.diff(times)) > INTERVAL_S:
        words = f"{len(times)} readings to {times[-1]:g} s; every 15 s for 5 min let the fits judge themselves"
        return "doubtful", words
    return "done", f"first after {times[0]:g} s, {len(times)} readings to {times[-1]:g} s"


def _hot_emf(record: Record) -> tuple[State, str]:
    hot, cold = record.hot, record.cold
    if hot is None or hot.volt is None:
        return "to do", ""
    if not hot.rpm or cold is None or cold.volt is None or not cold.rpm:
        return "refused", "a back-EMF needs its speed, and a cold back-EMF with its speed"
    if abs(hot.rpm / cold.rpm - 1.0) > SPEED_SHARE:
        return "doubtful", f"read at {hot.rpm:g} rpm, cold at {cold.rpm:g} rpm: scaled with the speed"
    if hot.volt >= cold.volt * hot.rpm / cold.rpm:
        return "refused", f"{hot.volt:g} V is not below the cold {cold.volt:g} V"
    return _guarded(lambda: _range_words(record.voltmeter, hot.volt or 0.0, None, "back-EMF"))


STEPS: tuple[tuple[str, str, str, Check], ...] = (
    ("room temperature", "before connecting the motor", "machine and room within 1 K of each other", _room),
    ("cold resistance", "before connecting the motor", "winding, on the finest range that holds it", _cold_ohm),
    ("cold back-EMF", "before connecting the motor", "driven at rated speed, open circuit; note the speed", _cold_emf),
    (
        "constant load",
        "until nothing changes",
        "RMS torque at rated speed, or a direct current; log a temperature",
        _steady,
    ),
    ("hot resistance", "at once after switching off", "every 15 s for 5 min, the first within 30 s", _hot_ohm),
    ("hot back-EMF", "after the resistances", "at the cold speed: magnets keep their heat for 15 min", _hot_emf),
)
