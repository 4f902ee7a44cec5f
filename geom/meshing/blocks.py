"""Which levels and which borders a mesh really needs.

A block is a laterally connected set of solid faces over an axial range in which nothing about it changes:
a level where only the rotor changes does not cut the housing. A column is a stack of blocks over one piece
of the plane: the flange over the slots is not cut by the slots.
"""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from geom.arrays import Ints
from geom.groups import joined_groups
from geom.meshing.partition import AMBIENT, Partition


@dataclass(frozen=True)
class Block:
    """Solid faces (indices) of the slabs first ... last, all of them alike."""

    faces: Ints
    first: int
    last: int


@dataclass(frozen=True)
class Column:
    """Neighbouring faces, merged, that belong to the same blocks with the same labels.

    face : polygon (m); blocks : from bottom to top; labels : index of the part in each of them
    below, above : label of what lies under and over the whole stack, never solid
    """

    face: shapely.Polygon
    blocks: tuple[int, ...]
    labels: tuple[int, ...]
    below: int
    above: int


def find_blocks(cut: Partition) -> list[Block]:
    """Blocks in order of their first slab."""
    blocks: list[Block] = []
    growing: list[Block] = []
    for slab in range(cut.labels.shape[1]):
        # Sets of solid faces of one slab that are connected through common edges.
        solid = np.append(cut.solid[:, slab], False)
        inside = solid[cut.left] & solid[cut.right]
        component = joined_groups(len(solid), np.column_stack([cut.left[inside], cut.right[inside]]))
        members = defaultdict(list)
        for face in np.flatnonzero(solid):
            members[component[face]].append(face)
        groups = [np.array(faces) for faces in members.values()]
        extensions = [_continued(cut, growing, faces, slab) for faces in groups]
        open_ids = {id(block) for block, _ in extensions if block}
        blocks += [block for block in growing if id(block) not in open_ids]
        growing = [new for _, new in extensions]
    return sorted(blocks + growing, key=lambda block: (block.first, block.faces[0]))


def _continued(cut: Partition, growing: Sequence[Block], faces: Ints, slab: int) -> tuple[Block | None, Block]:
    """The block of the previous slab that goes on unchanged, if any, and the block up to this slab."""
    for block in growing:
        if np.array_equal(block.faces, faces):  # unchanged, if its neighbours are, too
            mine = np.isin(cut.left, faces) | np.isin(cut.right, faces)
            around = np.unique(np.concatenate([faces, cut.left[mine], cut.right[mine]]))
            around = around[around >= 0]
            if np.array_equal(cut.labels[around, slab], cut.labels[around, slab - 1]):
                return block, Block(faces, block.first, slab)
    return None, Block(faces, slab, slab)


def find_columns(cut: Partition, blocks: Sequence[Block]) -> list[Column]:
    """All columns; together they fill every block."""
    stacks: dict[tuple[tuple[int, ...], tuple[int, ...], int, int], list[int]] = defaultdict(list)
    over = np.full(cut.labels.shape, -1)
    for index, block in enumerate(blocks):
        over[block.faces, block.first : block.last + 1] = index
    for face, row in enumerate(over):
        # First and last index of each stretch of a row without -1.
        change = np.flatnonzero(np.diff(np.concatenate([[False], row >= 0, [False]]).astype(int)))
        for first, last in [(int(a), int(b) - 1) for a, b in change.reshape(-1, 2)]:
            stack = tuple(dict.fromkeys(row[first : last + 1].tolist()))
            labels = tuple(int(cut.labels[face, blocks[index].first]) for index in stack)
            stacks[stack, labels, _label(cut, face, first - 1), _label(cut, face, last + 1)].append(face)
    return [Column(piece, *key) for key, faces in stacks.items() for piece in _merged(cut.faces[faces])]


def _label(cut: Partition, face: int, slab: int) -> int:
    return int(cut.labels[face, slab]) if 0 <= slab < cut.labels.shape[1] else AMBIENT


def _merged(faces: NDArray[np.object_]) -> NDArray[np.object_]:
    return shapely.orient_polygons(shapely.get_parts(shapely.coverage_union_all(faces)))
