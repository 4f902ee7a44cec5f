"""The air inside: a fan's stream through the machine, and what the walls it passes feel of it and of the rotor.

    ambient -> [space of the fan] -> left end -> gap, space between the poles, ducts of the rotor -> right end -> out

The gap takes the share that [fans] gives it. The rest divides so that all ways drop the same pressure between the two
ends: friction, entrance and exit of each. The air in a duct of the rotor is spun up at the shaft's cost: the dynamic
pressure of its turning, as it comes in relative to the duct, is taken as lost at the inlet, neither more nor less.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from geom.constants import M3_H, RPM
from geom.description.geometry import Duct, Features
from geom.description.machine import Machine
from lumped.circuits.hydraulics import parallel_shares
from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.end_space import end_space
from lumped.correlations.info import Info
from lumped.correlations.streams import streamed
from lumped.machine.settings import Fan, Films
from lumped.machine.shapes import Gap, gap_fluid
from lumped.model.network import Link, Network, Row
from lumped.transfer.laws import Array, InputPower, Inputs, Law, Table
from lumped.transfer.properties import Fluid, air
from lumped.transfer.reversal import OneWay

GAP_C, DUCT_C = 80.0, 40.0  # usual film temperatures, at which ranges are checked
INTAKE_C = tuple(float(T) for T in range(-60, 101, 10))  # of a fan; rho cp is straight between two to 0.03 %


def fan_shares(machine: Machine, fan: Fan) -> dict[str, float]:
    """What each way along the axis takes of the fan's air at its rated flow; together 1."""
    ducts, gap = machine.features.ducts, gap_fluid(machine)
    if not ducts:
        return {gap: 1.0}
    beside = 1.0 - fan.gap_share
    split = parallel_shares([[duct] for duct in ducts.values()], beside * fan.flow_m3_h * M3_H, air(fan.air_C))
    shares = {gap: fan.gap_share, **{name: beside * share for name, share in zip(ducts, split, strict=True)}}
    return {name: share for name, share in shares.items() if share > 0.0}


def stirred(share: float, films: Films, radius: float) -> Law:
    """Walls of air that a rotor of this radius (m) stirs; `share` of its tip speed passes the wall."""
    return Stirred(films.end_space_k1_W_m2K, films.end_space_k2, films.end_space_k3, share * RPM * radius)


@dataclass(frozen=True)
class Stirred(Law):
    """k1 (1 + k2 v^k3) (W/m2/K) of the speed v (m/s) past a wall, per_rpm (m/s) times the shaft's."""

    k1: float
    k2: float
    k3: float
    per_rpm: float
    reads = ("speed_rpm",)

    def factor(self, inputs: Inputs) -> Array:
        v = self.per_rpm * np.asarray(inputs["speed_rpm"], float)
        return np.asarray(end_space(v, self.k1, self.k2, self.k3)[0])


def gap_film(gap: Gap, usual_rpm: float) -> Law:
    """One wall of the air gap."""

    def film(rpm: float, fluid: Fluid) -> tuple[float, Info]:
        return taylor_film(rpm * RPM, gap.rotor_radius, gap.width, fluid)

    return streamed("speed_rpm", usual_rpm, film, air, GAP_C, liquid=False)


def channel_film(duct: Duct, share: float, usual: float) -> Law:
    """Walls along the axis that `share` of the fan's air passes; a turning duct is taken to stand still.

    usual : flow (m3/h)
    """

    def film(flow: float, fluid: Fluid) -> tuple[float, Info]:
        return duct_film(share * flow * M3_H / duct.section, duct.diameter, duct.length, fluid)

    return streamed("fan_flow_m3h", usual, film, air, DUCT_C, liquid=False)


def fan_streams(network: Network, features: Features, shares: Mapping[str, float], usual: float) -> list[Link]:
    """The fan's air, cell by cell; shares : way along the axis -> its part of the flow;  usual : flow (m3/h)."""
    (left, right), inlet = features.ends, {features.fan_space: {"ambient": 1.0}} if features.fan_space else {}
    feeds = {
        **inlet,
        left: dict.fromkeys(inlet or ("ambient",), 1.0),
        **{way: {left: share} for way, share in shares.items()},
        right: dict(shares),
    }
    way = "a flow from left to right: what comes in at the right is not known"
    rate = InputPower(M3_H, (("fan_flow_m3h", 1.0, 1.0),), heat_of_air())
    law = OneWay(rate, "fan_flow_m3h", "[fans]", way, usual)
    return [_cell(network, cell, upstream, law) for cell, upstream in feeds.items()]


@cache
def heat_of_air() -> Table:
    """rho cp (J/m3/K) of what a fan takes in, at its own temperature: a fan moves a volume."""
    return Table(INTAKE_C, tuple(air(T).rho * air(T).cp for T in INTAKE_C))


def _cell(network: Network, cell: str, upstream: Mapping[str, float], law: Law) -> Link:
    """An upwind cell: it takes up flow x heat capacity x (own temperature - what flows in)."""
    column = network.column(cell)
    cols = np.array([column, *(network.column(name) for name in upstream)])
    vals = np.array([sum(upstream.values()), *(-share for share in upstream.values())])
    rows, first = np.full(len(cols), column), next(iter(upstream))
    intake, nothing = Row(np.array([network.column("ambient")]), np.ones(1)), Row(np.empty(0, np.int64), np.empty(0))
    return Link(f"stream:fan:{cell}", "stream", (first, cell), rows, cols, vals, law, intake, nothing)
