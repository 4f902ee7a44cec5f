"""Liquid jackets: the channel's film, and the coolant as a stream that picks up heat along its path.

[cooling] in a machine file: coolant, flow_L_per_min, and JACKET = { inlet = ..., outlet = ... }; a jacket whose inlet
is another's outlet is fed by it, all others share the flow of the inlet, boundary "coolant", evenly. Each jacket is a
row of cells, see path.py.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from geom.constants import L_MIN
from geom.description.machine import Machine
from geom.description.profile import loop_length
from lumped.correlations.ducts import duct_film, schmidt_helical
from lumped.correlations.info import Info
from lumped.correlations.streams import liquid_range, restretched, streamed, warmed
from lumped.machine.path import cells_of, stem
from lumped.machine.shapes import radius
from lumped.model.build import mean_row, stream
from lumped.model.network import NOTHING, Link, Network, Place, Row
from lumped.schemas.reader import Table
from lumped.transfer.coolant import Coolant, coolant
from lumped.transfer.laws import AtUsualTemperature, InputPower, Law
from lumped.transfer.properties import ATMOSPHERE_BAR, Fluid
from lumped.transfer.reversal import OneWay
from lumped.transfer.streamed import Streamed

INLET, FLOW = "coolant", "flow_l_min"
WARMER_K = 20.0  # than its inlet a coolant is usually, where it takes up the rated losses
LIQUIDS: dict[str, tuple[str, float | None]] = {
    "water": ("water", None),
    "glycol-50": ("ethylene glycol", 50.0),
    "propylene-glycol-50": ("propylene glycol", 50.0),
    "ATF": ("ATF", None),
}


@dataclass(frozen=True)
class Cooling:
    """feeds : jacket -> INLET or the jacket whose outlet feeds it

    usual_C : where its films are tabulated around; they and its heat capacity follow the coolant's own temperature
    """

    coolant: str
    flow_l_min: float
    usual_C: float
    feeds: Mapping[str, str]
    pressure_bar: float = ATMOSPHERE_BAR

    def __hash__(self) -> int:
        return hash((self.coolant, self.flow_l_min, self.usual_C, self.pressure_bar, *self.feeds.items()))

    @property
    def liquid(self) -> Fluid:
        return self.at(self.usual_C)

    @property
    def at(self) -> Coolant:
        """T (degC) -> its properties."""
        name, mass_percent = LIQUIDS[self.coolant]
        return coolant(name, mass_percent, pressure_bar=self.pressure_bar)

    def before(self, jacket: str) -> list[str]:
        """Where its coolant comes from, backwards as far as the inlet; a circle ends where it closes."""
        out = [self.feeds[jacket]]
        while out[-1] != INLET and self.feeds[out[-1]] not in out:
            out.append(self.feeds[out[-1]])
        return out

    def share(self, jacket: str) -> float:
        """Of the inlet's flow."""
        first = sum(feed == INLET for feed in self.feeds.values())
        return 1.0 / first if self.feeds[jacket] == INLET else self.share(self.feeds[jacket])


def cooling_of(machine: Machine) -> Cooling | None:
    """[cooling], if the machine has jackets."""
    jackets = [part.name for part in machine.fluids if part.material != "air"]
    if not jackets:
        return None
    t = Table(machine.sections.get("cooling", {}), f"{machine.name} [cooling]")
    ports = {name: Table(t.raw(name, {}), f"{t.where} {name}") for name in jackets}
    outlets = {port.word("outlet", f"{name}.outlet"): name for name, port in ports.items()}
    if "property_C" in t:
        raise t.error("key 'property_C' is gone", "leave it out: a coolant has the properties of its temperature")
    usual = t.number("inlet_C", 20.0) + WARMER_K
    cooling = Cooling(
        t.word("coolant", "glycol-50", LIQUIDS),
        t.number("flow_L_per_min"),
        usual,
        {name: outlets.get(port.word("inlet", f"{name}.inlet"), INLET) for name, port in ports.items()},
        t.number("pressure_bar", ATMOSPHERE_BAR),
    )
    cooling = replace(cooling, usual_C=min(usual, liquid_range(cooling.at)[1]))
    for jacket in jackets:
        if INLET not in cooling.before(jacket):
            raise t.error(f"{jacket} is fed by itself", "an inlet that no jacket feeds")
    for table in (*ports.values(), t):
        table.close()
    return cooling


@dataclass(frozen=True)
class Channel:
    """One duct: cross-section (m2), hydraulic diameter, length along it, diameter of its coil (m), 0: straight."""

    area: float
    diameter: float
    length: float
    coil: float

    def film(self, flow_l_min: float, fluid: Fluid) -> tuple[float, Info]:
        """W/m2/K"""
        speed = flow_l_min * L_MIN / self.area
        if self.coil:
            return schmidt_helical(speed, self.diameter, self.coil, fluid)
        return duct_film(speed, self.diameter, self.length, fluid)


