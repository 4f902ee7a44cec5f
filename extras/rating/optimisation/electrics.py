"""What a load takes: current and terminal voltage for a torque; a vehicle's cycle as an operating point.

The machine sees the cycle's mean square current and its mean speed for ever; what it warms and cools within a lap is
left out. Current and voltage are limited by the controller itself; what a design may lose by it is speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermoscope import InputError, plugin as th

CURRENT, SPEED = "current_A", "speed_rpm"


@dataclass(frozen=True)
class Electrics:
    """current_limit (A), voltage_limit (V): of the ratings;  brush_V : drop of the brushes;  series : of such a machine

    rated : (torque N m, current A) of a machine whose flux is constant: its torque goes with the current
    """

    current_limit: float | None = None
    voltage_limit: float | None = None
    brush_V: float = 0.0
    series: th.SeriesMachine | None = None
    rated: tuple[float, float] | None = None

    def current(self, torque: float) -> float:
        """A that a torque (N m) takes."""
        if self.series is not None:
            return float(self.series.current(torque))
        if self.rated is None:
            raise InputError(
                "nothing says what current a torque takes", "--torque", "[ratings] torque_Nm and current_A"
            )
        return torque / self.rated[0] * self.rated[1]

    def torque(self, current: float) -> float | None:
        """N m that a current gives, where it is known."""
        if self.series is not None:
            return float(self.series.torque(current))
        return None if self.rated is None else current / self.rated[1] * self.rated[0]

    def voltage(self, current: float, speed_rpm: float, copper_W: float) -> float | None:
        """V = w L_af i + P_copper / i + brushes, of a series machine."""
        if self.series is None or current == 0.0:
            return None
        return self.series.L_af * th.RPM * speed_rpm * current + copper_W / current + self.brush_V

    def excess(self, inputs: Mapping[str, float], copper_W: float) -> dict[str, float]:
        """Limit -> by which share it is exceeded; negative where it is kept."""
        out, i = {}, inputs.get(CURRENT, 0.0)
        if self.current_limit is not None and CURRENT in inputs:
            out[f"current <= {self.current_limit:g} A"] = i / self.current_limit - 1.0
        V = self.voltage(i, inputs.get(SPEED, 0.0), copper_W)
        if self.voltage_limit is not None and V is not None:
            out[f"voltage <= {self.voltage_limit:g} V"] = V / self.voltage_limit - 1.0
        return out


def electrics_of(series: bool, ratings: Mapping[str, float], losses: Mapping[str, float]) -> Electrics:
    """From the sections of a machine file, as far as they say it.  series : does the field carry the current?"""
    limits, brush = (ratings.get(CURRENT), ratings.get("voltage_V")), float(losses.get("brush_drop_V", 0.0))
    needed = ("power_W", SPEED, "voltage_V", CURRENT)
    if series and all(k in ratings for k in needed):
        return Electrics(*limits, brush, th.SeriesMachine.from_ratings(*(float(ratings[k]) for k in needed)))
    rated = (ratings["torque_Nm"], ratings[CURRENT]) if "torque_Nm" in ratings and CURRENT in ratings else None
    return Electrics(limits[0], None, 0.0, None, rated)


def wanted_inputs(inputs: Mapping[str, float], torque: float | None, electrics: Electrics) -> dict[str, float]:
    """Inputs with the current that a torque takes; as they are without one."""
    if torque is None:
        return dict(inputs)
    if CURRENT not in inputs:
        raise InputError("no law reads the current", "--torque", th.suggestion(CURRENT, tuple(inputs)))
    return {**inputs, CURRENT: electrics.current(torque)}


GAINS = {"controller.Kp": "Kp", "controller.Ki": "Ki"}  # keys of a cycle that a design may change
LAG = 0.05  # of the cycle's mean speed: what the vehicle may lack on average; it coasts where it is too fast


@dataclass(frozen=True)
class Driven:
    """machine, vehicle, controller : of the cycle;  time (nt,) s;  target_mps (nt,);  slope (nt,) rise over run

    warm : resistance over that of the machine, with the winding at its limit
    """

    machine: th.SeriesMachine
    vehicle: th.Vehicle
    controller: th.Controller
    time: th.Array
    target_mps: th.Array
    slope: th.Array
    warm: float = 1.0

    def at(self, degC: float, reference_degC: float) -> Driven:
        """With the winding at a temperature."""
        return replace(self, warm=1.0 + th.ALPHA_CU * (degC - reference_degC))

    def usual(self, key: str) -> float:
        return float(getattr(self.controller, GAINS[key]))

    def inputs(self, design: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
        """Inputs of a network at the gains of a design, and limit -> the share by which it is exceeded."""
        gains = {GAINS[key]: design[key] for key in GAINS if key in design}
        R = np.full(self.time.size, self.warm * self.machine.R)
        course = th.drive_cycle(
            self.machine,
            self.vehicle,
            replace(self.controller, **gains),
            self.time,
            self.target_mps,
            self.slope,
            resistance=R,
        )
        step = np.diff(self.time, prepend=self.time[0]) / (self.time[-1] - self.time[0])
        mean = {name: float(step @ u) for name, u in course.inputs().items()}
        mean["current_A"] = float(step @ course.current_A**2) ** 0.5
        short = float(step @ np.maximum(self.target_mps - course.vehicle_speed_mps, 0.0)) / float(
            step @ self.target_mps
        )
        return mean, {f"speed kept within {100.0 * LAG:g} %": short / LAG - 1.0}
