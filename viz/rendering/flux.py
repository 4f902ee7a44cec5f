"""Heat flux in the solid parts, computed tetrahedron by tetrahedron, and as the viewer's page mixes it at the nodes."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from viz.rendering.nodes import SplitMesh, on_nodes


class HasTensor(Protocol):
    """A conductivity: tensor(x) is (n, 3, 3) W/m/K at points x (n, 3) m."""

    def tensor(self, x: Array) -> Array: ...


def heat_flux(nodes: SplitMesh, T: Array, conductivity: Mapping[str, HasTensor]) -> Array:
    """-k grad T (n_tets, 3) W/m2 from temperatures (n_nodes,) degC; exact for a field linear in each tetrahedron."""
    missing = [part for part in nodes.parts if part not in conductivity]
    if missing:
        raise InputError(f"no conductivity for {', '.join(missing)}", "flux", "one per part, as for fem.assemble")
    corners, values = nodes.points[nodes.tets], on_nodes(nodes, T)[nodes.tets]
    edges, rises = corners[:, 1:] - corners[:, :1], values[:, 1:] - values[:, :1]
    gradient = np.linalg.solve(edges, rises[..., None])
    out, middle = np.empty((len(nodes.tets), 3)), corners.mean(axis=1)
    for i, part in enumerate(nodes.parts):
        mine = nodes.region == i
        out[mine] = -(conductivity[part].tensor(middle[mine]) @ gradient[mine])[..., 0]
    return out


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
