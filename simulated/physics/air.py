"""The fan's air on its way through the machine: upwind cells without heat capacity."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from simulated.physics.conduction import Body, Face

Array = NDArray[np.float64]
Index = NDArray[np.int64]
ALONG = ("airgap", "air.interpolar")
AIR_AT_INLET = 1.205 * 1006.0  # J/m3/K


@dataclass(frozen=True)
class AirPath:
    """ambient -> air.left -> (airgap parallel to air.interpolar, `count` cells each) -> air.right -> out.

    gap_share : part of the flow through the air gap; z0, z1 : ends of the core (m)
    """

    count: int
    gap_share: float
    z0: float
    z1: float

    @property
    def size(self) -> int:
        return 2 + 2 * self.count

    def cells(self, face: Face, body: Body) -> Index:
        """The cell that washes each node of a face."""
        if face.fluid not in ALONG:
            return np.full(len(face.nodes), 0 if face.fluid == "air.left" else self.size - 1)
        z = body.points[face.nodes, 2]
        step = np.clip(((z - self.z0) / (self.z1 - self.z0) * self.count).astype(int), 0, self.count - 1)
        return 1 + self.count * ALONG.index(face.fluid) + step

    def advection(self) -> tuple[Array, Array]:
        """Matrix (size, size) and inlet vector (size,), per unit of flow heat capacity (W/K)."""
        matrix, inlet = np.zeros((self.size, self.size)), np.zeros(self.size)
        last = self.size - 1
        matrix[0, 0], inlet[0], matrix[last, last] = 1.0, 1.0, 1.0
        for branch, share in enumerate((self.gap_share, 1 - self.gap_share)):
            chain = [0, *(1 + self.count * branch + i for i in range(self.count))]
            for upstream, cell in pairwise(chain):
                matrix[cell, cell], matrix[cell, upstream] = share, -share
            matrix[last, chain[-1]] = -share
        return matrix, inlet

    def spread(self, fluid: str) -> Array:
        """(size,) weights that sum to 1 over the cells of a fluid."""
        weights = np.zeros(self.size)
        if fluid in ALONG:
            first = 1 + self.count * ALONG.index(fluid)
            weights[first : first + self.count] = 1 / self.count
        else:
            weights[0 if fluid == "air.left" else -1] = 1.0
        return weights


def path(body: Body, gap_share: float, count: int = 10) -> AirPath:
    z = np.concatenate([body.points[f.nodes, 2] for f in body.faces.values() if f.fluid in ALONG])
    return AirPath(count, gap_share, float(z.min()), float(z.max()))
