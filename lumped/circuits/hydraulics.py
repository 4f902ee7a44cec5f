"""What coolants pass: channels, bores of shafts, nozzles; pressure along it, and the power of pumps and fans."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from geom.arrays import Array
from lumped.correlations.ducts import LAMINAR, TURBULENT, duct_film
from lumped.correlations.info import Info
from lumped.correlations.oil import sprayed_face
from lumped.transfer.properties import Fluid

POINTS = 1600  # of a split, 2 % apart in flow, beside the kinks of the friction: straight in between to 1e-4 of a share
COIL_BRIDGE = 1.2  # of a coil's critical Re, where Schmidt's turbulent friction begins: his branches do not meet
COIL_JUMP = 2.2e4  # Re at which his turbulent friction steps up
SLOWEST = 1e-3  # where a split begins below the least flow: branches may take so little
STRAIGHT = 1e-3  # of a share
ROUGHNESS = 2.5e-6  # m, drawn or die-cast channel
FILM_M = 1e-3  # of oil on a face
BORE = 3.0  # length of a nozzle over its diameter: where the pressure is lost


class Passage(Protocol):
    """What pressure needs to know: section of all parallel ones (m2), hydraulic diameter of each, length (m),
    bends of 90 degrees, diameter of a helix (m) or 0."""

    @property
    def section(self) -> float: ...
    @property
    def diameter(self) -> float: ...
    @property
    def length(self) -> float: ...
    @property
    def bends(self) -> int: ...
    @property
    def coil(self) -> float: ...


@dataclass(frozen=True)
class Duct:
    """Rectangular channel: width, height, length (m); bends of 90 degrees; coil: diameter of a helix (m) or 0.

    parallel : equal channels side by side that share the flow
    """

    width: float
    height: float
    length: float
    bends: int = 0
    coil: float = 0.0
    parallel: int = 1

    @property
    def diameter(self) -> float:
        """Hydraulic diameter (m)."""
        return 2 * self.width * self.height / (self.width + self.height)

    @property
    def section(self) -> float:
        """Of all parallel channels (m2)."""
        return self.parallel * self.width * self.height

    @property
    def volume(self) -> float:
        """m3"""
        return self.section * self.length

    @property
    def wall(self) -> float:
        """Wetted area on all four sides (m2)."""
        return 2 * self.parallel * (self.width + self.height) * self.length


@dataclass(frozen=True)
class Bore:
    """Equal round bores side by side: diameter, length (m); bends of 90 degrees.

    One that turns about its own axis is as one that stands: a laminar flow turns with it, and its film stays.
    """

    diameter: float
    length: float
    bends: int = 0
    parallel: int = 1
    coil: float = 0.0

    @property
    def section(self) -> float:
        """Of all together (m2)."""
        return self.parallel * 0.25 * math.pi * self.diameter**2

    @property
    def volume(self) -> float:
        """m3"""
        return self.section * self.length

    @property
    def wall(self) -> float:
        """Wetted area (m2)."""
        return self.parallel * math.pi * self.diameter * self.length

    def film(self, flow: float, fluid: Fluid) -> tuple[float, Info]:
        """h (W/m2/K) at a flow (m3/s)."""
        return duct_film(flow / self.section, self.diameter, self.length, fluid)


@dataclass(frozen=True)
class Nozzles:
    """Equal nozzles and the face under them.

    diameter : of a nozzle (m);  wall : area of the face (m2);  run : way of the oil along it (m)
    drip : whether oil falls from them without a jet
    """

    number: int
    diameter: float
    wall: float
    run: float
    drip: bool = False
    bends: int = 0
    coil: float = 0.0

    @property
    def section(self) -> float:
        """Of all nozzles (m2)."""
        return self.number * 0.25 * math.pi * self.diameter**2

    @property
    def length(self) -> float:
        """Of a nozzle (m)."""
        return BORE * self.diameter

    @property
    def volume(self) -> float:
        """Of the oil on the face (m3)."""
        return FILM_M * self.wall

    def film(self, flow: float, fluid: Fluid) -> tuple[float, Info]:
        """h (W/m2/K) at a flow (m3/s)."""
        return sprayed_face(flow, self.number, self.diameter, self.wall, self.run, fluid, self.drip)


def friction(Re: float, relative_roughness: float = 0.0) -> float:
    """Darcy factor: 64/Re up to Re 2300, Clamond's solution of Colebrook's equation above 4000, linear between.

    Source: Colebrook 1939, solved by Clamond 2009 (fluids); the bridge is the one of the film (Gnielinski 2013).
    """
    import fluids

    share = min(max((Re - LAMINAR) / (TURBULENT - LAMINAR), 0.0), 1.0)
    out = (1.0 - share) * fluids.friction.friction_laminar(max(min(Re, LAMINAR), 1e-12))
    return out + (share * fluids.friction.Clamond(max(Re, TURBULENT), relative_roughness) if share > 0.0 else 0.0)


def helical_friction(Re: float, diameter: float, coil: float, relative_roughness: float = 0.0) -> float:
    """Darcy factor of a coiled channel, by Schmidt 1967 (fluids): laminar, and turbulent above his critical Re."""
    import fluids

    critical = fluids.helical_transition_Re_Schmidt(diameter, coil)
    if critical >= Re:
        return fluids.friction.helical_laminar_fd_Schmidt(max(Re, 1e-12), diameter, coil)
    top = COIL_BRIDGE * critical
    share = min((Re - critical) / (top - critical), 1.0)
    low = fluids.friction.helical_laminar_fd_Schmidt(critical, diameter, coil)
    high = fluids.friction.helical_turbulent_fd_Schmidt(max(Re, top), diameter, coil, relative_roughness)
    return (1.0 - share) * low + share * high


def pressure_drop(duct: Passage, flow: float, fluid: Fluid, roughness: float = ROUGHNESS) -> float:
    """Along a duct (Pa), with a sharp entrance, its bends and its exit; flow (m3/s) through all parallel channels."""
    import fluids

    speed = abs(flow) / duct.section
    Re = speed * duct.diameter / fluid.nu
    if Re == 0.0:
        return 0.0
    relative = roughness / duct.diameter
    f = helical_friction(Re, duct.diameter, duct.coil, relative) if duct.coil else friction(Re, relative)
    bend = fluids.fittings.bend_miter_Miller(Di=duct.diameter, angle=90.0, Re=max(Re, 1e4), roughness=roughness)
    loss = f * duct.length / duct.diameter + duct.bends * bend + fluids.entrance_sharp() + fluids.exit_normal()
    return fluids.dP_from_K(loss, fluid.rho, speed)


def parallel_shares(branches: Sequence[Sequence[Passage]], flow: float, fluid: Fluid) -> tuple[float, ...]:
    """How a flow (m3/s) splits between branches of ducts in series so that all drop the same pressure."""
    from scipy.optimize import brentq

    def drop(branch: Sequence[Passage], q: float) -> float:
        return sum(pressure_drop(duct, q, fluid) for duct in branch)

    def flow_at(branch: Sequence[Passage], p: float) -> float:
        return 0.0 if p <= 0.0 else float(brentq(lambda q: drop(branch, q) - p, 0.0, flow, xtol=1e-14, rtol=1e-12))

    top = min(drop(branch, flow) for branch in branches)
    if len(branches) == 1 or flow == 0.0:
        return (1.0 / len(branches),) * len(branches)
    p = float(brentq(lambda p: sum(flow_at(b, p) for b in branches) - flow, 0.0, top, rtol=1e-12))
    total = sum(flow_at(b, p) for b in branches)
    return tuple(flow_at(b, p) / total for b in branches)


def split(branches: Sequence[Sequence[Passage]], low: float, high: float, fluid: Fluid) -> tuple[Array, Array]:
    """Logarithm of the flow (n,) from `low` to `high` (m3/s), and the share of each branch (branches, n), as above.

    Shares depend on the flow over the kinematic viscosity alone: one split holds for a fluid at every temperature.
    """
    even, curves = np.geomspace(low * SLOWEST, high, POINTS), []
    for branch in branches:
        kinks = [q for duct in branch for q in _kinks(duct, fluid) if even[0] < q < even[-1]]
        flows = np.union1d(even, kinks)
        drops = [sum(pressure_drop(duct, float(q), fluid) for duct in branch) for q in flows]
        curves.append((np.log(drops), np.log(flows), np.isin(flows, kinks)))
    first, last = max(drops[0] for drops, *_ in curves), min(drops[-1] for drops, *_ in curves)
    bends = np.concatenate([drops[kink] for drops, _, kink in curves])
    p = np.union1d(np.linspace(first, last, POINTS), bends[(first < bends) & (bends < last)])
    each = np.exp([np.interp(p, drops, flows) for drops, flows, _ in curves])
    total, some = np.unique(each.sum(axis=0), return_index=True)
    shares = each[:, some] / total
    needed = _needed(np.log(total), shares, 0, len(total) - 1)
    return np.log(total[needed]), shares[:, needed]


def _kinks(duct: Passage, fluid: Fluid) -> list[float]:
    """Flows (m3/s) at which the friction of a duct bends: where turbulence begins and where all of it is turbulent."""
    import fluids

    if duct.coil:
        critical = fluids.helical_transition_Re_Schmidt(duct.diameter, duct.coil)
        numbers = [critical, COIL_BRIDGE * critical, COIL_JUMP * (1 - 1e-9), COIL_JUMP * (1 + 1e-9)]
    else:
        numbers = [LAMINAR, TURBULENT]
    return [Re * fluid.nu / duct.diameter * duct.section for Re in numbers]


def _needed(x: Array, y: Array, first: int, last: int) -> list[int]:
    """Points of curves y (curves, n) between which they are straight lines, to STRAIGHT of themselves."""
    s = (x[first : last + 1] - x[first]) / (x[last] - x[first])
    part = y[:, first : last + 1]
    off = np.abs(part[:, :1] + s * (part[:, -1:] - part[:, :1]) - part) / part
    worst = int(off.max(axis=0).argmax())
    if off.max() <= STRAIGHT:
        return [first, last]
    return [*_needed(x, y, first, first + worst)[:-1], *_needed(x, y, first + worst, last)]


def pumping_power(pressure: float, flow: float, efficiency: float = 0.5) -> float:
    """Power taken (W): pressure (Pa) times flow (m3/s) over the efficiency of pump or fan with its motor."""
    return pressure * flow / efficiency
