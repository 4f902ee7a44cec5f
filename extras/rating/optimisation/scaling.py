"""What another geometry does to a network without a new condensation: its films, wetted areas and masses.

Conduction stays that of the reference; what its change does is learned apart (corrections.py).
"""

from collections.abc import Mapping

import numpy as np

from thermoscope import Network, Parameter, plugin as th

DIFFERENCE_K = 30.0  # at which still films of two sizes are compared: both go with the difference to the same power


def design_parameters(network: Network) -> list[Parameter]:
    """A neutral multiplier for every film and every capacity, for `Scaling` to set."""
    films = [link.name for link in network.links if link.kind == "film"]
    groups = [f"capacity:{g}" for g in dict.fromkeys(network.capacity_group)]
    return [Parameter(f"design {t}", ((t, 1.0),), source="a design") for t in (*films, *groups)]


class Scaling:
    """Of the network of one machine; what the machine itself is needs to be looked at once."""

    def __init__(self, network: Network, machine: th.MachineDescription) -> None:
        self.machine, self.places = machine, [p for p in network.places.values() if p.kind == "surface" and p.fluid]
        self.volumes = {p.name: p.volume for p in machine.parts}
        self.liquids = {p.name for p in machine.fluids if p.material != "air"}
        self.here = Films(th.surroundings(machine, ()))
        self.known = {f"design {link.name}" for link in network.links}

    def of(self, machine: th.MachineDescription, inputs: Mapping[str, float]) -> dict[str, float]:
        """Values of `design_parameters` that make the network one of another machine, at an operating point.

        Only faces are looked at whose part or fluid has another shape.
        """
        before = {p.name: p.prisms for p in (*self.machine.parts, *self.machine.fluids)}
        differing = {p.name for p in (*machine.parts, *machine.fluids) if before.get(p.name) != p.prisms}
        if not differing:
            return {}
        there = Films(th.surroundings(machine, ()))
        out = {
            f"design capacity:{p.name}": p.volume / self.volumes[p.name] for p in machine.parts if p.name in differing
        }
        for face in self.places:
            if face.part in differing or th.stem(str(face.fluid)) in differing:
                out |= self._face(face, there, inputs)
        return out

    def _face(self, face: th.Place, there: "Films", inputs: Mapping[str, float]) -> dict[str, float]:
        fluid = th.stem(str(face.fluid))
        areas = self.area_ratio(there, face.part, fluid)
        if fluid in self.liquids:
            cell = sum(p.area or 0.0 for p in self.places if p.fluid == face.fluid)
            each = ((self.here, 1.0), (there, areas))
            a, b = (_conductance(w.around, fluid, cell * s, inputs) for w, s in each)
            return {f"design film:{face.name}": b / a if a > 0.0 else areas}
        old, new = (w.laws(face.part, fluid) for w in (self.here, there))
        names = {m: f"design film:{face.name}" + (f":{m}" if m else "") for m in old}
        ratio = {m: _value(new[m], inputs) / max(_value(old[m], inputs), 1e-12) for m in old if m in new}
        return {names[m]: areas * r for m, r in ratio.items() if names[m] in self.known}

    def area_ratio(self, there: "Films", part: str, fluid: str) -> float:
        """Of the faces between a part and a fluid: a jacket's by its own walls, the rest by those of the part."""
        name = fluid if fluid in self.liquids else part
        return there.walls(name) / self.here.walls(name)


class Films:
    """Films and walls of a machine's parts, worked out once each: many faces of a part are alike."""

    def __init__(self, around: th.Surroundings) -> None:
        self.around = around
        self._laws: dict[tuple[str, str], Mapping[str, th.Law]] = {}
        self._walls: dict[str, float] = {}

    def laws(self, part: str, fluid: str) -> Mapping[str, th.Law]:
        """Mechanism -> law of its faces to a fluid."""
        if (part, fluid) not in self._laws:
            self._laws[part, fluid] = th.face_films(part, fluid, self.around)
        return self._laws[part, fluid]

    def walls(self, part: str) -> float:
        """Area (m2) of a part's walls."""
        if part not in self._walls:
            self._walls[part] = _walls(self.around.machine.part(part))
        return self._walls[part]


def _conductance(where: th.Surroundings, jacket: str, area: float, inputs: Mapping[str, float]) -> float:
    """Of one cell's walls onto what leaves it (W/K)."""
    cooling = where.cooling
    assert cooling is not None
    return area * float(th.onto_outlet(where.machine, jacket, cooling, area).size({th.FLOW: np.array(inputs[th.FLOW])}))


def _value(law: th.Law, inputs: Mapping[str, float]) -> float:
    at = {name: np.array([float(u)]) for name, u in inputs.items()}
    return th.coefficient(law, at, 20.0 + DIFFERENCE_K, 20.0)


def _walls(part: th.Part) -> float:
    """Area (m2) of all walls along the axis, and of the ends of rings."""
    sides = sum(th.loop_length(loop) * (z1 - z0) for profile, z0, z1 in part.prisms for loop in profile.loops)
    return float(sides + sum(2.0 * profile.area for profile, _, _ in part.prisms if profile.holes))
