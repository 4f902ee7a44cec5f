"""Where on a network things can sit, by what its parts, fluids and boundaries are: see `Network.identities`."""

from collections.abc import Collection, Iterable, Iterator

from geom.description.roles import Identity, Role
from lumped.model.network import Link, Network, Place, Source
from lumped.model.once import once

AXLE = frozenset({Role.BEARING, Role.SHAFT})
FIELD = frozenset({Role.IRON, Role.WINDING, Role.MAGNET, Role.ROTOR, Role.CAGE, Role.INSULATION, Role.COMMUTATOR})
ASSUMED, ASSUMED_W = "loss:assumed", 100.0  # of a machine that declares no losses, so that it can be looked at
NOBODY = Identity(why="nothing tells")


def identity(network: Network, place: str) -> Identity:
    """What a place, or the part it belongs to, is."""
    identities = network.identities
    return identities.get(place) or identities.get(part_of(network, place), NOBODY)


def role(network: Network, place: str) -> Role | None:
    return identity(network, place).role


def turns(network: Network, place: str) -> bool:
    """Is it known to turn?"""
    return identity(network, place).turns is True


def stands(network: Network, place: str) -> bool:
    """Is it known to stand still?"""
    return identity(network, place).turns is False


def boundaries(network: Network, *roles: Role) -> list[str]:
    return [b for b in network.boundaries if role(network, b) in roles]


@once
def ambient(network: Network) -> str | None:
    """The boundary that stands for the surroundings; of several the one that washes most."""
    air = boundaries(network, Role.AMBIENT)
    return max(air, key=lambda b: len(washed(network, b))) if air else None


def solids(network: Network) -> list[Place]:
    """Parts of a condensed network, nodes of a declared one: what has a temperature and a mass of its own."""
    return [p for p in network.places.values() if p.kind in ("part", "node") and network.C[p.states[0]] > 0]


def fluids(network: Network, *roles: Role) -> list[str]:
    return [p.name for p in network.places.values() if p.kind == "fluid" and role(network, p.name) in roles]


def faces(network: Network, part: str, fluid: str) -> list[Place]:
    """The surfaces of a part that one fluid washes."""
    return [p for p in network.places.values() if p.kind == "surface" and p.part == part and p.fluid == fluid]


def touches(network: Network, place: str, other: str) -> bool:
    return any({place, other} == set(link.places) for link in standing_links(network))


def washed(network: Network, fluid: str) -> list[str]:
    """Parts with a face on the fluid; of a declared network the nodes said or linked to be in it."""
    parts = {p.part: None for p in network.places.values() if p.kind == "surface" and p.fluid == fluid}
    nodes = [p.name for p in solids(network) if p.kind == "node"]
    bare = [n for n in nodes if network.places[n].fluid == fluid or touches(network, n, fluid)]
    return [*parts, *(n for n in bare if n not in parts)]


def outside(network: Network) -> list[str]:
    """Where the surroundings can be felt. A declared network that says nothing about it: any node."""
    air = ambient(network)
    if air is None:
        return []
    return washed(network, air) or [p.name for p in solids(network) if p.kind == "node"]


def with_role(network: Network, *roles: Role) -> list[str]:
    """Solids that are known, or guessed, to be one of these."""
    return [p.name for p in solids(network) if role(network, p.name) in roles]


def roleless(network: Network) -> list[str]:
    """Solids of which nothing says what they are."""
    return [p.name for p in solids(network) if role(network, p.name) is None]


def turning(network: Network) -> list[str]:
    """Solids that turn, but for what insulates; where nothing is known to turn, all that are not known to stand."""
    names = [p.name for p in solids(network) if role(network, p.name) is not Role.INSULATION]
    return [n for n in names if turns(network, n)] or [n for n in names if not stands(network, n)]


def cores(network: Network) -> list[str]:
    """Solids that carry the field in iron; where none is known, all whose role is not known."""
    return with_role(network, Role.IRON, Role.ROTOR) or roleless(network)


def windings(network: Network) -> list[str]:
    """Solids that are wound; where none is known, all whose role is not known."""
    return with_role(network, Role.WINDING) or roleless(network)


