"""A number times a film or share of a stream."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import Inputs, Law, StreamTable
from lumped.transfer.ranges import out_of_range


@dataclass(frozen=True)
class Streamed(Law):
    """A number times a StreamTable: the film or share of a stream, which warns where its correlation would.

    top : |input| up to which the correlation holds at the table's usual temperature;  what : the correlation
    liquid : whether the fluid's own temperature counts, else that of the film
    least : |input| above rest from which the correlation holds
    """

    value: float
    table: StreamTable
    top: float
    what: str
    liquid: bool = False
    least: float = 0.0

    @property
    def temperature(self) -> StreamTable:  # type: ignore[override]
        return self.table

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return () if self.table.of is None else (self.table.of,)

    def factor(self, inputs: Inputs) -> float:
        size = np.atleast_1d(self.table.size(inputs))
        slowest, fastest = np.min(size[size > 0.0], initial=self.top), np.max(size)
        for extreme, outside in ((slowest, slowest < self.least), (fastest, fastest > self.top)):
            if outside:
                what = f"{self.what}: {self.table.of or 'flow'}"
                out_of_range(f"{what} = {extreme:.4g} outside {self.least:.4g} to {self.top:.4g}")
        return self.value
