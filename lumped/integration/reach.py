"""Whether the films of a run stayed where their fluids are known: what went beyond is said with its value and range."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from geom.arrays import Array
from lumped.numerics.terms import CODE, COLD, HOT, POINT, STREAM, Terms
from lumped.transfer.ranges import out_of_range


class Reach:
    """The least and largest hot + cold (degC) that every StreamTable of some terms has seen."""

    def __init__(self, terms: Terms) -> None:
        self.terms, self.some = terms, np.flatnonzero((terms.kind[:, CODE] == STREAM) & (terms.m != 0.0))
        self.low, self.high = np.full(self.some.size, np.inf), np.full(self.some.size, -np.inf)

    def see(self, z: Array) -> None:
        """States and boundaries (k, n + nb)."""
        for k, e in enumerate(self.some.tolist()):
            total = self._row(e, HOT, z) + self._row(e, COLD, z)
            self.low[k], self.high[k] = min(self.low[k], total.min()), max(self.high[k], total.max())

    def _row(self, e: int, side: int, z: Array) -> Any:
        T, row = self.terms, self.terms.part[e, side]
        some = slice(T.begin[row], T.begin[row + 1])
        return z[:, T.at[some]] @ T.weight[some]

    def tell(self, names: Sequence[str]) -> None:
        """A RangeWarning for each that left its table, in which it is held."""
        T = self.terms
        for k, e in enumerate(self.some.tolist()):
            cold, first = T.part[e, COLD], T.part[e, POINT]
            times, of = (1.0, "its coolant") if T.begin[cold] == T.begin[cold + 1] else (0.5, "its film")
            low, high = T.point[first, 0], T.point[first + int(T.par[e, 0]) - 1, 0]
            span = f"outside {times * low:g} to {times * high:g}"
            for extreme in (x for x in (self.low[k], self.high[k]) if not low <= x <= high):
                out_of_range(f"{names[e]}: {of} at {times * extreme:.4g} degC {span}")
