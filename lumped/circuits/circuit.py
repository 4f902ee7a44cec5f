"""Coolant circuits: upwind cells along channels in series and in parallel, open or closed by reservoir and exchanger.

Every cell is a node whose temperature is what leaves it: it receives m cp (T_before - T_own) and the heat of its walls.
What a circuit carries from its inlet to its outlet is m cp (T_out - T_in) at every instant, exactly.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from geom.constants import L_MIN, M3_H
from lumped.circuits.hydraulics import (
    Array,
    Bore,
    Duct,
    Nozzles,
    Passage,
    parallel_shares,
    pressure_drop,
    pumping_power,
    split,
)
from lumped.correlations.ducts import duct_film, schmidt_helical, staton_rectangle
from lumped.correlations.info import Info
from lumped.correlations.streams import LEAST, MOST, restretched, streamed, warmed
from lumped.model.build import mean_row, node_row
from lumped.model.network import NOTHING, Link, Network, Row
from lumped.transfer.coolant import Coolant
from lumped.transfer.exchanger import BACKWARDS, Effectiveness, Exchanger, Flow
from lumped.transfer.laws import AtUsualTemperature, InputPower, Law, TemperatureLaw
from lumped.transfer.properties import Fluid
from lumped.transfer.reversal import Direction, OneWay
from lumped.transfer.streamed import Streamed

PER_M3S = {"l_min": L_MIN, "m3_h": M3_H}
TANK_M3 = 5e-5  # of the pipe in which branches meet

Edge = tuple[str, str]  # from, to


@dataclass(frozen=True)
class Pass:
    """A channel, a bore or nozzles, and the walls: node -> share of the wetted area. A one-sided jacket names one."""

    duct: Duct | Bore | Nozzles
    walls: Mapping[str, float]


@dataclass(frozen=True)
class Cooler:
    """What closes the loop: reservoir (m3), UA (W/K), the air's boundary and its flow, the arrangement."""

    volume: float
    UA: float
    air: str
    air_flow: Flow
    effectiveness: Effectiveness


