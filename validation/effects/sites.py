"""Where on a network things can sit: outer faces, windings, bearings, neighbours."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lumped.network import Network, Place

WORDS = {
    "bearing": ("bearing",),
    "commutator": ("commutator", "brush"),
    "winding": ("winding", "armature", "copper", "coil"),
    "iron": ("core", "yoke", "stator", "rotor", "iron", "teeth", "tooth", "poles", "lamination"),
    "rotor": ("rotor", "armature", "shaft", "magnet", "commutator"),
    "coolant": ("coolant", "water", "glycol", "oil", "jacket"),
    "bench": ("bench", "base", "mount", "floor", "plate"),
    "fluid": ("air", "gap", "coolant"),
}


def ambient(network: Network) -> str | None:
    """The boundary that stands for the surroundings."""
    named = [b for b in network.boundaries if "ambient" in b or b in ("air", "room")]
    return named[0] if named else None


def like(name: str, word: str) -> bool:
    """Does a name speak of this kind of part?  'winding.field' is a winding."""
    return any(w in name.lower() for w in WORDS[word])


def solids(network: Network) -> list[Place]:
    """Parts of a condensed network, nodes of a declared one: what has a temperature and a mass of its own."""
    return [p for p in network.places.values() if p.kind in ("part", "node") and network.C[p.states[0]] > 0]


def faces(network: Network, part: str, fluid: str) -> list[Place]:
    """The surfaces of a part that one fluid washes."""
    return [p for p in network.places.values() if p.kind == "surface" and p.part == part and p.fluid == fluid]


def touches(network: Network, place: str, other: str) -> bool:
    return any({place, other} == set(link.places) for link in network.links)


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


def turns(name: str) -> bool:
    return like(name, "rotor")


def across_air(a: str, b: str) -> bool:
    """Does one part turn past the other, neither of them bearing or shaft?  They exchange heat through air alone."""
    return turns(a) != turns(b) and not (axle(a) or axle(b))


def axle(name: str) -> bool:
    """A bearing or the shaft in it: what turns rests there on what stands."""
    return like(name, "bearing") or "shaft" in name


def named(network: Network, word: str) -> list[str]:
    """Solids whose name speaks of `word`, e.g. bearings."""
    return [p.name for p in solids(network) if like(p.name, word)]


def heated(network: Network, kind: str, word: str) -> list[str]:
    """Places that carry a loss of this kind, else those named so."""
    loaded = {s.place: None for s in network.sources if s.kind == kind and s.place in network.places}
    return list(loaded) or named(network, word)


def part_of(network: Network, place: str) -> str:
    return network.places[place].part if place in network.places else place


def edges(network: Network) -> Iterator[tuple[str, str]]:
    """Pairs of parts, fluids and boundaries that a link joins."""
    for link in network.links:
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

    They share a neighbour, or one of them has no solid neighbour at all; nothing solid bridges an air gap.
    """
    around, names = neighbours(network), [p.name for p in solids(network)]
    solid = {a: around.get(a, set()) & set(names) for a in names}
    for i, a in enumerate(names):
        for b in names[i + 1 :]:
            alone = not solid[a] or not solid[b]
            if b not in solid[a] and (alone or solid[a] & solid[b]) and not across_air(a, b):
                yield a, b
