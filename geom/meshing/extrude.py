"""From triangles to tetrahedra: extrusion of every block, and the names of all faces."""

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise

import numpy as np
import shapely

from geom.arrays import Array, Ints
from geom.description.part import Part
from geom.limits import MESH_POINTS
from geom.meshing.blocks import Block, Column
from geom.meshing.mesh import Contact, NamedMesh, Patch
from geom.meshing.partition import AMBIENT, GRID, Partition
from geom.meshing.triangulate import Triangulation

FaceName = Callable[[str, str], str]
THINNER = 0.25  # a layer over the next one inwards: what an end disturbs dies away within a few layers
ASIDE = 2e-6  # m; so far beyond a border is its other side: border points are moved by a micrometre of a metre
Walls = list[tuple[Ints, Ints]]  # triangles (n, 3) and the labels (n, 2) on their two sides


def extrude(
    cut: Partition,
    blocks: Sequence[Block],
    columns: Sequence[Column],
    flat: Triangulation,
    axial_size: float,
    face_name: FaceName,
    ends: Sequence[str] = (),
) -> NamedMesh:
    """The named tetrahedral mesh over a triangulation; layers are at most axial_size (m) thick.

    ends : parts towards whose ends layers become thinner, a step for each time a part is named
    """
    bases = [_base(index, columns, flat) for index in range(len(blocks))]
    heights = [_heights(cut, block, axial_size, np.unique(of), ends) for block, (_, of) in zip(blocks, bases)]
    z = np.unique(np.concatenate(heights))
    ranks = [np.searchsorted(z, height) * len(flat.points) for height in heights]
    points = sum(len(np.unique(base)) * len(rank) for (base, _), rank in zip(bases, ranks))
    MESH_POINTS.check(points, "mesh", "would have")
    tets = np.concatenate([_tets(base, rank) for (base, _), rank in zip(bases, ranks)])
    label = np.concatenate([np.tile(labels, 3 * (len(rank) - 1)) for (_, labels), rank in zip(bases, ranks)])
    walls = [wall for column, base in zip(columns, flat.triangles) for wall in _floors(column, base, ranks)]
    tree = shapely.STRtree(cut.faces)
    for block, base, rank in zip(blocks, bases, ranks):
        walls += _sides(cut, tree, block, flat.points, base, rank)
    return _assembled(flat.points, z, tets, label, walls, cut.parts, face_name)


def _heights(cut: Partition, block: Block, axial_size: float, labels: Ints, ends: Sequence[str]) -> Array:
    z0, z1 = cut.levels[block.first], cut.levels[block.last + 1]
    pieces = max(1, int(np.ceil((z1 - z0) / axial_size - 1e-6)))
    z = np.linspace(z0, z1, pieces + 1)
    parts = [cut.parts[label] for label in labels if cut.parts[label].name in ends]
    low, high = (
        max((ends.count(part.name) for part in parts if abs(part.span[side] - level) < GRID), default=0)
        for side, level in enumerate((z0, z1))
    )
    steps = THINNER ** np.arange(1, max(low, high) + 1)
    inner = np.concatenate([z0 + (z[1] - z0) * steps[:low], z1 - (z1 - z[-2]) * steps[:high]])
    return np.unique(np.round(np.concatenate([z, inner]), 9))


def _base(index: int, columns: Sequence[Column], flat: Triangulation) -> tuple[Ints, Ints]:
    """Triangles under one block, corners sorted, and their labels."""
    columns_of = [(c.labels[c.blocks.index(index)], t) for c, t in zip(columns, flat.triangles) if index in c.blocks]
    labels = np.concatenate([np.full(len(triangles), label) for label, triangles in columns_of])
    return np.sort(np.concatenate([triangles for _, triangles in columns_of]), axis=1), labels


def _tets(base: Ints, rank: Ints) -> Ints:
    """Three tetrahedra per prism; corners in the order of their plane numbers make neighbours agree on diagonals."""
    stacks = []
    for low, high in pairwise(rank):
        (p, q, r), (s, t, u) = base.T + low, base.T + high
        stacks += [np.column_stack(corners) for corners in ((p, q, r, u), (p, q, t, u), (p, s, t, u))]
    return np.concatenate(stacks)


def _floors(column: Column, triangles: Ints, ranks: Sequence[Ints]) -> Walls:
    """Horizontal faces of a column: under it, over it, and where the part changes on the way."""
    labels = (column.below, *column.labels, column.above)
    levels = [*(ranks[index][0] for index in column.blocks), ranks[column.blocks[-1]][-1]]
    return [
        (triangles + level, np.tile([low, high], (len(triangles), 1)))
        for level, low, high in zip(levels, labels, labels[1:])
        if low != high
    ]