@dataclass(frozen=True)
class Circuit:
    """branches : name -> passes in series; branches run in parallel.  flow (m3/s) at which the films are centred

    follows : whether films change with the coolant's temperature, else they hold at `at_degC`
    of, unit : input that carries the flow and its unit, or None for a flow that never changes
    inlet : a boundary for an open circuit; the node "NAME.reservoir" for a closed one
    upstream : of an open circuit, the boundary that flows in when the flow turns round; "" refuses that
    """

    name: str
    liquid: Coolant
    at_degC: float
    flow: float
    branches: Mapping[str, tuple[Pass, ...]]
    inlet: str
    of: str | None = None
    unit: str = "l_min"
    cells: int = 8
    cooler: Cooler | None = None
    pump_efficiency: float = 0.5
    follows: bool = True
    upstream: str = ""

    @property
    def heat(self) -> float:
        """rho cp (J/m3/K)."""
        fluid = self.liquid(self.at_degC)
        return fluid.rho * fluid.cp

    def stream(self) -> Flow:
        """Heat capacity rate of the flow."""
        return Flow(self.heat * (PER_M3S[self.unit] if self.of else self.flow), self.of)

    def _rate(self, temperature: TemperatureLaw) -> Law:
        """Heat capacity rate (W/K) of the flow as a law, times one of the circuit's mean temperature."""
        rate = InputPower(self.stream().rate, ((self.of, 1.0, 1.0),) if self.of else (), temperature)
        return rate if self.follows else AtUsualTemperature(rate)

    def shares(self, flow: float | None = None, degC: float | None = None) -> dict[str, float]:
        """Of a flow (m3/s) through each branch, from equal pressure drop: as declared where nothing else is said."""
        fluid = self.liquid(self.at_degC if degC is None else degC)
        split = parallel_shares(self._ducts, self.flow if flow is None else flow, fluid)
        return dict(zip(self.branches, split, strict=True))

    @property
    def _ducts(self) -> list[list[Passage]]:
        return [[p.duct for p in passes] for passes in self.branches.values()]

    @cached_property
    def _split(self) -> tuple[Array, dict[str, Array]]:
        """Share of each branch over the logarithm of the flow (m3/s) at the viscosity of `at_degC`."""
        low, high = LEAST * self.flow, MOST * self.flow
        flows, each = split(self._ducts, low, high, self.liquid(self.at_degC))
        return flows, dict(zip(self.branches, each, strict=True))

    def share(self, branch: str, flow: float, fluid: Fluid) -> float:
        """Of a flow (m3/s) of the coolant in some state."""
        if len(self.branches) == 1:
            return 1.0
        flows, each = self._split
        alike = flow * self.liquid(self.at_degC).nu / fluid.nu
        return float(np.interp(math.log(max(alike, 1e-300)), flows, each[branch]))

    @property
    def outlet(self) -> str:
        """The node in which the branches meet."""
        return f"{self.name}.outlet"

    def cell(self, branch: str, number: int) -> str:
        return f"{self.name}.{branch}.{number + 1}"

    def capacities(self) -> dict[str, float]:
        """Node -> heat capacity (J/K)."""
        out = {
            self.cell(branch, p * self.cells + c): self.heat * passes[p].duct.volume / self.cells
            for branch, passes in self.branches.items()
            for p in range(len(passes))
            for c in range(self.cells)
        }
        out[self.outlet] = self.heat * TANK_M3
        if self.cooler is not None:
            out[f"{self.name}.cooled"] = self.heat * TANK_M3
            out[self.inlet] = self.heat * self.cooler.volume
        return out

    def links(self, network: Network) -> list[Link]:
        """Streams, films and exchanger."""
        out = self._streams(network)
        for branch, passes in self.branches.items():
            for number, part in enumerate(passes):
                usual = self.share(branch, self.flow, self.liquid(self.at_degC))
                whole = part.duct.wall / self.cells * sum(part.walls.values())
                one = self._streamed(part, branch, whole / (self.heat * self._unit * usual))
                nodes = [self.cell(branch, number * self.cells + c) for c in range(self.cells)]
                before = self.cell(branch, number * self.cells - 1) if number else self.inlet
                middle, laws = mean_row(network, [before, *(n for n in nodes for _ in range(2))][:-1]), {}
                for wall, of in part.walls.items():
                    law = replace(one, value=part.duct.wall / self.cells * of)
                    laws[wall] = law if self.follows else AtUsualTemperature(law)
                name = f"film:{self.name}.{branch}.{number + 1}"
                out += [_comb(network, f"{name}:{wall}", wall, nodes, middle, law) for wall, law in laws.items()]
        return [*out, *self._exchanger(network)]

    def _streams(self, network: Network) -> list[Link]:
        """In both directions, where it is known what flows in from behind and a column carries the flow.

        All follow one temperature, the mean of the circuit: what flows into it leaves it. Branches are streams of their
        own, whose shares follow flow and temperature, and sum to 1.
        """
        rate = self._rate(warmed(self.liquid, self.at_degC))
        # Branch -> its edges from the inlet to where the branches meet.
        nodes = {
            branch: [self.cell(branch, k) for k in range(self.cells * len(passes))]
            for branch, passes in self.branches.items()
        }
        paths = {branch: list(pairwise([self.inlet, *cells, self.outlet])) for branch, cells in nodes.items()}
        ways = (
            mean_row(network, [node for path in paths.values() for edge in path[:-1] for node in edge]),
            mean_row(network, [node for path in paths.values() for edge in path[1:] for node in edge]),
        )
        if len(paths) == 1:
            (path,) = paths.values()
            return self._both_ways(network, "", [*path, *self._return], rate, ways)
        branches = ((f".{name}", path, self._shared(name)) for name, path in paths.items())
        back = [("", self._return, rate)] if self._return else []
        return [link for of in (*branches, *back) for link in self._both_ways(network, *of, ways)]

    @property
    def _return(self) -> list[Edge]:
        """Through the cooler of a closed circuit."""
        return [] if self.cooler is None else list(pairwise([self.outlet, f"{self.name}.cooled", self.inlet]))

    def _shared(self, branch: str) -> Law:
        """Heat capacity rate (W/K) of a branch."""
        flows, each = self._split
        alike = self._streamed(self.branches[branch][0], branch, 0.0).table
        value = np.outer(warmed(self.liquid, self.at_degC, alike.total).value, each[branch]).ravel()
        number = flows - math.log(self._unit)
        return self._rate(replace(alike, number=tuple(number.tolist()), value=tuple(value.tolist())))

    def _streamed(self, part: Pass, branch: str, stretch: float) -> Streamed:
        """Film (W/m2/K) of a pass onto what leaves its cells, or onto the coolant beside it where nothing stretches."""
        usual = self.share(branch, self.flow, self.liquid(self.at_degC))

        def film(size: float, fluid: Fluid) -> tuple[float, Info]:
            share = self.share(branch, size * self._unit, fluid)
            h, info = film_in(part.duct, size * self._unit * share, fluid)
            rate = share / usual * fluid.rho * fluid.cp / self.heat
            return h * restretched(h * stretch / max(size, 1e-300), rate), info

        return streamed(self.of, self.flow / self._unit, film, self.liquid, self.at_degC, True, stretch=stretch)

    @property
    def _unit(self) -> float:
        """m3/s of an input of 1; a flow that never changes is in m3/s itself."""
        return PER_M3S[self.unit] if self.of else 1.0

    def _both_ways(
        self, network: Network, suffix: str, edges: list[Edge], law: Law, middle: tuple[Row, Row]
    ) -> list[Link]:
        """middle : of the circuit, while it flows forwards and backwards"""
        forwards, backwards = middle
        if self.of is None:
            return [self._stream(network, suffix, edges, law, forwards)]
        if not (self.cooler is not None or self.upstream):
            right = 'backwards_from = "BOUNDARY": what comes in at the outlet when the flow turns round'
            one = OneWay(law, self.of, f"[circuits.{self.name}]", right, self.flow / PER_M3S[self.unit])
            return [self._stream(network, suffix, edges, one, forwards)]
        back = [(b, a) for a, b in reversed(edges) if self.cooler is not None or a != self.inlet]
        entry = [] if self.cooler is not None else [(self.upstream, self.outlet)]
        return [
            self._stream(network, suffix, edges, Direction(law, self.of, 1), forwards),
            self._stream(network, f"{suffix}:back", [*entry, *back], Direction(law, self.of, -1), backwards),
        ]

    def _stream(self, network: Network, suffix: str, edges: list[Edge], law: Law, middle: Row) -> Link:
        """In one direction, as long as edges follow each other; it ends where they meet, or with the last."""
        a, b = [network.column(x) for x, _ in edges], [network.column(x) for _, x in edges]
        rows, cols, vals = np.array(b + b), np.array(b + a), np.repeat([1.0, -1.0], len(edges))
        end = self.outlet if any(x == self.outlet for _, x in edges[1:]) else edges[-1][1]
        places = edges[0][0], end
        return Link(f"stream:{self.name}{suffix}", "stream", places, rows, cols, vals, law, middle, NOTHING)

    def _exchanger(self, network: Network) -> list[Link]:
        if self.cooler is None:
            return []
        law = Exchanger(self.cooler.UA, self.stream(), self.cooler.air_flow, self.cooler.effectiveness)
        if self.of is None:
            return [self._exchanged(network, "", self.outlet, law)]
        back = replace(law, effectiveness=BACKWARDS.get(law.effectiveness, law.effectiveness))
        return [
            self._exchanged(network, "", self.outlet, Direction(law, self.of, 1)),
            self._exchanged(network, ":back", self.inlet, Direction(back, self.of, -1)),
        ]

    def _exchanged(self, network: Network, suffix: str, start: str, law: Law) -> Link:
        """The exchanger with the node that flows into it."""
        assert self.cooler is not None
        outlet, hot, air = (network.column(n) for n in (f"{self.name}.cooled", start, self.cooler.air))
        rows, cols, vals = np.array([outlet, outlet]), np.array([hot, air]), np.array([1.0, -1.0])
        places, ends = (f"{self.name}.cooled", self.cooler.air), (node_row(hot), node_row(air))
        return Link(f"exchanger:{self.name}{suffix}", "film", places, rows, cols, vals, law, *ends)

    def pressure_drop(self, flow: float | None = None) -> float:
        """Across the branches (Pa) at a flow (m3/s)."""
        q, fluid = self.flow if flow is None else flow, self.liquid(self.at_degC)
        branch, share = max(self.shares(q).items(), key=lambda item: item[1])
        return math.fsum(pressure_drop(p.duct, q * share, fluid) for p in self.branches[branch])

    def pump_power(self, flow: float | None = None) -> float:
        """Taken by the pump (W)."""
        q = self.flow if flow is None else flow
        return pumping_power(self.pressure_drop(q), q, self.pump_efficiency)


def film_in(duct: Duct | Bore | Nozzles, flow: float, fluid: Fluid) -> tuple[float, Info]:
    """h (W/m2/K) at a flow (m3/s): Gnielinski in straight ducts, Schmidt in coils, what bores and nozzles say."""
    if not isinstance(duct, Duct):
        return duct.film(flow, fluid)
    speed = flow / duct.section
    if duct.coil:
        return schmidt_helical(speed, duct.diameter, duct.coil, fluid)
    ratio = min(duct.width, duct.height) / max(duct.width, duct.height)
    return duct_film(speed, duct.diameter, duct.length, fluid, staton_rectangle(ratio))


def _comb(network: Network, name: str, wall: str, cells: list[str], middle: Row, law: Law) -> Link:
    """One link from a wall to every cell of a pass; its law looks at the mean temperature of the coolant (degC)."""
    w = network.column(wall)
    c = np.array([network.column(cell) for cell in cells])
    k = np.full(c.size, w)
    rows, cols = np.concatenate([k, k, c, c]), np.concatenate([k, c, c, k])
    one = np.ones(c.size)
    vals = np.concatenate([one, -one, one, -one])
    return Link(name, "film", (wall, cells[0]), rows, cols, vals, law, middle, NOTHING)
