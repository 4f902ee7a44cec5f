"""The air inside: a fan's stream through the machine, and what the walls it passes feel of it and of the rotor.

    ambient -> [space of the fan] -> left end -> gap, space between the poles, ducts of the rotor -> right end -> out

The gap takes the share that [fans] gives it. The rest divides so that all ways drop the same pressure between the two
ends: friction, entrance and exit of each, at every flow. The air in a duct of the rotor is spun up at the shaft's
cost: the dynamic pressure of its turning, as it comes in relative to the duct, is taken as lost at the inlet, neither
more nor less.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise

import numpy as np

from geom.constants import M3_H, RPM
from geom.description.geometry import Duct, Features
from geom.description.machine import Machine
from lumped.circuits.hydraulics import parallel_shares, split
from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.end_space import end_space
from lumped.correlations.info import Info
from lumped.correlations.streams import LEAST, MOST, streamed
from lumped.machine.settings import Fan, Films
from lumped.machine.shapes import Gap, gap_fluid
from lumped.model.network import NOTHING, Link, Network, Row
from lumped.transfer.laws import Array, InputPower, Inputs, Law, StreamTable, Table
from lumped.transfer.properties import Fluid, air
from lumped.transfer.reversal import OneWay

GAP_C, DUCT_C = 80.0, 40.0  # usual film temperatures, at which ranges are checked
INTAKE_USUAL_C = 20.0  # at which [fans] air_C is what the air comes to inside
INTAKE_C = tuple(float(T) for T in range(-60, 101, 10))  # of a fan; rho cp is straight between two to 0.03 %


@dataclass(frozen=True)
class Ways:
    """The ways of a fan's air along the axis: the gap, and the ducts that share what it leaves."""

    fan: Fan
    gap: str
    ducts: Mapping[str, Duct]

    @property
    def _beside(self) -> float:
        return 1.0 - self.fan.gap_share

    @cached_property
    def split(self) -> tuple[Array, dict[str, Array]]:
        """Share of each duct in all the fan's air, over the logarithm of its flow (m3/h) in air of air_C."""
        usual = self._beside * self.fan.flow_m3_h * M3_H
        flows, each = split([[duct] for duct in self.ducts.values()], LEAST * usual, MOST * usual, air(self.fan.air_C))
        shares = dict(zip(self.ducts, self._beside * each, strict=True))
        return flows - math.log(self._beside * M3_H), shares

    def share(self, way: str, flow: float, fluid: Fluid) -> float:
        """Of a flow (m3/h) of air in some state."""
        if way == self.gap or len(self.rated) < 3:  # one duct takes all that the gap leaves
            return self.rated.get(way, 0.0)
        flows, each = self.split
        alike = flow * air(self.fan.air_C).nu / fluid.nu
        return float(np.interp(math.log(max(alike, 1e-300)), flows, each[way]))

    def past(self, flow: float, fluid: Fluid) -> float:
        """What does not turn with the rotor: of a flow (m3/h), what passes walls that stand."""
        turning = [way for way in self.rated if way in self.ducts and self.ducts[way].turns]
        return 1.0 - sum(self.share(way, flow, fluid) for way in turning)

    @cached_property
    def rated(self) -> dict[str, float]:
        """What each way takes at the rated flow; together 1."""
        if not self.ducts:
            return {self.gap: 1.0}
        flow, ducts = self._beside * self.fan.flow_m3_h * M3_H, [[duct] for duct in self.ducts.values()]
        each = zip(self.ducts, parallel_shares(ducts, flow, air(self.fan.air_C)), strict=True)
        shares = {self.gap: self.fan.gap_share, **{name: self._beside * share for name, share in each}}
        return {way: share for way, share in shares.items() if share > 0.0}

    def rate(self, way: str | None = None) -> InputPower:
        """Heat capacity rate (W/K) of a way, None: of all; it looks at the temperature of what the fan takes in."""
        flow = (("fan_flow_m3h", 1.0, 1.0),)
        if way is None or way == self.gap or len(self.rated) < 3:
            return InputPower(M3_H * (1.0 if way is None else self.rated[way]), flow, heat_of_air())
        (numbers, each), warmer = self.split, self.fan.air_C - INTAKE_USUAL_C
        intake = [air(T) for T in INTAKE_C]
        shift = tuple(math.log(air(T + warmer).nu / air(self.fan.air_C).nu) for T in INTAKE_C)
        value = np.outer([x.rho * x.cp for x in intake], each[way]).ravel()
        usual = self.fan.flow_m3_h, INTAKE_USUAL_C
        table = StreamTable("fan_flow_m3h", *usual, INTAKE_C, shift, tuple(numbers.tolist()), tuple(value.tolist()))
        return InputPower(M3_H, flow, table)


def ways_of(machine: Machine, fan: Fan) -> Ways:
    return Ways(fan, gap_fluid(machine), machine.features.ducts)


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


def channel_film(duct: Duct, share: Callable[[float, Fluid], float], usual: float) -> Law:
    """Walls along the axis that a share of the fan's air passes; a turning duct is taken to stand still.

    share : of a flow (m3/h) of air in some state;  usual : flow (m3/h)
    """

    def film(flow: float, fluid: Fluid) -> tuple[float, Info]:
        return duct_film(share(flow, fluid) * flow * M3_H / duct.section, duct.diameter, duct.length, fluid)

    return streamed("fan_flow_m3h", usual, film, air, DUCT_C, liquid=False)


def fan_streams(network: Network, features: Features, ways: Ways) -> list[Link]:
    """The fan's air, cell by cell; what passes a way comes from the left end and goes to the right one."""
    (left, right), inlet = features.ends, [features.fan_space] if features.fan_space else []
    cells = list(pairwise(["ambient", *inlet, left]))
    return [
        *(_stream(network, [cell], ways.rate(), ways.fan.flow_m3_h) for cell in cells),
        *(_stream(network, [(left, w), (w, right)], ways.rate(w), ways.fan.flow_m3_h) for w in ways.rated),
    ]


@cache
def heat_of_air() -> Table:
    """rho cp (J/m3/K) of what a fan takes in, at its own temperature: a fan moves a volume."""
    return Table(INTAKE_C, tuple(air(T).rho * air(T).cp for T in INTAKE_C))


def _stream(network: Network, edges: list[tuple[str, str]], rate: Law, usual: float) -> Link:
    """Upwind cells: each takes up flow x heat capacity x (own temperature - what flows in);  usual : flow (m3/h)"""
    a, b = ([network.column(edge[k]) for edge in edges] for k in (0, 1))
    rows, cols, vals = np.array(b + b), np.array(b + a), np.repeat([1.0, -1.0], len(edges))
    right = "a flow from left to right: what comes in at the right is not known"
    law = OneWay(rate, "fan_flow_m3h", "[fans]", right, usual)
    intake = Row(np.array([network.column("ambient")]), np.ones(1))
    return Link(f"stream:fan:{edges[0][1]}", "stream", edges[0], rows, cols, vals, law, intake, NOTHING)