def _sides(
    cut: Partition, tree: shapely.STRtree, block: Block, points: Array, base: tuple[Ints, Ints], rank: Ints
) -> Walls:
    """Vertical faces of a block: towards fluids, and between its parts."""
    triangles, labels = base
    ends = triangles[:, [0, 1, 1, 2, 0, 2]].reshape(-1, 2)
    owner = np.repeat(np.arange(len(triangles)), 3)
    order = np.argsort(ends @ [len(points), 1], kind="stable")
    ends, owner = ends[order], owner[order]
    twin = np.append((ends[1:] == ends[:-1]).all(axis=1), False)
    single = ~twin & ~np.roll(twin, 1)
    inner = np.column_stack([labels[owner[:-1][twin[:-1]]], labels[owner[1:][twin[:-1]]]])
    rim = ends[single]
    outside = _labels_beside(cut, tree, block.first, points[rim], points[triangles[owner[single]]].mean(axis=1))
    both = np.vstack([inner, np.column_stack([labels[owner[single]], outside])])
    i, j = np.vstack([ends[twin], rim])[both[:, 0] != both[:, 1]].T
    both = both[both[:, 0] != both[:, 1]]
    walls = []
    for low, high in pairwise(rank):
        walls += [(np.column_stack([i + low, j + low, j + high]), both)]
        walls += [(np.column_stack([i + low, i + high, j + high]), both)]
    return walls


def _labels_beside(cut: Partition, tree: shapely.STRtree, slab: int, ends: Array, inside: Array) -> Ints:
    """Labels of fluids just across each segment (n, 2, 2) from the points inside (n, 2)."""
    along = ends[:, 1] - ends[:, 0]
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.linalg.norm(along, axis=1)[:, None]
    towards = np.einsum("ij,ij->i", normal, inside - ends[:, 0]) > 0
    normal[towards] *= -1
    labels = np.full(len(ends), AMBIENT)
    points = shapely.points(ends.mean(axis=1) + ASIDE * normal)
    # Where a crevice ends in a tip the point lies past it, in a solid: then what touches the segment counts.
    for pairs in (tree.query(points, predicate="dwithin", distance=ASIDE), tree.query(points, predicate="intersects")):
        index, face = pairs[:, ~cut.solid[pairs[1], slab]]
        labels[index] = cut.labels[face, slab]
    return labels


def _assembled(
    plane: Array, z: Array, tets: Ints, label: Ints, walls: Walls, parts: Sequence[Part], face_name: FaceName
) -> NamedMesh:
    nodes, corners = np.unique(tets, return_inverse=True)
    points = np.column_stack([plane[nodes % len(plane)], z[nodes // len(plane)]])
    solid = np.array([part.solid for part in parts])
    names = tuple(part.name for part in parts if part.solid)
    facets = np.searchsorted(nodes, np.concatenate([triangles for triangles, _ in walls]))
    sides = np.concatenate([labels for _, labels in walls])
    tets = corners.reshape(-1, 4)
    a, b, c, d = (points[tets[:, i]] for i in range(4))
    negative = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    tets[negative] = tets[negative][:, [1, 0, 2, 3]]
    return NamedMesh(points, tets, (np.cumsum(solid) - 1)[label], names, *_named(facets, sides, parts, face_name))


def _named(
    facets: Ints, sides: Ints, parts: Sequence[Part], face_name: FaceName
) -> tuple[Mapping[str, Patch], Mapping[str, Contact]]:
    """Patches and contacts from the facets and the labels on both sides."""
    names = [*(part.name for part in parts), "ambient"]
    solid = [*(part.solid for part in parts), False]
    pairs, which = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    groups = np.split(np.argsort(which, kind="stable"), np.cumsum(np.bincount(which))[:-1])
    patches, contacts = {}, {}
    for (i, j), members in zip(pairs, groups):
        if solid[i] and solid[j]:
            a, b = sorted((names[i], names[j]))
            contacts[f"{a}|{b}"] = Contact(a, b, facets[members])
        else:
            part, fluid = (names[i], names[j]) if solid[i] else (names[j], names[i])
            patches[face_name(part, fluid)] = Patch(part, fluid, facets[members])
    return dict(sorted(patches.items())), dict(sorted(contacts.items()))
