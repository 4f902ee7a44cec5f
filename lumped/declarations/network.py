"""Networks declared by hand in network.toml. Every key is described in docs/network-toml.md."""

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.description.names import plain_name
from geom.description.roles import Identity, Role, identity
from geom.description.toml_file import read_toml
from geom.errors import InputError
from lumped.declarations.links import flow_column, flow_law, mechanisms
from lumped.declarations.loss_tables import deducted, loss_kinds, loss_laws
from lumped.declarations.parameters import read_parameters
from lumped.model.build import bare_network, node_link, node_source, stream, surface_place
from lumped.model.network import NOTHING, Link, Network, Place, Source
from lumped.model.quantities import INPUTS
from lumped.model.topology import reached
from lumped.schemas.reader import Table, excerpt, suggestion
from lumped.sources.loss_laws import EDDY
from lumped.transfer.laws import Law, Scaled
from lumped.transfer.reversal import Direction, OneWay
from lumped.transfer.streamed import Streamed

if TYPE_CHECKING:
    from lumped.circuits.circuit import Circuit

SECTIONS = ("nodes", "surfaces", "means", "links", "streams", "losses", "circuits", "parameters")
RIGHT = "a network.toml (docs/network-toml.md)"
RESERVED = set("@#")  # of effects at places, and of shapes inside parts
LARGEST_SHARE = 10.0  # that a law refers to: nothing is loaded tenfold, so 100 is a percentage


def read_identities(
    top: Table, nodes: Mapping[str, Table], boundaries: Iterable[str], cells: Iterable[str]
) -> dict[str, Identity]:
    """`role` and `turns` of nodes, and of boundaries in [boundaries.NAME]; the cells of circuits carry coolant."""
    around = top.tables("boundaries")
    for name, table in around.items():
        if name not in boundaries:
            raise table.error(f"'{name}' is not a boundary", suggestion(name, boundaries))
    out: dict[str, Identity] = {}
    for name, table in {**nodes, **around}.items():
        role = Role(table.word("role", None, list(Role))) if "role" in table else None
        turns = table.flag("turns") if "turns" in table else None
        if role is not None or turns is not None:
            out[name] = identity(role, turns)
    for table in around.values():
        table.close()
    return {**out, **{cell: identity(Role.COOLANT, False) for cell in cells}}


def load_network(
    path: str | Path, shares: Container[str] = (), note: Callable[[str], None] = lambda words: None
) -> Network:
    """The network of a TOML file.

    shares : inputs that are recorded as 0 to 1; what refers to more than ten of one is taken as a percentage, which is
        told to `note`
    Raises InputError that names the file, the table, the key and what would be right.
    """
    document = _with_shares(read_toml(Path(path), RIGHT), shares, note)
    return replace(read_network(document, str(path)), file=str(path))


def _with_shares(data: Any, shares: Container[str], note: Callable[[str], None]) -> Any:
    """A document whose powers of inputs, `{input, at, exponent}`, refer to shares where they have percentages."""
    if isinstance(data, list):
        return [_with_shares(x, shares, note) for x in data]
    if not isinstance(data, dict):
        return data
    at, name = data.get("at"), data.get("input")
    if isinstance(name, str) and name in shares and isinstance(at, int | float) and at > LARGEST_SHARE:
        note(f"laws refer to {name} in percent, recorded as 0 to 1: taken so")
        return {**data, "at": at / 100.0}
    return {key: _with_shares(x, shares, note) for key, x in data.items()}


def load_circuits(path: str | Path) -> "dict[str, Circuit]":
    """The coolant circuits of a network.toml, for pressure drop and pump power."""
    top = Table(read_toml(Path(path), RIGHT), str(path))
    return _circuits(top, top.tables("nodes"), top.table("network").words("boundaries"))


def read_network(data: Mapping[str, Any], where: str = "network.toml") -> Network:
    """The network of a TOML document already read; every message names `where`."""
    try:
        return _read(data, where)
    except InputError as fault:
        if where in fault.where:
            raise
        raise InputError(fault.what, f"{where}, {fault.where}", fault.right) from None


