"""The air inside: a fan's stream through the machine, and what the walls it passes feel of it and of the rotor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from lumped.correlations.air_gap import taylor_film
from lumped.correlations.ducts import duct_film
from lumped.correlations.end_space import end_space
from lumped.laws import InputPower, Law
from lumped.motor_laws import Interpolated
from lumped.motor_settings import Fan, Films
from lumped.motor_shapes import Gap
from lumped.network import Link, Network, Row

AIR_HEAT = 1.205 * 1006.0  # rho cp of the air the fan takes in at 20 degC, J/m3/K
BETWEEN_POLES = "air.interpolar"
STEPS = 121


@dataclass(frozen=True)
class Duct:
    """A space along the axis (m2, m, m)."""

    area: float
    perimeter: float
    length: float


def duct_of(machine: Any) -> Duct | None:
    """The space between salient poles, where there is one."""
    if BETWEEN_POLES not in {part.name for part in machine.fluids}:
        return None
    g = machine.geometry
    bore = g.rotor.outer_diameter / 2 + g.stator.air_gap
    poles, body = g.stator.poles, g.stator.body_width
    depth = g.stator.yoke_inner_diameter / 2 - bore
    coils = 2 * poles * g.field.coil_width * g.field.coil_height
    area = np.pi * (bore + depth) ** 2 - np.pi * bore**2 - poles * body * depth - coils
    perimeter = 2 * np.pi * (2 * bore + depth) + 2 * poles * (depth - body)
    return Duct(area, perimeter, g.rotor.stack_length)


def stirred(share: float, films: Films, gap: Gap, top_rpm: float) -> Law:
    """Walls of air that the rotor stirs; `share` of its tip speed passes the wall."""
    speed = np.linspace(0.0, top_rpm, STEPS)
    tip = speed * 2 * np.pi / 60 * gap.rotor_radius * share
    h = end_space(tip, films.end_space_k1_W_m2K, films.end_space_k2, films.end_space_k3)[0]
    return Interpolated("speed_rpm", tuple(speed), tuple(np.asarray(h)))


def gap_film(gap: Gap, top_rpm: float) -> Law:
    """One wall of the air gap."""
    speed = np.linspace(0.0, top_rpm, STEPS)
    h = [taylor_film(n * 2 * np.pi / 60, gap.rotor_radius, gap.width)[0] for n in speed]
    return Interpolated("speed_rpm", tuple(speed), tuple(h))


def channel_film(duct: Duct) -> Law:
    """Walls that the fan's air passes along the axis."""
    flow, diameter = np.linspace(0.0, 600.0, 61), 4 * duct.area / duct.perimeter
    h = [duct_film(q / 3600 / duct.area, diameter, duct.length)[0] for q in flow]
    return Interpolated("fan_flow_m3h", tuple(flow), tuple(h))


def fan_streams(network: Network, fan: Fan) -> list[Link]:
    """The fan's air: ambient -> left end -> gap and space between the poles in parallel -> right end -> out."""
    gap = fan.gap_share if BETWEEN_POLES in network.states else 1.0
    between = {BETWEEN_POLES: 1.0 - gap} if gap < 1.0 else {}
    feeds = {
        "air.left": {"ambient": 1.0},
        "airgap": {"air.left": gap},
        **{space: {"air.left": share} for space, share in between.items()},
        "air.right": {"airgap": gap, **between},
    }
    law = InputPower(AIR_HEAT / 3600.0, (("fan_flow_m3h", 1.0, 1.0),))
    return [_cell(network, cell, upstream, law) for cell, upstream in feeds.items()]


def _cell(network: Network, cell: str, upstream: Mapping[str, float], law: Law) -> Link:
    """An upwind cell: it takes up flow x heat capacity x (own temperature - what flows in)."""
    own = network.column(cell)
    cols = np.array([own, *(network.column(name) for name in upstream)])
    vals = np.array([sum(upstream.values()), *(-share for share in upstream.values())])
    inflow = -vals[1:] / vals[0]
    rows, first = np.full(len(cols), own), next(iter(upstream))
    hot, cold = Row(np.array([own]), np.array([1.0])), Row(cols[1:], inflow)
    return Link(f"stream:fan:{cell}", "stream", (first, cell), rows, cols, vals, law, hot, cold)
