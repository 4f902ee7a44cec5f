"""Liquid jackets: the channel's film, and the coolant as a stream that picks up heat along its path.

[cooling] in a machine file: coolant, flow_L_per_min, and JACKET = { inlet = ..., outlet = ... }; a jacket whose inlet
is another's outlet is fed by it, all others share the flow of the inlet, boundary "coolant", evenly.

A jacket is one cell whose node is the coolant's mean temperature T: with N = h A / (m cp) it takes up
m cp / phi (T - T_in), phi = 1 / (1 - exp(-N)) - 1 / N. Along a wall of one temperature this is the exact exponential.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from lumped.correlations.ducts import duct_film, schmidt_helical
from lumped.laws import Law
from lumped.motor_laws import Interpolated
from lumped.motor_shapes import radius
from lumped.network import Link, Network, Row
from lumped.properties import Fluid, ethylene_glycol, propylene_glycol, water
from lumped.reader import Table

INLET, FLOW = "coolant", "flow_l_min"
LIQUIDS = ("water", "glycol-50", "propylene-glycol-50")
RANGE = 4.0  # the tables reach up to this times the declared flow


@dataclass(frozen=True)
class Cooling:
    """feeds : jacket -> INLET or the jacket whose outlet feeds it;  property_C: where the liquid's properties hold"""

    coolant: str
    flow_l_min: float
    property_C: float
    feeds: Mapping[str, str]

    @property
    def liquid(self) -> Fluid:
        return liquid(self.coolant, self.property_C)

    def share(self, jacket: str) -> float:
        """Of the inlet's flow."""
        first = sum(feed == INLET for feed in self.feeds.values())
        return 1.0 / first if self.feeds[jacket] == INLET else self.share(self.feeds[jacket])


@cache
def liquid(name: str, T: float) -> Fluid:
    """Properties at T (degC); mixtures by mass."""
    if name == "water":
        return water(T)
    return ethylene_glycol(T, 0.5) if name == "glycol-50" else propylene_glycol(T, 0.5)


def cooling_of(machine: Any) -> Cooling | None:
    """[cooling], if the machine has jackets."""
    jackets = [part.name for part in machine.fluids if part.material != "air"]
    if not jackets:
        return None
    t = Table(machine.sections.get("cooling", {}), f"{machine.name} [cooling]")
    ports = {name: Table(t.raw(name, {}), f"{t.where} {name}") for name in jackets}
    outlets = {port.word("outlet", f"{name}.outlet"): name for name, port in ports.items()}
    inlet = t.number("inlet_C", 20.0, low=-40.0)
    found = Cooling(
        t.word("coolant", "glycol-50", LIQUIDS), t.number("flow_L_per_min", low=1e-6),
        t.number("property_C", inlet + 20.0, low=-40.0),
        {name: outlets.get(port.word("inlet", f"{name}.inlet"), INLET) for name, port in ports.items()},
    )  # fmt: skip
    t.number("pressure_bar", 1.0)
    for jacket, feed in found.feeds.items():
        if feed != INLET and found.feeds[feed] != INLET:
            raise t.error(f"{jacket} is the third jacket in a row", "at most two in a row")
    for table in (*ports.values(), t):
        table.close()
    return found


@dataclass(frozen=True)
class Channel:
    """One duct: cross-section (m2), hydraulic diameter, length along it, diameter of its coil (m), 0: straight."""

    area: float
    diameter: float
    length: float
    coil: float

    def film(self, flow_l_min: float, fluid: Fluid) -> float:
        """W/m2/K"""
        speed = flow_l_min / 60000.0 / self.area
        if self.coil:
            return schmidt_helical(speed, self.diameter, self.coil, fluid)[0]
        return duct_film(speed, self.diameter, self.length, fluid)[0]


def channel_of(machine: Any, jacket: str) -> Channel:
    """Rings are the turns of a helix, other profiles axial channels one after the other."""
    profile, z0, z1 = machine.part(jacket).prisms[0]
    if profile.holes:
        outer, inner = radius(profile.outer), radius(profile.holes[0])
        high, wide = outer - inner, z1 - z0
        turn = math.pi * (outer + inner)
        return Channel(high * wide, 2 * high * wide / (high + wide), turn, outer + inner)
    return Channel(profile.area, 4 * profile.area / _perimeter(profile.outer), z1 - z0, 0.0)


