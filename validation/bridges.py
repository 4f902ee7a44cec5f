"""What one node for a part leaves out: heat that passes between its neighbours beside its mean.

A part that is not of one temperature joins its neighbours a little more, or less, than the star through its mean does;
the exact network of means has links between parts that do not touch (compare the mesh that a star is equal to). A hand
network has none of them, so the simulated null gives every machine its own.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from lumped.laws import CONSTANT, Fixed
from lumped.network import Link, Network
from validation.effects.build import exchange


def bridges(network: Network, rng: np.random.Generator, spread: float) -> list[Link]:
    """A link (W/K) for every two conductances that meet in a node: `spread` of the one through it, either sign."""
    out = []
    for node, ends in stars(network).items():
        for (a, Ga), (b, Gb) in combinations(sorted(ends.items(), key=lambda end: network.column(end[0])), 2):
            G = spread * float(rng.standard_normal()) * Ga * Gb / (Ga + Gb)
            out.append(exchange(network, f"beside:{node}:{a}|{b}", a, b, Fixed(G)))
    return out


def stars(network: Network) -> dict[str, dict[str, float]]:
    """For every node with mass its neighbours through conductances (W/K) that depend on nothing."""
    heavy = {p.name for p in network.places.values() if p.kind == "node" and network.C[p.states[0]] > 0}
    out: dict[str, dict[str, float]] = {}
    for link in network.links:
        if isinstance(link.law, Fixed) and link.law.temperature == CONSTANT and link.kind != "stream":
            for node, other in (link.places, link.places[::-1]):
                if node in heavy and other in heavy:
                    ends = out.setdefault(node, {})
                    ends[other] = ends.get(other, 0.0) + link.law.value
    return out
