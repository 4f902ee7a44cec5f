"""How far a condensed network is from its field, in the numbers a user cares about."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.network import Array, Network
from lumped.recovery import PartShape, Shapes

FLOOR = 0.1  # of the machine's largest rise: below it a percentage of a part's own rise means nothing
POINTS = 25  # random points per part


@dataclass(frozen=True)
class Errors:
    """Worst over parts, in percent of the part's own rise: mean, hottest point, random points; and of which part."""

    mean: float
    hot: float
    point: float
    mean_part: str
    hot_part: str

    def __str__(self) -> str:
        return f"{self.mean:.2f}/{self.hot:.2f}/{self.point:.2f} % ({self.mean_part}, {self.hot_part})"


def errors(network: Network, full: Array, x: Array) -> Errors:
    """Compare a field `full` (n,) with the network's states x (n_states,), both as rises over the surroundings (K)."""
    shapes = network.recovery
    assert isinstance(shapes, Shapes)
    rng, largest, start = np.random.default_rng(0), float(np.abs(full).max()), 0
    rows: dict[str, tuple[float, float, float]] = {}
    for part, shape in shapes.parts.items():
        T = full[start : start + len(shape.points)]
        start += len(T)
        rows[part] = _part(T, shape.V @ x[shape.states], shape, FLOOR * largest, rng)
    mean, hot, point = (max(rows, key=lambda p: rows[p][k]) for k in range(3))
    return Errors(rows[mean][0], rows[hot][1], rows[point][2], mean, hot)


def _part(
    T: Array, seen: Array, shape: PartShape, floor: float, rng: np.random.Generator
) -> tuple[float, float, float]:
    w = shape.weights
    mean, off = w @ T, T - seen
    at = rng.choice(len(T), min(POINTS, len(T)), replace=False)
    own = max(abs(float(mean)), floor)
    return (
        100 * abs(float(w @ off)) / own,
        100 * abs(float(T.max() - seen.max())) / max(float(T.max()), floor),
        100 * float(np.abs(off[at]).max()) / own,
    )