def _perimeter(loop: Any) -> float:
    """m; the edge that leaves a vertex with bulge b is an arc of 4 atan(b)."""
    total = 0.0
    for (x, y, bulge), (u, v, _) in zip(loop, (*loop[1:], loop[0]), strict=True):
        half = 2 * math.atan(bulge)
        total += math.hypot(u - x, v - y) * (half / math.sin(half) if abs(half) > 1e-9 else 1.0)
    return total


def _flows(cooling: Cooling) -> tuple[float, ...]:
    return tuple(cooling.flow_l_min * np.concatenate([[0.0], np.geomspace(0.02, RANGE, 80)]))


def jacket_film(machine: Any, jacket: str, cooling: Cooling) -> Law:
    """W/m2/K over the inlet's flow (l/min)."""
    channel, share, fluid, at = channel_of(machine, jacket), cooling.share(jacket), cooling.liquid, _flows(cooling)
    return Interpolated(FLOW, at, tuple(channel.film(share * q, fluid) for q in at))


def coolant_streams(machine: Any, network: Network, cooling: Cooling) -> list[Link]:
    """One stream per jacket."""
    return [link for jacket in cooling.feeds for link in _cell(machine, network, jacket, cooling)]


def _cell(machine: Any, network: Network, jacket: str, cooling: Cooling) -> list[Link]:
    """From the inlet, or from the outlet of the jacket before: T_in = T_0 + (T_before - T_0) / phi_before."""
    own, feed = network.column(jacket), cooling.feeds[jacket]
    rate, phi = _rates(machine, network, jacket, cooling)
    at = _flows(cooling)
    if feed == INLET:
        return [
            _stream(f"stream:{jacket}", feed, jacket, own, network.column(INLET), Interpolated(FLOW, at, rate / phi))
        ]
    before = _rates(machine, network, feed, cooling)[1]
    first, last = network.column(INLET), network.column(feed)
    return [
        _stream(f"stream:{jacket}", feed, jacket, own, first, Interpolated(FLOW, at, rate / phi)),
        _stream(f"stream:{jacket}:from", feed, jacket, first, last, Interpolated(FLOW, at, rate / phi / before), own),
    ]


def _stream(name: str, feed: str, jacket: str, plus: int, minus: int, law: Law, row: int | None = None) -> Link:
    """law (T_plus - T_minus) leaves `row` (default: plus)."""
    at = plus if row is None else row
    one = np.array([1.0])
    return Link(
        name, "stream", (feed, jacket), np.array([at, at]), np.array([plus, minus]), np.array([1.0, -1.0]), law,
        Row(np.array([plus]), one), Row(np.array([minus]), one),
    )  # fmt: skip


def _rates(machine: Any, network: Network, jacket: str, cooling: Cooling) -> tuple[np.ndarray, np.ndarray]:
    """Heat capacity rate m cp (W/K) and phi at the flows of the tables."""
    fluid, at = cooling.liquid, np.array(_flows(cooling))
    wet = sum(p.area or 0.0 for p in network.places.values() if p.kind == "surface" and p.fluid == jacket)
    rate = fluid.rho * fluid.cp * at * cooling.share(jacket) / 60000.0
    film = np.array(jacket_film(machine, jacket, cooling).factor({FLOW: at}))
    return rate, mean_share(np.divide(film * wet, rate, out=np.full_like(rate, 1e9), where=rate > 0))


def mean_share(N: np.ndarray) -> np.ndarray:
    """phi = (T_mean - T_in) / (T_out - T_in) along a wall of one temperature, N transfer units: 1/2 to 1."""
    small = np.minimum(N, 1e-3)
    exact = 1.0 / -np.expm1(-np.maximum(N, 1e-3)) - 1.0 / np.maximum(N, 1e-3)
    return np.where(N < 1e-3, 0.5 + small / 12.0, exact)
