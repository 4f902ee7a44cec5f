"""A number times a film or share of a stream."""

from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import Array, Inputs, Law, StreamTable
from lumped.transfer.ranges import out_of_range


@dataclass(frozen=True)
class Streamed(Law):
    """A number times a StreamTable: the film or share of a stream.

    liquid : whether the fluid's own temperature counts, else that of the film
    """

    value: float
    table: StreamTable
    liquid: bool = False

    @property
    def temperature(self) -> StreamTable:  # type: ignore[override]
        return self.table

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return () if self.table.of is None else (self.table.of,)

    def factor(self, inputs: Inputs) -> float:
        return self.value

    def size(self, inputs: Inputs) -> Array | float:
        """At the usual temperature, with a warning where its correlation does not hold there."""
        sizes, share = np.atleast_1d(self.table.size(inputs)), 1.0 if self.liquid else 0.5
        moving = sizes[sizes > 0.0]
        for extreme in {float(moving.min()), float(moving.max())} if moving.size and self.table.domain else ():
            if words := self.table.left(extreme, share * self.table.degC, share):
                out_of_range(words)
        return super().size(inputs)
