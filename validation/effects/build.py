"""The few ways an effect changes a network: a link, a source, a copy of what is there."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from lumped.model.network import Link, Network, Parameter, Place, Row, Source
from lumped.model.sites import faces
from lumped.transfer.laws import CONSTANT, Array, Inputs, Law, TemperatureLaw, Wrapped

HOUR = 3600.0


@dataclass(frozen=True)
class Shaped(Wrapped):
    """Another law's input factor times `shape(inputs)`, with a temperature law of its own."""

    shape: Callable[[Inputs], Array | float]
    temperature: TemperatureLaw = CONSTANT
    also_reads: tuple[str, ...] = ()
    by_instant: bool = False

    @classmethod
    def of(cls, law: Law, shape: Callable[[Inputs], Array | float], *inputs: str) -> "Shaped":
        """A law times a shape that reads some more inputs, with the law's own dependence on temperature."""
        return cls(law, shape, law.temperature, inputs)

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (*self.base.reads, *self.also_reads)

    def factor(self, inputs: Inputs) -> Array | float:
        return self.base.factor(inputs) * self.shape(inputs)


def conductance_scale(network: Network) -> float:
    """A conductance (W/K) of this machine's size: what cools all of it with its time constant."""
    return float(np.sum(network.C)) / network.settles_s


def power_scale(network: Network) -> float:
    """A power (W) of this machine's size: 10 K of rise through `conductance_scale`."""
    return 10.0 * conductance_scale(network)


def row_of(network: Network, name: str) -> Row:
    """Mean temperature of a place, state or boundary as a row over z."""
    if name in network.places:
        return network.places[name].mean
    return Row(np.array([network.column(name)]), np.array([1.0]))


def place_pair(network: Network, place: str) -> tuple[str, str]:
    """A and B of the place "A|B" of an effect; a name may have the sign in it, too."""
    places = {*network.places, *network.states, *network.boundaries}
    cuts = [(place[:i], place[i + 1 :]) for i, letter in enumerate(place) if letter == "|"]
    return next((pair for pair in cuts if places.issuperset(pair)), cuts[0])


def exchange(network: Network, name: str, a: str, b: str, law: Law) -> Link:
    """A link g (T_a - T_b) between the means of two places, states or boundaries."""
    ra, rb = row_of(network, a), row_of(network, b)
    index = np.concatenate([ra.index, rb.index])
    weights = np.concatenate([ra.weights, -rb.weights])
    state = index < len(network.states)
    rows, cols = np.meshgrid(index[state], index, indexing="ij")
    vals = np.outer(weights[state], weights)
    return Link(name, "link", (a, b), rows.ravel(), cols.ravel(), vals.ravel(), law, ra, rb, name)


def label(element: Link | Source) -> str:
    """Its name without what it is: of "contact:core|housing" what follows the first colon."""
    return element.name.split(":", 1)[-1]


def links_between(network: Network, a: str, b: str) -> list[Link]:
    """Links between two parts, boundaries or places of theirs."""
    pair = {_part(network, a), _part(network, b)}
    return [x for x in network.links if {_part(network, p) for p in x.places} == pair]


def losses_at(network: Network, place: str) -> list[Source]:
    """Losses of the part that a place belongs to."""
    return [s for s in network.sources if _part(network, s.place) == _part(network, place)]


def _part(network: Network, place: str) -> str:
    return network.places[place].part if place in network.places else place


def to_fluid(network: Network, name: str, part: str, fluid: str, law: Law) -> list[Link]:
    """Film links from every face of a part on a fluid (law in W/m2/K), or one from a bare node (law in W/K)."""
    wet = faces(network, part, fluid)
    return films(network, name, wet, fluid, law) if wet else [exchange(network, name, part, fluid, law)]


def films(network: Network, name: str, wet: Iterable[Place], fluid: str, law: Law) -> list[Link]:
    """Film links from some faces to a fluid (law in W/m2/K)."""
    links = [network.surface_link(f"{name}:{face.name}", "film", face.name, fluid, law) for face in wet]
    return [replace(link, origin=name) for link in links]


def film_unit(network: Network, part: str, fluid: str) -> tuple[str, float]:
    """Unit of a coefficient there, and how much larger its numbers are than in W/m2/K."""
    bare = not faces(network, part, fluid)
    return ("W/K", conductance_scale(network) / 20.0) if bare else ("W/m2/K", 1.0)


def heat(network: Network, name: str, kind: str, place: str, law: Law) -> Source:
    """Heat into the mean of a place."""
    row = row_of(network, place)
    return Source(name, kind, place, row.index, row.weights, law, row, name)


def follow(parameters: tuple[Parameter, ...], original: str, copy: str) -> tuple[Parameter, ...]:
    """Parameters that also act on the copy of a link or source as they do on the original."""
    more = [tuple((copy, e) for t, e in p.targets if t == original) for p in parameters]
    return tuple(replace(p, targets=p.targets + m) if m else p for p, m in zip(parameters, more, strict=True))


def copy_element(network: Network, element: Link | Source, name: str, law: Law) -> Network:
    """The network with a second link or source of the same pattern that follows the original's multipliers."""
    copy = replace(element, name=name, law=law, origin=name)
    larger = network.extended(links=[copy]) if isinstance(copy, Link) else network.extended(sources=[copy])
    return replace(larger, parameters=follow(network.parameters, element.name, name))


def copy_elements(network: Network, copies: Mapping[str, tuple[Link | Source, Law]]) -> Network:
    """The network with a copy of each of some links and sources.  copies : name of the copy -> original, its own law"""
    for name, (element, law) in copies.items():
        network = copy_element(network, element, name, law)
    return network