def bearings(network: Network) -> list[str]:
    """Bearings; without any, what joins turning to standing parts, or the end shields, or all but the field's parts."""
    parts = with_role(network, Role.BEARING)
    if parts:
        return parts
    names, near = [p.name for p in solids(network)], neighbours(network)
    still = [n for n in names if stands(network, n)]
    between = [n for n in still if any(turns(network, b) for b in near.get(n, set()) if b in names)]
    joints = [n for n in between if role(network, n) not in FIELD]
    return joints or with_role(network, Role.END_SHIELD) or [n for n in names if role(network, n) not in FIELD]


def commutators(network: Network) -> list[str]:
    """The commutator; without one, turning parts that a winding turns with, for only those can have brushes."""
    parts = with_role(network, Role.COMMUTATOR)
    wound = any(turns(network, n) for n in with_role(network, Role.WINDING))
    return parts or ([n for n in turning(network) if role(network, n) not in AXLE] if wound else [])


def heated(network: Network, kind: str, others: Collection[str]) -> list[str]:
    """Places of a loss of this kind, and nodes that it heats by whatever share; without such a loss, the others."""
    sources = [s for s in network.sources if s.kind == kind and not s.origin]
    warm = {int(i) for s in sources for i in s.index[s.weights > 0.0]}
    places = [s.place for s in sources if s.place in network.places]
    shares = [p.name for p in solids(network) if p.kind == "node" and p.part not in places and p.states[0] in warm]
    return list(dict.fromkeys([*places, *shares])) or list(others)


def across_air(network: Network, a: str, b: str) -> bool:
    """Does one part turn past the other, neither of them bearing or shaft?  They exchange heat through air alone."""
    past = (turns(network, a) and stands(network, b)) or (stands(network, a) and turns(network, b))
    return past and not {role(network, a), role(network, b)} & AXLE


def across_gap(network: Network, a: str, b: str) -> bool:
    """Is that air the gap, with a part of the field on either side of it, as far as is known?"""
    return across_air(network, a, b) and all(role(network, x) in FIELD or role(network, x) is None for x in (a, b))


def part_of(network: Network, place: str) -> str:
    return network.places[place].part if place in network.places else place


def model_links(network: Network) -> list[Link]:
    """Links that no effect has added."""
    return [link for link in network.links if not link.origin]


def standing_links(network: Network) -> list[Link]:
    """Links of the network's own, and those of effects that are in the model: none of an effect on trial."""
    return [link for link in network.links if not link.origin or link.origin in network.adopted]


def standing_sources(network: Network) -> list[Source]:
    """Losses of the network's own, and those of effects that are in the model."""
    return [source for source in network.sources if not source.origin or source.origin in network.adopted]


def cell(network: Network, place: str) -> bool:
    """Is it one of several cells that a channel is cut into?"""
    return place in network.places and network.places[place].channel is not None


def edges(network: Network) -> Iterator[tuple[str, str]]:
    """Pairs of parts, fluids and boundaries that a link joins, but for those of effects on trial."""
    for link in standing_links(network):
        a, b = (part_of(network, p) for p in link.places)
        yield (a, b)


def neighbours(network: Network) -> dict[str, set[str]]:
    out: dict[str, set[str]] = {}
    for a, b in edges(network):
        out.setdefault(a, set()).add(b)
        out.setdefault(b, set()).add(a)
    return out


def near_pairs(network: Network) -> Iterable[tuple[str, str]]:
    """Pairs of solids that no link joins: where a bridge may have been forgotten.

    They share a solid neighbour, or one of them has none. Or both stand, or both turn, and one fluid washes both, or
    leads may join them: a winding and a part that the surroundings wash. Nothing solid bridges an air gap.
    """
    around, names = neighbours(network), [p.name for p in solids(network)]
    inside = {a: around.get(a, set()) - set(network.boundaries) for a in names}
    solid = {a: near & set(names) for a, near in inside.items()}
    wound, outer = with_role(network, Role.WINDING), outside(network)
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            near = not solid[a] or not solid[b] or solid[a] & solid[b]
            led = (a in wound and b in outer) or (b in wound and a in outer)
            close = turns(network, a) == turns(network, b) and (led or inside[a] & inside[b])
            if b not in solid[a] and (near or close) and not across_air(network, a, b):
                yield a, b
