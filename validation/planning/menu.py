"""The engineer's menu of tests, each made from a test at hand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from validation.case import Test

Array = NDArray[np.float64]
OVERLOAD = 1.3  # of the root mean square current, for as long as a winding takes to follow
CURRENTS = ("current_A", "id_A", "iq_A", "rotor_A")
Inputs = dict[str, Array]


@dataclass(frozen=True)
class Experiment:
    """A change of a test's inputs and boundaries.

    needs : inputs without which it makes no sense;  hours : time on the bench, for which the test at hand is repeated
    """

    name: str
    change: Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]
    needs: tuple[str, ...] = ()
    hours: float = 4.0

    def made_from(self, test: Test) -> Test:
        """The planned test; its channels have no readings yet."""
        base = repeated(test, self.hours)
        inputs, boundaries = self.change(base.time, dict(base.inputs), dict(base.boundaries))  # type: ignore[arg-type]
        return replace(base, name=f"planned: {self.name}", inputs=inputs, boundaries=boundaries)


def repeated(test: Test, hours: float) -> Test:
    """A test driven again and again until the hours are over, once at least; nothing is read."""
    time = test.time - test.time[0]
    period = float(time[-1] + np.mean(np.diff(time)))
    n = max(time.size, round(3600.0 * hours / period * time.size))
    turn, at = np.divmod(np.arange(n), time.size)
    inputs = {k: np.asarray(v, float)[at] for k, v in test.inputs.items()}
    boundaries = {k: np.broadcast_to(np.asarray(v, float), time.shape)[at] for k, v in test.boundaries.items()}
    still = tuple(replace(c, y=np.zeros(n)) for c in test.channels)
    return replace(test, time=time[at] + period * turn, inputs=inputs, boundaries=boundaries, channels=still)


def _set(**levels: float | Callable[[Array], Array]) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    """Inputs held at a number, or given as a function of time; those the machine lacks are left out."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        new = {k: (v(time) if callable(v) else np.full_like(time, v)) for k, v in levels.items() if k in inputs}
        return {**inputs, **new}, boundaries

    return change


def _even(factor: float) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    """Currents held at a multiple of the root mean square of their records."""

    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        rms = {k: np.full_like(time, factor * np.sqrt(np.mean(v**2))) for k, v in inputs.items() if k in CURRENTS}
        return {**inputs, **rms}, boundaries

    return change


def _then(*changes: Callable) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        for one in changes:
            inputs, boundaries = one(time, inputs, boundaries)
        return inputs, boundaries

    return change


def _boundary_step(word: str, rise: float) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        late = time > 0.4 * time[-1]
        return inputs, {k: v + rise * late if word in k else v for k, v in boundaries.items()}

    return change


def _on_off(level: float, periods: int = 3) -> Callable[[Array], Array]:
    return lambda time: np.where((time * 2 * periods / (time[-1] + 1.0)).astype(int) % 2 == 0, level, 0.0)


def _half_time(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
    """Currents switched off midway."""
    early = time < 0.5 * time[-1]
    return {k: v * early if k in CURRENTS else v for k, v in inputs.items()}, boundaries


def _fast_and_slow(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
    """The highest speed of the record and a third of it in turn."""
    top = np.max(np.abs(inputs["speed_rpm"]))
    return {**inputs, "speed_rpm": top / 3.0 + _on_off(2.0 * top / 3.0, 2)(time)}, boundaries


def _half(scale: str) -> Callable[[Array, Inputs, Inputs], tuple[Inputs, Inputs]]:
    def change(time: Array, inputs: Inputs, boundaries: Inputs) -> tuple[Inputs, Inputs]:
        return {**inputs, scale: inputs[scale] * np.where(time > 0.5 * time[-1], 0.5, 1.0)}, boundaries

    return change


STILL = _set(speed_rpm=0.0, rotor_A=0.0)  # bars that stand still under direct current carry none
STANDING = _then(STILL, _set(vehicle_speed_mps=0.0))
IDLE = _set(**dict.fromkeys(CURRENTS, 0.0), torque_Nm=0.0, vehicle_speed_mps=0.0)
SPINNING = _then(IDLE, _set(speed_rpm=1000.0))
COOLING = _then(STILL, _set(vehicle_speed_mps=_on_off(12.0)))
BLOWN = _then(STILL, _set(vehicle_speed_mps=_on_off(8.0)))
TWO_SPEEDS = _set(speed_rpm=_on_off(1500.0, 2))
EVEN, HEAVY = _even(1.0), _even(OVERLOAD)
MENU = (
    Experiment("DC heating at standstill", _then(EVEN, STANDING), ("current_A",)),
    Experiment("spin without current", SPINNING, ("speed_rpm",)),
    Experiment("heating at standstill, then cooling down", _then(HEAVY, STANDING, _half_time), ("current_A",)),
    Experiment("no load, fast and slow", _then(IDLE, _fast_and_slow), ("speed_rpm",)),
    Experiment("same current at two speeds", _then(EVEN, TWO_SPEEDS), ("speed_rpm", "current_A")),
    Experiment("cool-down with wind on and off", COOLING, ("vehicle_speed_mps",)),
    Experiment("blower on the machine at standstill", _then(EVEN, BLOWN), ("vehicle_speed_mps", "current_A")),
    Experiment("fan flow halved midway", _half("fan_flow_m3h"), ("fan_flow_m3h",)),
    Experiment("ambient raised by 20 K", _boundary_step("ambient", 20.0), (), 8.0),
    Experiment("coolant inlet raised by 20 K", _boundary_step("coolant", 20.0), (), 4.0),
    Experiment("bench plate heated by 20 K", _boundary_step("bench", 20.0), (), 6.0),
)  # fmt: skip


def possible(test: Test) -> list[tuple[Experiment, Test]]:
    """Experiments that change something on this machine, and the tests made from the one at hand."""
    made = [(e, e.made_from(test)) for e in MENU if set(e.needs) <= set(test.inputs)]
    return [(e, new) for e, new in made if _differ(new, repeated(test, e.hours))]


def _differ(new: Test, old: Test) -> bool:
    pairs = [(new.inputs, old.inputs), (new.boundaries, old.boundaries)]
    return any(not np.array_equal(a[k], b[k]) for a, b in pairs for k in b)
