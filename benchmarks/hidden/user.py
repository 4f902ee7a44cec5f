"""What a user would hand in: the coarse network of the file in his words, and the logged tests as a case."""

import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from hidden.kinds import KINDS
from hidden.truth.archetype import Archetype, Edit, Record
from lumped.declarations.network import read_network
from lumped.model.network import Network
from lumped.model.sites import ambient, faces
from measured.case import Case, Channel, Model, Test
from validation.effects.registry import effect

MACHINES = Path(__file__).parent / "machines"
SIGMA_K = 0.5


@cache
def network_of(kind: str, edits: tuple[Edit, ...] = ()) -> Network:
    """The user's network; edits : (keys of the file, another value)."""
    data = tomllib.loads((MACHINES / f"{kind}.toml").read_text())
    for keys, value in edits:
        _set(data, keys, value)
    return read_network(data, f"{kind}.toml")


@cache
def area_of(kind: str, name: str) -> float:
    """Area (m2) by which an effect of the catalogue counts there, 1 where it counts the whole conductance."""
    network, one = network_of(kind), effect(name)
    air = ambient(network)
    if air is None or not one.extend(network).parameters[-1].unit.startswith("W/m2/K"):
        return 1.0
    return sum(face.area or 0.0 for face in faces(network, one.place, air))


def _set(data: dict[str, Any], keys: Sequence[str], value: float) -> None:
    for key in keys[:-1]:
        data = data[key]
    data[keys[-1]] = value


def test_of(kind: Archetype, network: Network, record: Record) -> Test:
    """A logged test as the case sees it."""

    def called(values: Mapping[str, Any]) -> dict[str, Any]:
        return {kind.called.get(name, name): v for name, v in values.items()}

    lag = 0.5 * sum(kind.logger.lag)
    channels = tuple(
        Channel(name, name, network.places[name].mean, y, SIGMA_K, lag) for name, y in called(record.readings).items()
    )
    return Test(
        record.name,
        record.role,
        record.time,
        called(record.inputs),
        called(record.boundaries),
        channels,
        record.start,  # type: ignore[arg-type]
    )


test_of.__test__ = False  # type: ignore[attr-defined]


def case_of(name: str, kind: str, records: Sequence[Record], edits: tuple[Edit, ...] = ()) -> Case:
    network = network_of(kind, edits)
    return Case(name, Model(network), tuple(test_of(KINDS[kind], network, r) for r in records))
