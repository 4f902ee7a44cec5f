"""What a load and its cooling take: current and voltage for a torque, a vehicle's cycle, power of pump and fans.

The machine sees the cycle's mean square current and its mean speed for ever; what it warms and cools within a lap is
left out. Current and voltage are limited by the controller itself; what a design may lose by it is speed. What moves
coolant and air costs pressure along their ways times flow over the efficiency of pump or fan.
"""

import math
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
            right = "[ratings] torque_Nm and current_A"
            raise InputError("nothing says what current a torque takes", "--torque", right)
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

    def at(self, degC: float, reference_degC: float) -> "Driven":
        """With the winding at a temperature."""
        return replace(self, warm=1.0 + th.ALPHA_CU * (degC - reference_degC))

    def usual(self, key: str) -> float:
        return float(getattr(self.controller, GAINS[key]))

    def inputs(self, design: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
        """Inputs of a network at the gains of a design, and limit -> the share by which it is exceeded."""
        gains = {GAINS[key]: design[key] for key in GAINS if key in design}
        R = np.full(self.time.size, self.warm * self.machine.R)
        drive = (self.machine, self.vehicle, replace(self.controller, **gains))
        course = th.drive_cycle(*drive, self.time, self.target_mps, self.slope, resistance=R)
        step = np.diff(self.time, prepend=self.time[0]) / (self.time[-1] - self.time[0])
        mean = {name: float(step @ u) for name, u in course.inputs().items()}
        mean["current_A"] = float(step @ course.current_A**2) ** 0.5
        lacking = np.maximum(self.target_mps - course.vehicle_speed_mps, 0.0)
        short = float(step @ lacking) / float(step @ self.target_mps)
        return mean, {f"speed kept within {100.0 * LAG:g} %": short / LAG - 1.0}


# Of pump or fan with its motor: small wet-rotor pumps and axial fans reach 0.4 to 0.6, also on a shaft
EFFICIENCY = 0.5
FAN = "fan_flow_m3h"


@dataclass(frozen=True)
class Way:
    """What pressure needs to know: all channels of a jacket one after the other, or all between fins side by side."""

    section: float
    diameter: float
    length: float
    bends: int
    coil: float


def auxiliary_power(machine: th.MachineDescription, inputs: Mapping[str, float], ambient_C: float = 20.0) -> float:
    """Power (W) of the coolant's pump and of fans at an operating point; a fan on the shaft moves air of ambient_C."""
    around = th.surroundings(machine, ())
    out = 0.0 if around.cooling is None else _pump(machine, around.cooling, inputs[th.FLOW] * th.L_MIN)
    ducts = machine.features.ducts
    if around.ways is not None and ducts and inputs[FAN] > 0.0:
        flow, (way, duct) = inputs[FAN] * th.M3_H, next(iter(ducts.items()))  # all ways drop the same pressure
        inside = th.air(around.ways.fan.air_C)
        drop = th.pressure_drop(duct, around.ways.share(way, inputs[FAN], inside) * flow, inside)
        out += th.pumping_power(drop, flow, EFFICIENCY)
    cowl, fins = th.cowl_of(machine), th.fins_of(machine)
    if cowl is not None and fins is not None:
        out += _shaft_fan(cowl, fins, abs(inputs.get("speed_rpm", 0.0)), ambient_C)
    return out


def _shaft_fan(cowl: th.Cowl, fins: th.Fins, rpm: float, ambient_C: float) -> float:
    """Of the air between all fins, as it leaves the cowl: more, higher or thinner fins let more air through.

    Along the fins it slows down in a straight line to `end_share`; friction goes with the mean of its square.
    """
    s, length = cowl.end_share, fins.length if fins.axial else math.pi * (fins.root + fins.height)
    section = fins.number * fins.spacing * fins.height
    way = Way(section, fins.hydraulic_diameter, length * (1.0 + s + s * s) / 3.0, 0, 0.0)
    flow = cowl.air_speed * rpm / cowl.at_rpm * section
    return th.pumping_power(th.pressure_drop(way, flow, th.air(ambient_C)), flow, EFFICIENCY)


def _pump(machine: th.MachineDescription, cooling: th.Cooling, flow: float) -> float:
    """flow (m3/s): jackets that the inlet feeds lie side by side, those that another feeds one after the other."""
    ends = [j for j in cooling.feeds if j not in cooling.feeds.values()]

    def drop(jacket: str) -> float:
        mine = cooling.share(jacket) * flow
        return th.pressure_drop(way_of(machine, jacket), mine, cooling.liquid) if mine > 0.0 else 0.0

    drops = [sum(drop(j) for j in (end, *cooling.before(end)) if j != th.INLET) for end in ends]
    return th.pumping_power(max(drops, default=0.0), flow, EFFICIENCY)


def way_of(machine: th.MachineDescription, jacket: str) -> Way:
    """Axial channels joined by two bends of 90 degrees each, or the turns of a helix."""
    channel, prisms = th.channel_of(machine, jacket), machine.part(jacket).prisms
    if prisms[0][0].holes:
        turns = sum(bool(profile.holes) for profile, _, _ in prisms)
        return Way(channel.area, channel.diameter, turns * channel.length, 0, channel.coil)
    spans = [(z0, z1) for _, z0, z1 in prisms]
    number, (first, last) = max(spans.count(s) for s in spans), machine.part(jacket).span
    return Way(channel.area, channel.diameter, number * (last - first), 2 * (number - 1), 0.0)
