"""From triangles to tetrahedra: extrusion over the axial slabs, and the names of all faces."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from geom.mesh import Contact, NamedMesh, Patch
from geom.part import Part
from geom.partition import AMBIENT
from geom.triangulate import Triangulation

Ints = NDArray[np.int64]


def layers(levels: NDArray[np.float64], axial_size: float) -> tuple[NDArray[np.float64], Ints]:
    """Axial positions after dividing slabs into layers of at most axial_size (m), and the slab of each layer."""
    counts = np.maximum(1, np.ceil(np.diff(levels) / axial_size - 1e-6)).astype(int)
    pieces = [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(levels, levels[1:], counts)]
    return np.append(np.concatenate(pieces), levels[-1]), np.repeat(np.arange(len(counts)), counts)


def extrude(
    flat: Triangulation,
    levels: NDArray[np.float64],
    axial_size: float,
    parts: Sequence[Part],
    face_name: Callable[[str, str], str],
) -> NamedMesh:
    """The named tetrahedral mesh over a triangulation."""
    z, slab = layers(levels, axial_size)
    solid = np.array([part.solid for part in parts] + [False])
    tets, label = _tets(flat, slab, solid)
    facets, sides = _faces(flat, slab, solid)
    used = np.zeros(len(z) * len(flat.points), dtype=bool)
    used[tets.ravel()] = True
    number = np.cumsum(used) - 1
    points = np.column_stack([np.tile(flat.points, (len(z), 1)), np.repeat(z, len(flat.points))])[used]
    names = tuple(part.name for part in parts if part.solid)
    region = (np.cumsum(solid[:-1]) - 1)[label]
    tets = _positive(points, number[tets])
    return NamedMesh(points, tets, region, names, *_named(number[facets], sides, parts, face_name))


def _tets(flat: Triangulation, slab: Ints, solid: NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """Three tetrahedra per solid prism; sorting by plane point number makes neighbours agree on diagonals."""
    n = len(flat.points)
    a, b, c = np.sort(flat.triangles, axis=1).T
    tets, labels = [], []
    for layer, s in enumerate(slab):
        label = flat.labels[:, s]
        here = solid[label]
        p, q, r = (corner[here] + layer * n for corner in (a, b, c))
        stack = ((p, q, r, r + n), (p, q, q + n, r + n), (p, p + n, q + n, r + n))
        tets += [np.column_stack(corners) for corners in stack]
        labels += [label[here]] * 3
    return np.concatenate(tets), np.concatenate(labels)


def _faces(flat: Triangulation, slab: Ints, solid: NDArray[np.bool_]) -> tuple[Ints, Ints]:
    """Triangles between different labels, at least one of them solid, with the two labels."""
    n = len(flat.points)
    facets, sides = [], []
    triangles = np.sort(flat.triangles, axis=1)
    nothing = np.full(len(triangles), AMBIENT)
    columns = [nothing, *(flat.labels[:, s] for s in slab), nothing]
    for level, (below, above) in enumerate(zip(columns, columns[1:])):
        wall = (below != above) & (solid[below] | solid[above])
        facets.append(triangles[wall] + level * n)
        sides.append(np.column_stack([below, above])[wall])
    for layer, s in enumerate(slab):
        left, right = flat.left[:, s], flat.right[:, s]
        wall = (left != right) & (solid[left] | solid[right])
        i, j = flat.sides[wall].T + layer * n
        facets += [np.column_stack([i, j, j + n]), np.column_stack([i, i + n, j + n])]
        sides += [np.column_stack([left, right])[wall]] * 2
    return np.concatenate(facets), np.concatenate(sides)


def _positive(points: NDArray[np.float64], tets: Ints) -> Ints:
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    negative = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[negative] = tets[negative][:, [1, 0, 2, 3]]
    return tets


def _named(
    facets: Ints, sides: Ints, parts: Sequence[Part], face_name: Callable[[str, str], str]
) -> tuple[Mapping[str, Patch], Mapping[str, Contact]]:
    """Patches and contacts from the facets and the labels on both sides."""
    names = [part.name for part in parts] + ["ambient"]
    solids = [part.solid for part in parts] + [False]
    pairs, which = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    groups = np.split(np.argsort(which, kind="stable"), np.cumsum(np.bincount(which))[:-1])
    patches, contacts = {}, {}
    for (i, j), members in zip(pairs, groups):
        if solids[i] and solids[j]:
            a, b = sorted((names[i], names[j]))
            contacts[f"{a}|{b}"] = Contact(a, b, facets[members])
        else:
            part, fluid = (names[i], names[j]) if solids[i] else (names[j], names[i])
            patches[face_name(part, fluid)] = Patch(part, fluid, facets[members])
    return dict(sorted(patches.items())), dict(sorted(contacts.items()))
