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
    """

    value: float
    table: StreamTable
    top: float
    what: str
    liquid: bool = False

    @property
    def temperature(self) -> StreamTable:  # type: ignore[override]
        return self.table

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return () if self.table.of is None else (self.table.of,)

    def factor(self, inputs: Inputs) -> float:
        largest = float(np.max(self.table.size(inputs), initial=0.0))
        if largest > self.top:
            out_of_range(f"{self.what}: {self.table.of or 'flow'} = {largest:.4g} outside 0 to {self.top:.4g}")
        return self.value
