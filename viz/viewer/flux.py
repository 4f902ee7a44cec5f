"""Heat flux at the nodes, as the page mixes it: the scale of its colours is taken from here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from viz.machine.arrows import heat_flux
from viz.rendering.nodes import SplitMesh

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Axial:
    """A conductivity (W/m/K) across and along the machine's axis."""

    across: float
    along: float

    def tensor(self, x: Array) -> Array:
        return np.broadcast_to(np.diag([self.across, self.across, self.along]), (len(x), 3, 3))


def nodal_flux(nodes: SplitMesh, T: Array, conductivity: Mapping[str, tuple[float, float]]) -> Array:
    """(n_nodes,) kW/m2, |k grad T| from T (n_nodes,) degC: the mean vector of the tetrahedra around, by volume."""
    flux = heat_flux(nodes, T, {part: Axial(*k) for part, k in conductivity.items()})
    corners = nodes.points[nodes.tets]
    volume = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1])) / 6
    weight = np.bincount(nodes.tets.ravel(), np.repeat(volume, 4), nodes.size)
    mean = [np.bincount(nodes.tets.ravel(), np.repeat(volume * flux[:, k], 4), nodes.size) / weight for k in range(3)]
    return np.asarray(1e-3 * np.linalg.norm(mean, axis=0))
