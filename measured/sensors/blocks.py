"""Samples averaged to a few hundred blocks, one stretch of them after another."""

import numpy as np

from geom.arrays import Array, Ints

INSTANTS = 180  # a fit looks at: matrices of a test stay below a megabyte


def groups(nt: int, instants: int = INSTANTS) -> Ints:
    """Start of each block when `nt` samples are averaged to at most `instants`."""
    return np.arange(0, nt, max(1, -(-nt // instants)))


class Blocks:
    """Weighted sums of so many columns over the blocks that begin at `start`."""

    def __init__(self, start: Ints, columns: int) -> None:
        self.start, self.sums = start, np.zeros((start.size, columns))
        self.weight, self.count = np.zeros(start.size), np.zeros(start.size)

    def add(self, first: int, a: Array, weight: Array) -> None:
        """Samples a (n, columns) from index `first` on, with their weights (n,)."""
        low, high = np.searchsorted(self.start, [first, first + weight.size - 1], "right")
        blocks = slice(low - 1, high)
        begin = np.maximum(self.start[blocks] - first, 0)
        self.sums[blocks] += np.add.reduceat(np.where(weight[:, None] > 0, a, 0.0), begin, axis=0)
        self.weight[blocks] += np.add.reduceat(weight, begin)
        self.count[blocks] += np.diff(np.append(begin, weight.size))

    def means(self) -> Array:
        """(n, columns) of the blocks of which at least half was read, of a slow sensor half of what it reads in any."""
        full = self.weight >= 0.5 * np.clip(self.weight.max(initial=1.0), 1.0, self.count)
        return np.asarray(self.sums[full] / self.weight[full, None])
