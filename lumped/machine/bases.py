"""Bases that a machine stands on in some tests only: [bases] of a machine file, see geom.description.bases.

The input "on_NAME" is 1 while the machine stands on that base. Then its foot conducts; while it is 0 the footprint on
the machine meets the surroundings as the face around it does.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from geom.description.bases import PIECES, THIS_MACHINE
from geom.description.machine import Machine
from geom.description.roles import Role
from lumped.model.network import Link, Network, Place
from lumped.transfer.laws import Array, Inputs, Wrapped


@dataclass(frozen=True)
class Switched(Wrapped):
    """Another law, in force while an input is 1 (closed) or while it is 0 (not closed)."""

    switch: str
    closed: bool

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.base.reads, self.switch)

    def factor(self, inputs: Inputs) -> Array | float:
        on = np.asarray(inputs[self.switch], float)
        return np.asarray(self.base.factor(inputs) * (on if self.closed else 1.0 - on))


def unused(machine: Machine, inputs: Mapping[str, Array | float]) -> list[str]:
    """Feet and bases that it does not stand on at any instant, by a test's inputs."""
    bases = machine.sections.get("bases", {}).items()
    off = [name for name, _ in bases if not np.any(inputs.get(f"on_{name}", 1.0))]
    return [piece if of == THIS_MACHINE else f"{piece}.{name}" for name, of in bases if name in off for piece in PIECES]


def on_all(machine: Machine) -> Machine:
    """The machine standing on all its bases at once, as its mesh has it: what its field is compared with."""
    return replace(machine, sections={k: v for k, v in machine.sections.items() if k != "bases"})


def on_every_base(network: Network) -> Network:
    """The network at its nominal values on all bases at once, as `on_all` has the machine; any other as it is."""
    if not any(isinstance(x.law, Switched) for x in network.links):
        return network
    present = [x for x in network.links if not isinstance(x.law, Switched) or x.law.closed]
    links = [replace(x, law=x.law.base) if isinstance(x.law, Switched) else x for x in present]
    bare = {x.places[0] for x in network.links if isinstance(x.law, Switched) and not x.law.closed}
    places = {name: place for name, place in network.places.items() if name not in bare}
    return replace(network, links=tuple(links), places=places, parameters=())


def switched(machine: Machine, network: Network) -> Network:
    """The network with every base coupled by its input."""
    for name, of in machine.sections.get("bases", {}).items():
        network = _coupled(network, f"on_{name}", "foot" if of == THIS_MACHINE else f"foot.{name}")
    return network


def _coupled(network: Network, switch: str, foot: str) -> Network:
    joints = (x for x in network.links if x.kind == "contact" and foot in x.places)
    joint = next(x for x in joints if not any(network.declared[place].role is Role.BASE for place in x.places))
    body = next(place for place in joint.places if place != foot)
    links = [replace(x, law=Switched(x.law, switch, True)) if x is joint else x for x in network.links]
    states = [i for i, state in enumerate(network.states) if state == body or state.startswith(f"{body}#")]
    at = {state: k for k, state in enumerate(states)}
    K = np.zeros((len(states), len(states)))
    for row, col, value in zip(joint.rows, joint.cols, joint.vals, strict=True):
        if int(row) in at and int(col) in at:
            K[at[int(row)], at[int(col)]] += value
    print_ = Place(f"{foot}.print", "surface", body, np.array(states), K, K[:, 0].copy(), float(K[0, 0]), "ambient")
    larger = replace(network, links=tuple(links), places={**network.places, print_.name: print_})
    films = [x for x in network.links if x.name.startswith(f"film:{body}.outer") and x.places[1] == "ambient"]
    bare = [_bare(larger, film, print_, switch) for film in films]
    copies = {film.name: link.name for film, link in zip(films, bare, strict=True)}
    # What acts on a film acts on its share of the footprint too.
    more = [(p, [(copies[of], exponent) for of, exponent in p.targets if of in copies]) for p in network.parameters]
    parameters = tuple(replace(p, targets=(*p.targets, *shares)) for p, shares in more)
    return replace(larger.extended(bare), parameters=parameters)


def _bare(network: Network, film: Link, face: Place, switch: str) -> Link:
    """The film of the face around it on the footprint while no foot is there."""
    name = film.name.replace(film.places[0], face.name)
    return network.surface_link(name, "contact", face.name, "ambient", Switched(film.law, switch, False))
