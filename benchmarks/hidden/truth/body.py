"""Skeleton of a machine: bodies cut into cells, joints between them. Conductivity and capacity vary with T."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Cells = NDArray[np.int64]
REFERENCE = 40.0


@dataclass(frozen=True)
class Body:
    """A chain of equal cells from the drive end to the other, or from root to tip.

    C : heat capacity (J/K) of all at 40 degC;  R : conduction resistance (K/W) from end to end
    k_slope, c_slope : relative change per K of conductivity and of heat capacity
    """

    name: str
    C: float
    cells: int = 1
    R: float = 0.0
    k_slope: float = 0.0
    c_slope: float = 4e-4


@dataclass(frozen=True)
class Joint:
    """Contact of conductance G (W/K) in all: side by side over the whole length, or between two spots (0 to 1)."""

    name: str
    a: str
    b: str
    G: float
    spots: tuple[float, float] | None = None
    slope: float = 0.0


@dataclass(frozen=True)
class Skeleton:
    """Cells with C (n,) J/K, and edges (i, j) with conductance G (W/K) that changes by `slope` per K of mean T."""

    where: Mapping[str, slice]
    C: Array
    c_slope: Array
    i: Cells
    j: Cells
    G: Array
    slope: Array
    spread: Array

    def cells(self, name: str) -> Cells:
        return np.arange(self.C.size)[self.where[name]]

    def cell(self, name: str, position: float) -> int:
        """The cell at a relative position (0 to 1) of a body."""
        own = self.cells(name)
        return int(own[min(int(position * own.size), own.size - 1)])

    def conduction(self, T: Array) -> Array:
        """Heat (W) into every cell (n,)."""
        drop, mean = T[self.i] - T[self.j], 0.5 * (T[self.i] + T[self.j])
        return self.spread @ (self.G * (1.0 + self.slope * (mean - REFERENCE)) * drop)

    def capacity(self, T: Array) -> Array:
        return self.C * (1.0 + self.c_slope * (T - REFERENCE))


def skeleton(bodies: Sequence[Body], joints: Sequence[Joint]) -> Skeleton:
    where, start = {}, 0
    for b in bodies:
        where[b.name] = slice(start, start + b.cells)
        start += b.cells
    edges = [e for b in bodies for e in _inside(b, where[b.name].start)]
    edges += [e for joint in joints for e in _joined(joint, where)]
    i, j, G, slope = (np.array(x) for x in zip(*edges, strict=True))
    spread = np.zeros((start, G.size))
    np.add.at(spread, (i, np.arange(G.size)), -1.0)
    np.add.at(spread, (j, np.arange(G.size)), 1.0)
    C = np.concatenate([np.full(b.cells, b.C / b.cells) for b in bodies])
    c_slope = np.concatenate([np.full(b.cells, b.c_slope) for b in bodies])
    return Skeleton(where, C, c_slope, i, j, G, slope, spread)


def _inside(b: Body, start: int) -> list[tuple[int, int, float, float]]:
    """Cell to cell: centres are R / cells apart."""
    return [(start + k, start + k + 1, b.cells / b.R, b.k_slope) for k in range(b.cells - 1)]


def _joined(joint: Joint, where: Mapping[str, slice]) -> list[tuple[int, int, float, float]]:
    a, b = where[joint.a], where[joint.b]
    na, nb = a.stop - a.start, b.stop - b.start
    if joint.spots is not None:
        ka, kb = (min(int(s * n), n - 1) for s, n in zip(joint.spots, (na, nb), strict=True))
        return [(a.start + ka, b.start + kb, joint.G, joint.slope)]
    n = max(na, nb)
    return [(a.start + k * na // n, b.start + k * nb // n, joint.G / n, joint.slope) for k in range(n)]