def _read(data: Mapping[str, Any], where: str) -> Network:
    top = Table(data, where)
    head, nodes = top.table("network"), top.tables("nodes")
    if not nodes:
        raise top.error("no nodes", "[nodes.NAME] with C_J_K = ...")
    name, boundaries, settles = head.word("name"), head.members("boundaries"), head.number("settles_s", 3600.0)
    head.close()
    for key in SECTIONS:
        checked_names(top.tables(key), f"{where} [{key}]")
    checked_names(boundaries, f"{where} [network] boundaries")
    circuits = _circuits(top, nodes, boundaries)
    cells = {n: C for c in circuits.values() for n, C in c.capacities().items()}
    network = bare_network(name, {n: _capacity(t) for n, t in nodes.items()} | cells, boundaries)
    clash = set(nodes) & set(boundaries)
    if clash:
        raise head.error(f"'{min(clash)}' is a node and a boundary", "one or the other")
    identities = read_identities(top, nodes, boundaries, cells)
    network = replace(network, places=_places(network, top, nodes, cells), settles_s=settles)
    quantities = {}  # [inputs.NAME] quantity = "speed": what an input measures
    for signal, table in top.tables("inputs").items():
        quantities[signal] = table.word("quantity", None, INPUTS)
        table.close()
    network = replace(network, declared=identities, quantities=quantities)
    loops = [link for circuit in circuits.values() for link in circuit.links(network)]
    links = [*_links(network, top), *_streams(network, top), *loops]
    network = replace(network, links=tuple(links), sources=tuple(_sources(network, top)))
    network = replace(network, parameters=read_parameters(network, top, nodes))
    for table in nodes.values():
        table.close()
    top.close()
    return _checked(network, where)


def _circuits(top: Table, nodes: Iterable[str], boundaries: Iterable[str]) -> "dict[str, Circuit]":
    """Loaded only where a file has some: the libraries behind their films take a while to load."""
    if "circuits" not in top:
        return {}
    from lumped.declarations.circuit import read_circuits

    return read_circuits(top, nodes, boundaries)


def _capacity(table: Table) -> float:
    if "C_J_K" in table and "mass_kg" in table:
        raise table.error("C_J_K and mass_kg both given", "C_J_K, or mass_kg with cp_J_kgK")
    if "mass_kg" in table:
        return table.number("mass_kg") * table.number("cp_J_kgK")
    return table.number("C_J_K", 0.0)


def _places(network: Network, top: Table, nodes: Mapping[str, Table], cells: Iterable[str]) -> dict[str, Place]:
    places = dict(network.places) | {c: replace(network.places[c], kind="fluid") for c in cells}
    for i, (name, table) in enumerate(nodes.items()):
        kind = table.word("kind", "node", ("node", "part", "fluid"))
        reading = table.flag("reading") if "reading" in table else False
        places[name] = replace(places[name], kind=kind, reading=reading)  # type: ignore[arg-type]
        if "area_m2" in table:
            face = f"{name}.outer"
            fluid = _end(network, table, table.word("washed_by"))
            places[face] = surface_place(face, name, i, table.number("area_m2"), fluid)
    for name, table in top.tables("surfaces").items():
        node, fluid = table.word("of", None, network.states), _end(network, table, table.word("washed_by"))
        places[name] = surface_place(name, node, network.column(node), table.number("area_m2"), fluid)
        table.close()
    for name, table in top.tables("means").items():
        shares = table.shares("of")
        if not shares:
            raise table.error("of = {} averages nothing", "shares of nodes that sum to 1")
        states = np.array([network.column(_end(network, table, node)) for node in shares])
        weights = np.array(list(shares.values()))
        if abs(weights.sum() - 1.0) > 1e-9 or states.max() >= len(network.states):
            raise table.error(f"shares sum to {weights.sum():g}", "shares of nodes that sum to 1")
        table.close()
        main = max(shares, key=lambda node: shares[node])
        places[name] = Place(name, "node", main, states, np.diag(weights), weights)
    return places


def _end(network: Network, table: Table, name: str) -> str:
    names = [*network.states, *network.boundaries]
    if name not in names:
        raise table.error(f"unknown node '{name}'", suggestion(name, names))
    return name