def channel_of(machine: Machine, jacket: str) -> Channel:
    """Rings are the turns of a helix, other profiles axial channels one after the other."""
    profile, z0, z1 = machine.part(jacket).prisms[0]
    if profile.holes:
        outer, inner = radius(profile.outer), radius(profile.holes[0])
        high, wide = outer - inner, z1 - z0
        turn = math.pi * (outer + inner)
        return Channel(high * wide, 2 * high * wide / (high + wide), turn, outer + inner)
    return Channel(profile.area, 4 * profile.area / loop_length(profile.outer), z1 - z0, 0.0)


def jacket_film(machine: Machine, jacket: str, cooling: Cooling) -> Law:
    """W/m2/K over the inlet's flow (l/min), at the usual temperature of the coolant."""
    return AtUsualTemperature(_film(channel_of(machine, jacket), cooling, cooling.share(jacket), 0.0))


def onto_outlet(machine: Machine, jacket: str, cooling: Cooling, wet: float) -> Streamed:
    """Film (W/m2/K) on what leaves a cell with some wetted area (m2)."""
    return _film(channel_of(machine, jacket), cooling, cooling.share(jacket), wet / _rate(jacket, cooling))


def outlet_film(machine: Machine, network: Network, place: str, cooling: Cooling) -> Link:
    """From a wall onto what leaves a cell; it follows the temperature between what comes in and what leaves."""
    cell = str(network.places[place].fluid)
    jacket, feeds = stem(cell), _feeds(machine, cooling)
    wet = sum(p.area or 0.0 for p in network.places.values() if p.kind == "surface" and p.fluid == cell)
    law = onto_outlet(machine, jacket, cooling, wet)
    between = np.array([network.column(feeds[cell]), network.column(cell)])
    link = network.surface_link(f"film:{place}", "film", place, cell, law)
    return replace(link, hot=Row(between, np.array([0.5, 0.5])), cold=NOTHING)


@lru_cache(64)
def _film(channel: Channel, cooling: Cooling, share: float, stretch: float) -> Streamed:
    """stretch : of StreamTable"""
    heat = cooling.liquid.rho * cooling.liquid.cp

    def film(flow: float, fluid: Fluid) -> tuple[float, Info]:
        h, info = channel.film(share * flow, fluid)
        return h * restretched(h * stretch / max(flow, 1e-300), fluid.rho * fluid.cp / heat), info

    return streamed(FLOW, cooling.flow_l_min, film, cooling.at, cooling.usual_C, liquid=True, stretch=stretch)


def _feeds(machine: Machine, cooling: Cooling) -> dict[str, str]:
    """Cell -> the cell, or the inlet, from which its coolant comes."""
    cells = {jacket: cells_of(machine, jacket) for jacket in cooling.feeds}
    last = {jacket: path[-1] for jacket, path in cells.items()} | {INLET: INLET}
    pairs = (zip(path, (last[cooling.feeds[jacket]], *path)) for jacket, path in cells.items())
    return {cell: feed for pair in pairs for cell, feed in pair}


def coolant_streams(machine: Machine, network: Network, cooling: Cooling) -> list[Link]:
    """Every cell takes up m cp (T - T of the cell before); before a jacket's first is the inlet or another jacket.

    All follow one temperature, the mean of the jackets: what flows into one leaves it.
    """
    feeds = _feeds(machine, cooling)
    middle = mean_row(network, [node for pair in feeds.items() for node in pair])
    laws = {jacket: _rate_law(machine, jacket, cooling) for jacket in cooling.feeds}
    links = (stream(network, f"stream:{cell}", (feed, cell), laws[stem(cell)]) for cell, feed in feeds.items())
    return [replace(link, hot=middle, cold=NOTHING) for link in links]


def _rate_law(machine: Machine, jacket: str, cooling: Cooling) -> Law:
    right = "a flow from inlet to outlet: what comes in at the outlet is not known"
    warmer = warmed(cooling.at, cooling.usual_C)
    rate = InputPower(_rate(jacket, cooling), ((FLOW, 1.0, 1.0),), warmer)
    return OneWay(rate, FLOW, f"{machine.name} [cooling]", right, cooling.flow_l_min)


def outlets(machine: Machine, network: Network, cooling: Cooling) -> dict[str, Place]:
    """ "JACKET.outlet": where a thermocouple reads the coolant that leaves."""
    last = {jacket: network.column(cells_of(machine, jacket)[-1]) for jacket in cooling.feeds}
    return {
        f"{jacket}.outlet": Place(f"{jacket}.outlet", "fluid", jacket, np.array([k]), np.ones((1, 1)), np.ones(1))
        for jacket, k in last.items()
    }


def _rate(jacket: str, cooling: Cooling) -> float:
    """Heat capacity rate m cp (W/K) of an inlet's flow of 1 l/min, at the usual temperature."""
    return cooling.liquid.rho * cooling.liquid.cp * cooling.share(jacket) * L_MIN
