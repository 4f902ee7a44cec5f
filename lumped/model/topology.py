"""What a network shows without a word being read: bodies, fluids, how they hang together, what heat goes in where."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from lumped.transfer.laws import CONSTANT
from lumped.transfer.terms_value import temperature_value

if TYPE_CHECKING:
    from lumped.model.structure import Link, Structure

SHARE = 0.2  # of a loss: a node that gets less of it is not the place where it is made
FRICTION = frozenset({"friction", "bearing"})
RUBBING = FRICTION | {"windage"}
REFERENCE_K = 30.0  # difference over which a film of free convection is looked at
Node = TypeVar("Node")


def reached(start: Iterable[Node], near: Callable[[Node], Iterable[Node]]) -> dict[Node, int]:
    """What joints lead to from some nodes, themselves included, and over how many.  near : a node's neighbours"""
    out: dict[Node, int] = dict.fromkeys(start, 0)
    edge, steps = [*out], 0
    while edge:
        steps += 1
        edge = [*dict.fromkeys(y for x in edge for y in near(x) if y not in out)]
        out |= dict.fromkeys(edge, steps)
    return out


@dataclass(frozen=True)
class Topology:
    """The network's own links and sources; those that effects and disturbances brought are left out."""

    network: Structure

    @cached_property
    def links(self) -> tuple[Link, ...]:
        return tuple(x for x in self.network.links if not x.origin)

    @cached_property
    def bodies(self) -> tuple[str, ...]:
        """Parts and nodes that no stream passes and that are not fluid."""
        solid = {p.part: None for p in self.network.places.values() if p.kind in ("part", "node")}
        return tuple(b for b in solid if b not in self.fluids)

    @cached_property
    def fluids(self) -> tuple[str, ...]:
        fluids = [p.name for p in self.network.places.values() if p.kind == "fluid" and p.name in self.network.states]
        passed = [self.part(x.places[1]) for x in self.links if x.kind == "stream"]
        return tuple(dict.fromkeys((*fluids, *(p for p in passed if p in self.network.states))))

    def part(self, place: str) -> str:
        site = self.network.places.get(place)
        return place if site is None or site.kind == "fluid" else site.part

    @cached_property
    def pairs(self) -> tuple[tuple[str, str, Link], ...]:
        """Ends of every link but conduction inside a part and streams."""
        ends = [(self.part(x.places[0]), self.part(x.places[1]), x) for x in self.links if x.kind != "stream"]
        return tuple(pair for pair in ends if pair[0] != pair[1])

    @cached_property
    def neighbours(self) -> Mapping[str, frozenset[str]]:
        """Whatever any link joins it to."""
        out: dict[str, set[str]] = {}
        for a, b, _ in self.pairs:
            out.setdefault(a, set()).add(b)
            out.setdefault(b, set()).add(a)
        return {name: frozenset(others) for name, others in out.items()}

    @cached_property
    def joints(self) -> Mapping[tuple[str, str], float]:
        """Pairs of bodies, either way round -> conductance (W/K) that follows nothing."""
        out: dict[tuple[str, str], float] = {}
        for a, b, link in self.pairs:
            if {a, b} <= set(self.bodies) and fixed(link):
                for pair in ((a, b), (b, a)):
                    out[pair] = out.get(pair, 0.0) + conductance(self.network, link)
        return out

    def joined(self, body: str) -> list[str]:
        return [b for (a, b), _ in self.joints.items() if a == body]

    @cached_property
    def heat(self) -> Mapping[str, frozenset[str]]:
        """Body or fluid -> kinds of the losses that are made there."""
        out: dict[str, set[str]] = {}
        for place, kind, _ in self._losses():
            out.setdefault(place, set()).add(kind)
        return {name: frozenset(kinds) for name, kinds in out.items()}

    def carries(self, body: str, *kinds: str) -> bool:
        return not self.heat.get(body, frozenset()).isdisjoint(kinds)

    @cached_property
    def bearings(self) -> tuple[str, ...]:
        """Bodies in which friction is made, and no loss of the field or of a winding; what runs between two is none."""
        return tuple(b for b in self._rubbing if b not in self.journals)

    @cached_property
    def journals(self) -> tuple[str, ...]:
        """Bodies with friction that are joined to two others with friction: what runs in both."""
        return tuple(b for b in self._rubbing if sum(other in self._rubbing for other in self.joined(b)) > 1)

    @cached_property
    def _rubbing(self) -> tuple[str, ...]:
        return tuple(b for b in self.bodies if self.carries(b, *FRICTION) and self.heat[b] <= RUBBING)

    @cached_property
    def reads(self) -> Mapping[tuple[str, str], frozenset[str]]:
        """(place, kind of loss) -> the inputs that this heat follows."""
        out: dict[tuple[str, str], frozenset[str]] = {}
        for place, kind, reads in self._losses():
            out[place, kind] = out.get((place, kind), frozenset()) | reads
        return out

    def _losses(self) -> Iterator[tuple[str, str, frozenset[str]]]:
        network, owner = self.network, self._owner
        for source in (s for s in network.sources if not s.origin):
            got: dict[str, float] = {}
            for index, weight in zip(source.index, source.weights, strict=True):
                got[owner[int(index)]] = got.get(owner[int(index)], 0.0) + abs(float(weight))
            most = max(got.values(), default=0.0)
            for place, share in got.items():
                if share >= SHARE * most:
                    yield place, source.kind, frozenset(source.law.reads)

    @cached_property
    def _owner(self) -> dict[int, str]:
        """State -> the part that its heat capacity belongs to, or itself."""
        owner = dict(enumerate(self.network.states))
        groups = self.network.capacity_group
        return owner | {i: group for i, group in enumerate(groups) if group}

    def outer(self, boundary: str) -> list[tuple[str, Link]]:
        """Bodies and fluids that a boundary meets, with the link."""
        ends = [(a, b, x) for a, b, x in self.pairs if boundary in (a, b)]
        return [(b if a == boundary else a, x) for a, b, x in ends]


def fixed(link: Link) -> bool:
    """Does its conductance follow neither input nor temperature?"""
    return not link.law.reads and link.law.temperature == CONSTANT


def conductance(network: Structure, link: Link) -> float:
    """W/K between the means of its ends, REFERENCE_K apart; 0 of a link that follows an input."""
    if link.law.reads:
        return 0.0
    ends = [network.places[p].states[0] if p in network.places else network.column(p) for p in link.places]
    state = min(int(i) for i in ends)
    at = (link.rows == state) & (link.cols == state)
    warm = temperature_value(link.law.temperature, REFERENCE_K + 20.0, 20.0)
    return float(link.vals[at].sum()) * float(link.law.factor({})) * float(warm)
