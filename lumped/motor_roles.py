"""What the parts, fluids and boundaries of a motor are: as the machine's family declares them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from geom.roles import Role
from lumped.identity import Identity, identity
from lumped.motor_path import stem
from lumped.network import Network

BOUNDARIES = {"ambient": Role.AMBIENT, "coolant": Role.COOLANT}  # the names that lumped.motor gives them


def declared(machine: Any, network: Network, turning: Collection[str]) -> dict[str, Identity]:
    """By name. turning : parts that hang on the shaft, which tells it of a part whose family does not."""
    solid = {part.name: _part(part, turning) for part in machine.parts}
    spaces = {part.name: part.role for part in machine.fluids if part.role is not None}
    fluids = {state: identity(spaces[stem(state)], False) for state in network.states if stem(state) in spaces}
    return {**solid, **fluids, **{name: identity(BOUNDARIES[name], False) for name in network.boundaries}}


def _part(part: Any, turning: Collection[str]) -> Identity:
    known = part.turns is not None or part.role is not None
    return identity(part.role, part.turns if known else part.name in turning)


def with_channels(network: Network) -> Network:
    """The network in which every cell of a jacket says which jacket it belongs to."""
    cells = {name: place for name, place in network.places.items() if place.kind == "fluid" and stem(name) != name}
    return replace(network, places={**network.places, **{n: replace(p, channel=stem(n)) for n, p in cells.items()}})
