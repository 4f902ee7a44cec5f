"""Oil on end windings: nozzles above a part, and the oil that leaves through the end space.

[spray] in a machine file: coolant, flow_L_per_min, inlet_C, and PART = { nozzles = 8, nozzle_mm = 1.5, run_mm = 60 }
for every part under nozzles. The inlet is boundary "oil", the flow the input "oil_l_min"; all nozzles hang on one rail.
The end space is what the oil leaves as: its node is as warm as the oil that runs off.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from geom.constants import L_MIN
from geom.description.machine import Machine
from geom.description.roles import Role
from lumped.circuits.hydraulics import Nozzles
from lumped.correlations.info import Info
from lumped.correlations.streams import restretched, streamed, warmed
from lumped.declarations.films import read_coolant
from lumped.machine.shapes import radius
from lumped.model.build import mean_row, stream
from lumped.model.network import NOTHING, Link, Network, Place
from lumped.schemas.reader import Table, suggestion
from lumped.transfer.coolant import Coolant
from lumped.transfer.laws import InputPower
from lumped.transfer.properties import Fluid
from lumped.transfer.reversal import OneWay
from lumped.transfer.streamed import Streamed

RAIL, OIL_FLOW = "oil", "oil_l_min"
SPRAY, OIL_STREAM = ":spray", "stream:oil:"  # how names of its films end, and those of its streams begin
WARMER_K = 10.0  # than its inlet the oil is usually, where it takes up the rated losses


@dataclass(frozen=True)
class Spray:
    """faces : part -> the nozzles above it;  usual_C : where its films are tabulated around"""

    where: str
    coolant: Coolant
    flow_l_min: float
    usual_C: float
    faces: Mapping[str, Nozzles]
    spaces: frozenset[str]

    def __hash__(self) -> int:
        return hash((self.where, self.flow_l_min, self.usual_C, *self.faces.items()))

    @property
    def rate(self) -> float:
        """Heat capacity rate (W/K) of 1 l/min at the usual temperature."""
        fluid = self.coolant(self.usual_C)
        return fluid.rho * fluid.cp * L_MIN

    def share(self, part: str) -> float:
        """Of the flow: as the sections of the nozzles, which hang on one rail."""
        return self.faces[part].section / math.fsum(n.section for n in self.faces.values())

    def wets(self, part: str, fluid: str) -> bool:
        """Is it a face under nozzles?"""
        return part in self.faces and fluid in self.spaces

    def film(self, part: str) -> Streamed:
        """W/m2/K over the flow (l/min), onto what leaves the end space."""
        nozzles, share, usual = self.faces[part], self.share(part), self.coolant(self.usual_C)
        stretch = nozzles.wall / (self.rate * share)

        def film(flow: float, fluid: Fluid) -> tuple[float, Info]:
            h, info = nozzles.film(share * flow * L_MIN, fluid)
            heat = fluid.rho * fluid.cp / (usual.rho * usual.cp)
            return h * restretched(h * stretch / max(flow, 1e-300), heat), info

        return streamed(OIL_FLOW, self.flow_l_min, film, self.coolant, self.usual_C, True, stretch=stretch)

    def link(self, network: Network, face: Place) -> Link:
        """From a face onto the oil that leaves, by the mean of what comes and what leaves."""
        space = str(face.fluid)
        one = network.surface_link(f"film:{face.name}{SPRAY}", "film", face.name, space, self.film(face.part))
        return replace(one, hot=mean_row(network, [RAIL, space]), cold=NOTHING)

    def streams(self, network: Network, faces: Sequence[Place]) -> list[Link]:
        """From the rail into every end space, what its nozzles give."""
        shares: dict[str, float] = {}
        for part in self.faces:
            wet = [f for f in faces if f.part == part and self.wets(part, str(f.fluid))]
            if wet:
                most = max(wet, key=lambda f: f.area or 0.0)
                shares[str(most.fluid)] = shares.get(str(most.fluid), 0.0) + self.share(part)
        middle = mean_row(network, [node for space in shares for node in (RAIL, space)]) if shares else NOTHING
        right, warm = "a flow from the nozzles into the end space", warmed(self.coolant, self.usual_C)
        out = []
        for space, share in shares.items():
            rate = InputPower(self.rate * share, ((OIL_FLOW, 1.0, 1.0),), warm)
            law = OneWay(rate, OIL_FLOW, self.where, right, self.flow_l_min)
            out.append(replace(stream(network, f"{OIL_STREAM}{space}", (RAIL, space), law), hot=middle, cold=NOTHING))
        return out


def spray_of(machine: Machine) -> Spray | None:
    """[spray], if the machine has one."""
    if "spray" not in machine.sections:
        return None
    t = Table(machine.sections["spray"], f"{machine.name} [spray]")
    coolant, flow, usual = read_coolant(t), t.number("flow_L_per_min"), t.number("inlet_C", 70.0) + WARMER_K
    names = {part.name for part in machine.parts}
    faces = {key: _nozzles(machine, key, Table(t.raw(key), f"{t.where} {key}")) for key in t.data if key in names}
    t.close()
    if not faces:
        raise t.error("no part under nozzles", f"PART = {{ nozzles = ... }}; {suggestion('winding', names)}")
    spaces = frozenset(part.name for part in machine.fluids if part.role is Role.INNER_AIR)
    return Spray(t.where, coolant, flow, usual, faces, spaces)


def _nozzles(machine: Machine, part: str, table: Table) -> Nozzles:
    sizes = 1e-3 * table.number("nozzle_mm"), _around(machine, part), 1e-3 * table.number("run_mm")
    out = Nozzles(int(table.number("nozzles")), *sizes, table.flag("drip", False))
    table.close()
    return out


def _around(machine: Machine, part: str) -> float:
    """Area (m2) of a ring, on all sides."""
    prisms = machine.part(part).prisms
    outer = max(radius(profile.outer) for profile, _, _ in prisms)
    inner = min(math.hypot(x, y) for profile, _, _ in prisms for loop in profile.loops for x, y, _ in loop)
    low, high = machine.part(part).span
    return 2.0 * math.pi * (outer + inner) * (high - low + outer - inner)
