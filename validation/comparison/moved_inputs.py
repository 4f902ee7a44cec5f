"""What a record's inputs and boundaries may be off by, one at a time."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from lumped.model.network import Network
from lumped.model.quantities import AIR, LIQUID
from measured.case import Test
from measured.doubt import Doubt, boundary_doubt

FLOWS = {AIR: "flow of air", LIQUID: "flow of liquid", "flow_share": "flow by its share"}


def moved_inputs(network: Network, test: Test, doubt: Doubt) -> Iterator[tuple[str, Test]]:
    """The record with one input at a time off by its standard uncertainty; flows of one kind are off together.

    What no law reads, and what is zero throughout, moves nothing and is left out.
    """
    read = network.inputs
    groups: dict[str, list[str]] = {}
    for name, u in test.inputs.items():
        if name in read and np.any(u):
            groups.setdefault(FLOWS.get(network.measures(name), f"input {name}"), []).append(name)
    for group, names in groups.items():
        share = doubt["flow" if group in FLOWS.values() else "input"]
        yield group, test.scaled(dict.fromkeys(names, 1.0 + share))


def moved_boundaries(test: Test, doubt: Doubt) -> Iterator[tuple[str, Test]]:
    """The record with one boundary at a time off by what its thermometer may be."""
    for name, T in test.boundaries.items():
        off = np.asarray(T, float) + boundary_doubt(doubt, name)
        yield f"boundary:{name}", replace(test, boundaries={**test.boundaries, name: off})
