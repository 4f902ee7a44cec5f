"""Networks by hand: nodes, links between them, streams and sources as plain functions."""

from collections.abc import Mapping, Sequence

import numpy as np

from geom.errors import InputError
from lumped.model.network import Link, Network, Place, Row, Source
from lumped.transfer.laws import Law


def node_row(column: int) -> Row:
    """The temperature of one column of z."""
    return Row(np.array([column]), np.array([1.0]))


def mean_row(network: Network, nodes: Sequence[str]) -> Row:
    """Of the temperatures of nodes, each as often as it is named."""
    at, count = np.unique([network.column(node) for node in nodes], return_counts=True)
    return Row(at, count / len(nodes))


def surface_place(name: str, part: str, state: int, area: float, fluid: str | None = None) -> Place:
    """A face of known area (m2) at its node's temperature."""
    at = np.array([state])
    return Place(name, "surface", part, at, np.full((1, 1), area), np.full(1, area), area, fluid)


def bare_network(name: str, capacities: Mapping[str, float], boundaries: Sequence[str]) -> Network:
    """Nodes with their heat capacities (J/K, 0 allowed) and boundaries, nothing joined yet."""
    states = tuple(capacities)
    places = {node: Place(node, "node", node, np.array([i]), np.eye(1), np.ones(1)) for i, node in enumerate(states)}
    C = np.array([float(c) for c in capacities.values()])
    return Network(name, states, C, tuple(boundaries), (), (), places, states)


def _triplets(
    network: Network, ends: Sequence[tuple[int, int]], scale: float
) -> tuple[list[int], list[int], list[float]]:
    n = len(network.states)
    inner = [(p, q) for p, q in ends if p < n]
    rows = [p for p, _ in inner for _ in range(2)]
    cols = [c for p, q in inner for c in (p, q)]
    return rows, cols, [scale, -scale] * len(inner)


def node_link(network: Network, name: str, kind: str, a: str, b: str, law: Law, area: float = 1.0) -> Link:
    """A link between two nodes or boundaries: law in W/K, or in W/m2/K over `area` (m2)."""
    p, q = network.column(a), network.column(b)
    if p == q or min(p, q) >= len(network.states):
        raise InputError(f"joins '{a}' with '{b}'", f"link '{name}'", "two different nodes, at most one a boundary")
    rows, cols, vals = _triplets(network, [(p, q), (q, p)], area)
    return Link(name, kind, (a, b), np.array(rows), np.array(cols), np.array(vals), law, node_row(p), node_row(q))


def stream(network: Network, name: str, path: Sequence[str], law: Law) -> Link:
    """A coolant stream through nodes in the order of `path`, upwind: each node receives m cp (T_before - T_own).

    law : heat capacity rate m cp (W/K). The first of the path is the inlet: a boundary, or a node of another stream.
    What the stream carries out of the network is m cp (T_last - T_first), exactly.
    """
    at = [network.column(p) for p in path]
    if len(at) < 2 or max(at[1:]) >= len(network.states):
        raise InputError(f"path {', '.join(path)}", f"stream '{name}'", "an inlet, then one or more nodes")
    rows, cols, vals = _triplets(network, list(zip(at[1:], at[:-1], strict=True)), 1.0)
    ends = (path[0], path[-1])
    return Link(
        name, "stream", ends, np.array(rows), np.array(cols), np.array(vals), law, node_row(at[-1]), node_row(at[0])
    )


def node_source(
    network: Network, name: str, kind: str, shares: Mapping[str, float], law: Law, probe: str | None = None
) -> Source:
    """A loss spread over nodes by shares that sum to 1; the law may follow `probe` (default: largest share)."""
    total = sum(shares.values())
    if not shares or abs(total - 1.0) > 1e-9:
        raise InputError(f"shares sum to {total:g}", f"source '{name}'", "shares that sum to 1")
    index = [network.column(node) for node in shares]
    main = max(shares, key=lambda node: shares[node])
    if max(index) >= len(network.states):
        raise InputError("heats a boundary", f"source '{name}'", f"nodes: {', '.join(network.states)}")
    weights = np.array(list(shares.values()), float)
    return Source(name, kind, main, np.array(index), weights, law, node_row(network.column(probe or main)))
