"""What moves coolant and air costs: pressure along their ways times flow over the efficiency of pump or fan."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from thermoscope import plugin as th

EFFICIENCY = (
    0.5  # of pump or fan with its motor: small wet-rotor pumps and axial fans reach 0.4 to 0.6, also on a shaft
)
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
    drops = [
        sum(_drop(machine, j, cooling.share(j) * flow, cooling) for j in (end, *cooling.before(end)) if j != th.INLET)
        for end in ends
    ]
    return th.pumping_power(max(drops, default=0.0), flow, EFFICIENCY)


def _drop(machine: th.MachineDescription, jacket: str, flow: float, cooling: th.Cooling) -> float:
    return th.pressure_drop(way_of(machine, jacket), flow, cooling.liquid) if flow > 0.0 else 0.0


def way_of(machine: th.MachineDescription, jacket: str) -> Way:
    """Axial channels joined by two bends of 90 degrees each, or the turns of a helix."""
    channel, prisms = th.channel_of(machine, jacket), machine.part(jacket).prisms
    if prisms[0][0].holes:
        turns = sum(bool(profile.holes) for profile, _, _ in prisms)
        return Way(channel.area, channel.diameter, turns * channel.length, 0, channel.coil)
    spans = [(z0, z1) for _, z0, z1 in prisms]
    number, (first, last) = max(spans.count(s) for s in spans), machine.part(jacket).span
    return Way(channel.area, channel.diameter, number * (last - first), 2 * (number - 1), 0.0)
