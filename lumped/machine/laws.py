"""A law that follows one input through a table: how a motor's films depend on speed and flow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.transfer.laws import Array, Inputs, Law


@dataclass(frozen=True)
class Interpolated(Law):
    """Piecewise linear in |input|, flat outside: a film (W/m2/K) or a conductance (W/K)."""

    of: str
    at: tuple[float, ...]
    value: tuple[float, ...]

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.of,)

    def factor(self, inputs: Inputs) -> Array:
        return np.interp(np.abs(np.asarray(inputs[self.of], float)), self.at, self.value)
