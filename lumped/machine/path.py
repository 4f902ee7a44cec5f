"""The way a liquid takes through its jacket, cut into cells that warm one after the other.

A cell's node is the temperature at which the liquid leaves it, and its film, h (e^N - 1) / N with N = h A / (m cp), is
such that walls of one temperature warm the liquid by the exact exponential (fem.solvers.streams has the same cells).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geom.description.machine import Machine
from lumped.model.network import Array

CELLS = 6  # at most; a jacket of fewer turns has one per turn


@dataclass(frozen=True)
class Path:
    """along : how far the liquid has come at points (n, 3), in any measure;  cells : of equal length in it"""

    along: Callable[[Array], Array]
    cells: int


def path_of(machine: Machine, jacket: str) -> Path:
    """From the inlet's port: turn by turn, channel by channel around the axis, or along a single channel."""
    prisms = machine.part(jacket).prisms
    start = next((port.position for port in machine.ports if port.name == f"{jacket}.inlet"), None)
    if prisms[0][0].holes or len(prisms) == 1:
        first, last = machine.part(jacket).span
        back = start is not None and start[2] > (first + last) / 2
        turns = len({z0 for profile, z0, _ in prisms if profile.holes}) if prisms[0][0].holes else CELLS
        return Path((lambda x: -x[:, 2]) if back else (lambda x: x[:, 2]), min(turns, CELLS))
    # The most prisms at one place along the axis: the straight part of the channels
    spans = [(z0, z1) for _, z0, z1 in prisms]
    channels = max(spans.count(span) for span in spans)
    top = np.pi / 2 if start is None else np.arctan2(start[1], start[0])
    begin = top - np.pi / channels
    return Path(lambda x: (np.arctan2(x[:, 1], x[:, 0]) - begin) % (2 * np.pi), min(channels, CELLS))


def stem(fluid: str) -> str:
    """The jacket that a cell belongs to; any other fluid is its own."""
    return fluid.rpartition("@")[0] or fluid


def cells_of(machine: Machine, jacket: str) -> tuple[str, ...]:
    """Names of the cells, in the order of the flow."""
    return tuple(f"{jacket}@{k}" for k in range(path_of(machine, jacket).cells))
