"""Coolant circuits: upwind cells along channels in series and in parallel, open or closed by reservoir and exchanger.

Every cell is a node whose temperature is what leaves it: it receives m cp (T_before - T_own) and the heat of its walls.
What a circuit carries from its inlet to its outlet is m cp (T_out - T_in) at every instant, exactly.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from geom.constants import L_MIN, M3_H
from geom.errors import InputError
from lumped.circuits.hydraulics import Duct, parallel_shares, pressure_drop, pumping_power
from lumped.correlations.ducts import duct_film, schmidt_helical, staton_rectangle
from lumped.model.build import node_row
from lumped.model.network import Link, Network, Row
from lumped.transfer.coolant import Coolant
from lumped.transfer.exchanger import BACKWARDS, CellFilm, Effectiveness, Exchanger, Flow, Rate
from lumped.transfer.laws import Law, Table
from lumped.transfer.properties import TABULATED_C
from lumped.transfer.reversal import Direction, OneWay

RANGE = (0.0, *(2.0**k for k in np.arange(-5, 2.01, 0.125)))  # films are tabulated at these times the declared flow
PER_M3S = {"l_min": L_MIN, "m3_h": M3_H}
TANK_M3 = 5e-5  # of the pipe in which branches meet

Edge = tuple[str, str, float]  # from, to, share of the flow


@dataclass(frozen=True)
class Pass:
    """A channel and the walls it touches: node -> share of its wetted area. A one-sided jacket names one wall."""

    duct: Duct
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

    def stream(self, share: float = 1.0) -> Flow:
        """Heat capacity rate of a share of the flow."""
        return Flow(share * self.heat * (PER_M3S[self.unit] if self.of else self.flow), self.of)

    @property
    def shares(self) -> dict[str, float]:
        """Of the flow through each branch, from equal pressure drop at the declared flow."""
        ducts = [[p.duct for p in passes] for passes in self.branches.values()]
        return dict(zip(self.branches, parallel_shares(ducts, self.flow, self.liquid(self.at_degC)), strict=True))

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
            for branch, passes in self.branches.items() for p in range(len(passes)) for c in range(self.cells)
        }  # fmt: skip
        out[self.outlet] = self.heat * TANK_M3
        if self.cooler is not None:
            out[f"{self.name}.cooled"] = self.heat * TANK_M3
            out[self.inlet] = self.heat * self.cooler.volume
        return out

    def links(self, network: Network) -> list[Link]:
        """Streams, films and exchanger."""
        out = self._streams(network)
        for branch, share in self.shares.items():
            for number, part in enumerate(self.branches[branch]):
                out += self._films(network, branch, number, part, share)
        return [*out, *self._exchanger(network)]

    def _streams(self, network: Network) -> list[Link]:
        """In both directions, where it is known what flows in from behind and a column carries the flow."""
        law, edges, end = Rate(self.stream()), list(self._edges()), {self.outlet: 1.0}
        if self.of is None:
            return [self._stream(network, "", self.inlet, end, edges, law)]
        if not self._turns:
            right = 'backwards_from = "BOUNDARY": what comes in at the outlet when the flow turns round'
            one = OneWay(law, self.of, f"[circuits.{self.name}]", right, self.flow / PER_M3S[self.unit])
            return [self._stream(network, "", self.inlet, end, edges, one)]
        first, back = {self.cell(branch, 0): share for branch, share in self.shares.items()}, self._back()
        return [
            self._stream(network, "", self.inlet, end, edges, Direction(law, self.of, 1)),
            self._stream(network, ":back", back[-1][0], first, back, Direction(law, self.of, -1)),
        ]

    @property
    def _turns(self) -> bool:
        """Whether its flow may turn round."""
        return self.of is not None and (self.cooler is not None or bool(self.upstream))

    def _back(self) -> list[Edge]:
        """The edges the other way round."""
        inside = [(b, a, share) for a, b, share in self._edges() if self.cooler is not None or a != self.inlet]
        return inside if self.cooler is not None else [*inside, (self.upstream, self.outlet, 1.0)]

    def _edges(self) -> Iterator[Edge]:
        for branch, share in self.shares.items():
            count = self.cells * len(self.branches[branch])
            path = [self.inlet, *(self.cell(branch, k) for k in range(count)), self.outlet]
            yield from ((a, b, share) for a, b in pairwise(path))
        if self.cooler is not None:
            yield from ((self.outlet, f"{self.name}.cooled", 1.0), (f"{self.name}.cooled", self.inlet, 1.0))

    def _stream(
        self, network: Network, suffix: str, start: str, ends: Mapping[str, float], edges: list[Edge], law: Law
    ) -> Link:
        """One direction; ends : nodes that it leaves from, with their shares."""
        a, b = [network.column(x) for x, _, _ in edges], [network.column(x) for _, x, _ in edges]
        share = np.array([edge[2] for edge in edges])
        rows, cols, vals = np.array(b + b), np.array(b + a), np.concatenate([share, -share])
        out = Row(np.array([network.column(end) for end in ends]), np.array(list(ends.values())))
        return Link(
            f"stream:{self.name}{suffix}", "stream", (start, next(iter(ends))), rows, cols, vals, law, out,
            node_row(network.column(start)),
        )  # fmt: skip

    def _films(self, network: Network, branch: str, number: int, part: Pass, share: float) -> list[Link]:
        flows = tuple(self.flow * r for r in RANGE)
        h = tuple(self.film(part.duct, q * share) for q in flows)
        unit = PER_M3S[self.unit] if self.of else self.flow
        whole = part.duct.wall / self.cells * sum(part.walls.values())
        out = []
        for wall, of in part.walls.items():
            area = part.duct.wall / self.cells * of
            law = CellFilm(tuple(q / unit for q in flows), h, self.stream(share), area, whole)
            if self.follows:
                law = replace(law, temperature=self._warming(law, part.duct, self.flow * share))
            nodes = [self.cell(branch, number * self.cells + c) for c in range(self.cells)]
            out.append(_comb(network, f"film:{self.name}.{branch}.{number + 1}:{wall}", wall, nodes, law))
        return out

    def _warming(self, law: CellFilm, duct: Duct, flow: float) -> Table:
        """The conductance at the usual flow over the coolant's temperature, as a share of that at `at_degC`."""
        rate = np.array([flow * self.heat])
        films = dict(self._films_at(duct, flow))
        usual = law.conductance(rate, self.film(duct, flow))
        return Table(tuple(films), tuple(float(law.conductance(rate, h) / usual) for h in films.values()))

    def _films_at(self, duct: Duct, flow: float) -> Iterator[tuple[float, float]]:
        """(degC, W/m2/K) wherever the liquid is known."""
        for T in TABULATED_C:
            with suppress(InputError):
                yield T, self.film(duct, flow, T)

    def film(self, duct: Duct, flow: float, degC: float | None = None) -> float:
        """h (W/m2/K) in a duct at a flow (m3/s): Gnielinski in straight ones, Schmidt in coils."""
        speed, fluid = flow / duct.section, self.liquid(self.at_degC if degC is None else degC)
        if duct.coil:
            return schmidt_helical(speed, duct.diameter, duct.coil, fluid)[0]
        ratio = min(duct.width, duct.height) / max(duct.width, duct.height)
        return duct_film(speed, duct.diameter, duct.length, fluid, staton_rectangle(ratio))[0]

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
        branch, share = max(self.shares.items(), key=lambda item: item[1])
        return math.fsum(pressure_drop(p.duct, q * share, fluid) for p in self.branches[branch])

    def pump_power(self, flow: float | None = None) -> float:
        """Taken by the pump (W)."""
        q = self.flow if flow is None else flow
        return pumping_power(self.pressure_drop(q), q, self.pump_efficiency)


def _comb(network: Network, name: str, wall: str, cells: list[str], law: CellFilm) -> Link:
    """One link from a wall to every cell of a pass; its law looks at the mean temperature of the cells (degC)."""
    w = network.column(wall)
    c = np.array([network.column(cell) for cell in cells])
    k = np.full(c.size, w)
    rows, cols = np.concatenate([k, k, c, c]), np.concatenate([k, c, c, k])
    one = np.ones(c.size)
    vals = np.concatenate([one, -one, one, -one])
    mean, zero = Row(c, one / c.size), Row(np.empty(0, np.int64), np.empty(0))
    return Link(name, "film", (wall, cells[0]), rows, cols, vals, law, mean, zero)
