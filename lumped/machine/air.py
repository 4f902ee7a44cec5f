"""The air inside: a fan's stream through the machine, and what the walls it passes feel of it and of the rotor.

    ambient -> [space of the fan] -> left end -> gap, space between the poles, ducts of the rotor -> right end -> out

The gap takes the share that [fans] gives it. The rest divides so that all ways drop the same pressure between the two
ends: friction, entrance and exit of each. The air in a duct of the rotor is spun up at the shaft's cost: the dynamic
pressure of its turning, as it comes in relative to the duct, is taken as lost at the inlet, neither more nor less.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geom.constants import M3_H
from geom.description.geometry import Duct, Features
from geom.description.machine import Machine
from lumped.circuits.hydraulics import parallel_shares
from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.end_space import end_space
from lumped.machine.laws import Interpolated, film_over
from lumped.machine.settings import Fan, Films
from lumped.machine.shapes import Gap, gap_fluid
from lumped.model.network import Link, Network, Row
from lumped.transfer.laws import InputPower, Law
from lumped.transfer.properties import air
from lumped.transfer.reversal import OneWay

AIR_HEAT = 1.205 * 1006.0  # rho cp of the air the fan takes in at 20 degC, J/m3/K
STEPS = 121  # of speed in a table of films
GAP_C, DUCT_C = 80.0, 40.0  # film temperatures at which tables over speed and flow are made


def fan_shares(machine: Machine, fan: Fan) -> dict[str, float]:
    """What each way along the axis takes of the fan's air at its rated flow; together 1."""
    ducts, gap = machine.features.ducts, gap_fluid(machine)
    if not ducts:
        return {gap: 1.0}
    beside = 1.0 - fan.gap_share
    split = parallel_shares([[duct] for duct in ducts.values()], beside * fan.flow_m3_h * M3_H, air(fan.air_C))
    shares = {gap: fan.gap_share, **{name: beside * share for name, share in zip(ducts, split, strict=True)}}
    return {name: share for name, share in shares.items() if share > 0.0}


def stirred(share: float, films: Films, radius: float, top_rpm: float) -> Law:
    """Walls of air that a rotor of this radius (m) stirs; `share` of its tip speed passes the wall."""
    speed = np.linspace(0.0, top_rpm, STEPS)
    tip = speed * 2 * np.pi / 60 * radius * share
    h = end_space(tip, films.end_space_k1_W_m2K, films.end_space_k2, films.end_space_k3)[0]
    return Interpolated("speed_rpm", tuple(speed), tuple(np.asarray(h)))


def gap_film(gap: Gap, top_rpm: float) -> Law:
    """One wall of the air gap. It follows its film temperature as it does at half of `top_rpm`."""

    def film(rpm: float, T: float) -> float:
        return taylor_film(rpm * 2 * np.pi / 60, gap.rotor_radius, gap.width, air(T))[0]

    return film_over("speed_rpm", np.linspace(0.0, top_rpm, STEPS).tolist(), film, 0.5 * top_rpm, GAP_C)


def channel_film(duct: Duct, share: float, usual: float) -> Law:
    """Walls along the axis that `share` of the fan's air passes; a turning duct is taken to stand still.

    usual : flow (m3/h)
    """

    def film(flow: float, T: float) -> float:
        return duct_film(share * flow * M3_H / duct.section, duct.diameter, duct.length, air(T))[0]

    return film_over("fan_flow_m3h", np.linspace(0.0, 600.0, 61).tolist(), film, usual, DUCT_C)


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
    law = OneWay(InputPower(AIR_HEAT * M3_H, (("fan_flow_m3h", 1.0, 1.0),)), "fan_flow_m3h", "[fans]", way, usual)
    return [_cell(network, cell, upstream, law) for cell, upstream in feeds.items()]


def _cell(network: Network, cell: str, upstream: Mapping[str, float], law: Law) -> Link:
    """An upwind cell: it takes up flow x heat capacity x (own temperature - what flows in)."""
    column = network.column(cell)
    cols = np.array([column, *(network.column(name) for name in upstream)])
    vals = np.array([sum(upstream.values()), *(-share for share in upstream.values())])
    inflow = -vals[1:] / vals[0]
    rows, first = np.full(len(cols), column), next(iter(upstream))
    hot, cold = Row(np.array([column]), np.array([1.0])), Row(cols[1:], inflow)
    return Link(f"stream:fan:{cell}", "stream", (first, cell), rows, cols, vals, law, hot, cold)
