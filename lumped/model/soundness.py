"""Whether a declared network can be a machine: heat can leave every node, something is warm, streams go somewhere."""

from collections.abc import Iterable, Iterator, Sequence

from geom.description.names import plain_name
from geom.errors import InputError
from lumped.model.network import Network
from lumped.model.topology import reached
from lumped.schemas.reader import excerpt

RESERVED = set("@#")  # of effects at places, and of shapes inside parts


def checked_names(names: Iterable[str], where: str) -> None:
    """InputError for a name that messages, tables and effects (KIND@PLACE) could not tell apart."""
    for name in names:
        if not name.strip() or plain_name(name, where).strip() != name or set(name) & RESERVED:
            right = f"letters that can be printed, none of {' '.join(sorted(RESERVED))}, no space at either end"
            raise InputError(f"{excerpt(name)} cannot be a name", where, right)


def islands(network: Network) -> Iterator[list[str]]:
    """Groups of nodes that are joined to each other but to no boundary."""
    neighbours: dict[int, set[int]] = {i: set() for i in range(network.size)}
    groups = [sorted({int(i) for i in (*link.rows, *link.cols)}) for link in network.links]
    for place in network.places.values():
        if place.kind == "surface" and place.fluid:  # what washes it may be joined by an effect
            groups.append([*map(int, place.states), network.column(place.fluid)])
    for group in groups:
        for i in group:
            neighbours[i] |= set(group)
    n = len(network.states)
    left = {*range(n)} - {*reached(range(n, network.size), neighbours.__getitem__)}
    while left:
        island = set(reached([min(left)], neighbours.__getitem__))
        yield [network.states[i] for i in sorted(island)]
        left -= island


def checked_path(path: Sequence[str], where: str) -> Sequence[str]:
    """A stream's way; InputError where it passes a node twice, or goes nowhere."""
    if len(path) < 2:
        raise InputError(f"path = {list(path)} leads nowhere", where, "two or more nodes, the inlet first")
    for name in path:
        if list(path).count(name) > 1:
            right = "each node once; a loop that returns is [circuits.NAME] with a reservoir"
            raise InputError(f"path passes '{name}' {list(path).count(name)} times", where, right)
    return path
