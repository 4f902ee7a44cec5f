"""What a field is made of: conductivity direction by direction, and heat that depends on temperature.

Each term is a small object: what it takes out of the solid, and the derivative.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import scipy.sparse as sp

from fem.matrices.assembly import FieldModel
from geom.arrays import Array as Floats
from geom.constants import ALPHA_CU, SIGMA, ZERO_C
from geom.errors import InputError


@dataclass(frozen=True)
class Conductivity:
    """Orthotropic conductivity (W/m/K) along r, theta and z of the machine's axis."""

    k_r: float
    k_theta: float
    k_z: float

    def __post_init__(self) -> None:
        if not min(self.k_r, self.k_theta, self.k_z) > 0:
            raise InputError(f"conductivity {self.k_r}, {self.k_theta}, {self.k_z} W/m/K", right="give values above 0")

    def tensor(self, x: Floats) -> Floats:
        """(n, 3, 3) tensor in x, y, z (W/m/K) at points x (n, 3)."""
        if self.k_r == self.k_theta:
            return np.broadcast_to(np.diag([self.k_r, self.k_r, self.k_z]), (len(x), 3, 3))
        r = np.maximum(np.hypot(x[:, 0], x[:, 1]), 1e-300)
        c, s = x[:, 0] / r, x[:, 1] / r
        k = np.zeros((len(x), 3, 3))
        k[:, 0, 0] = self.k_r * c * c + self.k_theta * s * s
        k[:, 1, 1] = self.k_r * s * s + self.k_theta * c * c
        k[:, 0, 1] = k[:, 1, 0] = (self.k_r - self.k_theta) * c * s
        k[:, 2, 2] = self.k_z
        return k


@dataclass(frozen=True)
class LoopWound:
    """Coils around radial poles: wires run in loops about each pole's axis, layers stack along the radius.

    along, across : conductivity along the wire and across it (W/m/K)
    axes : angles of the pole axes (rad);  half_length : half of the pole's length in z (m);  half_width : of its width
    """

    along: float
    across: float
    axes: tuple[float, ...]
    half_length: float
    half_width: float
    z_centre: float = 0.0

    def tensor(self, x: Floats) -> Floats:
        """(n, 3, 3) tensor (W/m/K): the wire runs along z beside the pole and sideways beyond its ends."""
        angle = np.arctan2(x[:, 1], x[:, 0])[:, None] - np.array(self.axes)
        nearest = np.argmin(np.abs(np.angle(np.exp(1j * angle))), axis=1)
        axis = np.array(self.axes)[nearest]
        side = np.stack([-np.sin(axis), np.cos(axis), np.zeros(len(x))], -1)
        beside = np.abs((x * side).sum(1)) / self.half_width
        distance = np.abs(x[:, 2] - self.z_centre) / self.half_length
        wire = np.where((distance > beside)[:, None], side, np.array([0.0, 0.0, 1.0]))
        return self.across * np.eye(3) + (self.along - self.across) * wire[:, :, None] * wire[:, None, :]


def isotropic(k: float) -> Conductivity:
    """The same conductivity k (W/m/K) in every direction."""
    return Conductivity(k, k, k)


def laminated(in_plane: float, through: float) -> Conductivity:
    """A stack of sheets along z: in_plane and through the stack (W/m/K)."""
    return Conductivity(in_plane, in_plane, through)


def wound(along: float, across: float) -> Conductivity:
    """Wires along z: conductivity along and across them (W/m/K)."""
    return Conductivity(across, across, along)


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