def _links(network: Network, top: Table) -> list[Link]:
    out: list[Link] = []
    for name, table in top.tables("links").items():
        ends = table.words("between")
        if len(ends) != 2:
            raise table.error(f"between = {list(ends)}", "two names")
        face = network.places.get(ends[0])
        surface = face if face is not None and face.kind == "surface" else None
        a = surface.part if surface is not None else _end(network, table, ends[0])
        b = _end(network, table, ends[1])
        area = surface.area if surface is not None and surface.area is not None else table.number("area_m2", 0.0)
        for suffix, law, per_area in mechanisms(table, area > 0.0):
            full = f"link:{name}{suffix}"
            kind = "film" if surface is not None else "link"
            link = node_link(network, full, kind, a, b, law, area if per_area else 1.0)
            if isinstance(law, Streamed) and law.liquid:
                link = replace(link, hot=link.cold, cold=NOTHING)
            out.append(replace(link, places=(ends[0], b)))
        table.raw("prior_sd")
        table.close()
    return out


def _streams(network: Network, top: Table) -> list[Link]:
    out = []
    for name, table in top.tables("streams").items():
        path = [_end(network, table, node) for node in checked_path(table.words("path"), table.where)]
        out += _both_ways(network, name, path, table)
        table.raw("prior_sd")
        table.close()
    return out


def _both_ways(network: Network, name: str, path: list[str], table: Table) -> list[Link]:
    """A stream; where a column carries its flow and the file says what comes in from behind, backwards too."""
    law, column, upstream = flow_law(table), flow_column(table, network.measures), table.word("backwards_from", "")
    if column is None:
        return [stream(network, f"stream:{name}", path, law)]
    if not upstream and path[0] != path[-1]:
        right = f'backwards_from = "NODE": what comes in behind {path[-1]} when the flow turns round'
        return [stream(network, f"stream:{name}", path, OneWay(law, column, table.where, right))]
    back = [_end(network, table, upstream), *path[:0:-1]] if upstream else path[::-1]
    return [
        stream(network, f"stream:{name}", path, Direction(law, column, 1)),
        stream(network, f"stream:{name}:back", back, Direction(law, column, -1)),
    ]


def _sources(network: Network, top: Table) -> list[Source]:
    tables = top.tables("losses")
    kinds, laws = loss_kinds(tables), loss_laws(tables, network.quantities)
    out = {name: _source(network, name, tables[name.removesuffix(EDDY)], law) for name, law in laws.items()}
    # What the model injects elsewhere leaves the measured total, at its own temperature, watt for watt.
    differences = [
        replace(out[name], name=f"loss:{name}:less:{part}", law=Scaled(out[part].law, -1.0), probe=out[part].probe)
        for name, kind in kinds.items()
        if kind == "measured"
        for other in deducted(tables[name], kinds)
        for part in (other, f"{other}{EDDY}")
        if part in out
    ]
    for table in tables.values():
        table.raw("prior_sd")
        table.close()
    return [*out.values(), *differences]


def _source(network: Network, name: str, table: Table, law: Law) -> Source:
    shares = {_end(network, table, node): share for node, share in table.shares("at").items()}
    if abs(sum(shares.values()) - 1.0) > 1e-9:
        raise table.error(f"shares of 'at' sum to {sum(shares.values()):g}", "shares that sum to 1")
    probe = _end(network, table, table.word("temperature_of", max(shares, key=lambda node: shares[node])))
    return node_source(network, f"loss:{name}", table.word("kind"), shares, law, probe)


def _checked(network: Network, where: str) -> Network:
    """Names that parameters act on exist, and the network can be a machine."""
    names = {i.name for i in network.elements} | {f"capacity:{s}" for s in network.states}
    for p in network.parameters:
        for target, _ in p.targets:
            if target not in names and not target.startswith(("bias:", "gain:", "lag:")):
                there = f"{where} [parameters.{p.name}]"
                raise InputError(f"acts on unknown '{target}'", there, suggestion(target, names))
    # The network; InputError names the nodes that no heat can leave, and a network that stores none
    for island in islands(network):
        nodes = ", ".join(f"'{name}'" for name in island)
        to = f"{'it' if len(island) == 1 else 'them'} to {' or '.join(network.boundaries) or 'a boundary'}"
        right = "a link, stream or surface to a boundary"
        raise InputError(f"no heat can leave {nodes}: nothing joins {to}", where, right)
    if not np.any(network.C > 0.0):
        raise InputError("no node has a heat capacity", where, "[nodes.NAME] C_J_K = ..., or mass_kg with cp_J_kgK")
    return network


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
