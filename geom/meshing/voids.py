"""Voids that the outside does not reach: each must belong to a declared fluid."""

from dataclasses import replace

import numpy as np
import shapely

from geom.arrays import Mask
from geom.errors import InputError
from geom.groups import joined_groups
from geom.meshing.partition import AMBIENT, Partition


def filled(cut: Partition) -> Partition:
    """The partition with closed voids given to the fluid that has no prisms of its own, if there is one.

    Raises InputError for a closed void that no fluid fills.
    """
    hidden = _hidden(cut)
    if not hidden.any():
        return cut
    takers = [i for i, part in enumerate(cut.parts) if not part.solid and not part.prisms]
    if not takers:
        face, slab = np.argwhere(hidden)[0]
        point, z = shapely.point_on_surface(cut.faces[face]), cut.levels[slab : slab + 2].mean()
        what = f"closed void around x, y, z = {point.x * 1e3:.1f}, {point.y * 1e3:.1f}, {z * 1e3:.1f} mm"
        raise InputError(what, "geometry", "declare the fluid that fills it, or close it")
    return replace(cut, labels=np.where(hidden, takers[0], cut.labels))


def _hidden(cut: Partition) -> Mask:
    """(n_face, n_slab) True in voids without a label and without a way out."""
    void = cut.labels == AMBIENT
    n_face, n_slab = void.shape
    cell = np.arange(n_face * n_slab).reshape(n_face, n_slab)
    outside = n_face * n_slab
    inner = (cut.left >= 0) & (cut.right >= 0)
    a, b = cut.left[inner], cut.right[inner]
    beside = void[a] & void[b]
    above = void[:, :-1] & void[:, 1:]
    rim = np.concatenate([cut.left[cut.right < 0], cut.right[cut.left < 0]])
    open_cells = np.concatenate([cell[rim].ravel(), cell[:, 0][void[:, 0]], cell[:, -1][void[:, -1]]])
    first = np.concatenate([cell[a][beside], cell[:, :-1][above], open_cells])
    second = np.concatenate([cell[b][beside], cell[:, 1:][above], np.full(len(open_cells), outside)])
    component = joined_groups(outside + 1, np.column_stack([first, second]))
    return void & (component[:-1].reshape(n_face, n_slab) != component[-1])
