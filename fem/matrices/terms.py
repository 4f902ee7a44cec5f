"""Heat that depends on temperature, one small object each: what it takes out of the solid, and the derivative."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from fem.matrices.assembly import FieldModel
from geom.arrays import Array as Floats
from geom.constants import ALPHA_CU, SIGMA, ZERO_C
from geom.errors import InputError


class Term(Protocol):
    def heat(self, field: FieldModel, T: Floats) -> Floats:
        """(n,) W taken out at T (n,) in degC."""
        ...

    def slope(self, field: FieldModel, T: Floats) -> sp.csr_array:
        """(n, n) W/K, the derivative of `heat`."""
        ...


@dataclass(frozen=True)
class Radiation:
    """A grey face that sees black surroundings: emissivity sigma (T^4 - surroundings^4), surroundings in degC.

    emissivity : times the view factor, 0 to 1. The integral over each facet is exact.
    """

    face: str
    emissivity: float
    surroundings: float

    def __post_init__(self) -> None:
        if not 0 <= self.emissivity <= 1:
            raise InputError(f"emissivity {self.emissivity}", f"radiation from '{self.face}'", "0 to 1")

    def heat(self, field: FieldModel, T: Floats) -> Floats:
        trace = field.film(self.face).trace
        far = (self.surroundings + ZERO_C) ** 4
        out = np.zeros(field.n)
        out[trace.dofs] = trace.integrate(T[trace.dofs], lambda t: self._c * ((t + ZERO_C) ** 4 - far), 5)
        return out

    def slope(self, field: FieldModel, T: Floats) -> sp.csr_array:
        trace = field.film(self.face).trace
        local = trace.weighted(T[trace.dofs], lambda t: 4 * self._c * (t + ZERO_C) ** 3, 5)
        return field.spread(local, trace.dofs)

    @property
    def _c(self) -> float:
        return self.emissivity * SIGMA


@dataclass(frozen=True)
class CopperLoss:
    """A loss that grows with resistance: watts (1 + alpha (T - reference)), element by element, T in degC.

    watts : at the reference temperature (W), uniform over the part;  alpha : 1/K.  The load itself holds none of it.
    """

    part: str
    watts: float
    alpha: float = ALPHA_CU
    reference: float = 20.0

    def heat(self, field: FieldModel, T: Floats) -> Floats:
        return -self.watts * field.load(self.part) + self.slope(field, T) @ (T - self.reference)

    def slope(self, field: FieldModel, T: Floats) -> sp.csr_array:
        block = field.block(self.part)
        density = np.full(len(block.tets), self.watts / block.volume)
        return field.spread(-self.alpha * block.mass(density), np.arange(block.dofs.start, block.dofs.stop))
