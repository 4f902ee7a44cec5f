"""What a user would hand in: the coarse network of the file, and the logged tests as a case."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

from hidden.truth.archetype import Record
from lumped.declared import load_network
from lumped.network import Network
from validation.case import Case, Channel, Model, Test

MACHINES = Path(__file__).parent / "machines"
SIGMA_K, LAG_S = 0.5, 10.0


@cache
def network_of(kind: str) -> Network:
    return load_network(MACHINES / f"{kind}.toml")


def test_of(network: Network, record: Record) -> Test:
    """A logged test as the case sees it."""
    channels = tuple(
        Channel(name, name, network.places[name].mean, y, SIGMA_K, LAG_S) for name, y in record.readings.items()
    )
    return Test(
        record.name, record.role, record.time, record.inputs, record.boundaries, channels, record.start  # type: ignore[arg-type]
    )  # fmt: skip


test_of.__test__ = False  # type: ignore[attr-defined]


def case_of(name: str, kind: str, records: Sequence[Record]) -> Case:
    network = network_of(kind)
    return Case(name, Model(network), tuple(test_of(network, r) for r in records))
