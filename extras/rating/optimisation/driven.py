"""A vehicle's cycle as an operating point: what its controller makes of it, over and over.

The machine sees the cycle's mean square current and its mean speed for ever; what it warms and cools within a lap is
left out. Current and voltage are limited by the controller itself; what a design may lose by it is speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermoscope import plugin as th

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
