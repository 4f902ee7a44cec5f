"""A machine's named mesh: partition the plane once, triangulate once, extrude."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

from geom.description.machine import Machine
from geom.description.part import Part
from geom.disk_cache import recalled, stored
from geom.meshing.blocks import Block, Column, find_blocks, find_columns
from geom.meshing.extrude import extrude
from geom.meshing.mesh import NamedMesh
from geom.meshing.meshio_io import read_npz, write_npz
from geom.meshing.partition import Partition, filled, partition
from geom.meshing.triangulate import Triangulation, triangulate

COARSE: dict[str, Any] = {"size_m": 0.06, "segments": 44, "across": 1}  # for a first look and for tests
# A fifth of it: finer moves no temperature that is read.
FINE: dict[str, Any] = {"size_m": 0.012, "segments": 72, "across": 4}


def build_mesh(
    machine: Machine,
    size_m: float = 0.03,
    segments: int = 48,
    across: float = 2,
    axial_m: float | None = None,
    cache: Path | str | None = None,
    ends: Sequence[str] = (),
    finer: Sequence[str] = (),
) -> NamedMesh:
    """Conformal tetrahedra of the machine's solids, with named regions, faces and contacts.

    size_m : largest triangle in the plane (m)
    segments : chords per turn of an arc; 36 loses 0.5 % of a circle's area, 72 an eighth of a per cent
    across : elements over the width of a compact face, such as the winding in a slot
    axial_m : largest element along the axis (m), 1.5 * size_m if None
    cache : folder of meshes by content; None for no cache
    ends : parts towards whose ends layers become thinner, a step for each time a part is named
    finer : parts with smaller triangles, half as large for each time a part is named
    `build_mesh(machine, **COARSE)` is quick, `**FINE` converged.
    Raises InputError where solids overlap or a closed void is not declared as a fluid.
    """
    axial = 1.5 * size_m if axial_m is None else axial_m
    file = None
    if cache is not None:  # named by what a mesh depends on: shapes and names, not materials
        settings = (size_m, segments, across, axial, *sorted(ends), "/", *sorted(finer))
        shapes = [(part.name, part.prisms, part.solid) for part in (*machine.parts, *machine.fluids)]
        content = repr((shapes, sorted(machine.face_names.items()), settings)).encode()
        file = Path(cache) / f"mesh-{hashlib.sha256(content).hexdigest()[:20]}.npz"
    identities = {part.name: identity for part in machine.parts if (identity := part.identity) is not None}
    if file is not None and (cached := recalled(file, read_npz)) is not None:
        return replace(cached, identities=identities)
    cut, blocks, columns = _planned((*machine.parts, *machine.fluids), segments)
    flat = _triangulated((*machine.parts, *machine.fluids), segments, size_m, across, tuple(sorted(finer)))
    mesh = extrude(cut, blocks, columns, flat, axial, machine.face_name, ends)
    if file is not None:
        with stored(file) as partial:
            write_npz(mesh, partial)
    return replace(mesh, identities=identities)


@lru_cache(maxsize=4)
def _planned(parts: tuple[Part, ...], segments: int) -> tuple[Partition, list[Block], list[Column]]:
    """What a mesh of any size starts from, the plane partition and its columns; refining does not partition again."""
    cut = filled(partition(parts, segments))
    blocks = find_blocks(cut)
    return cut, blocks, find_columns(cut, blocks)


@lru_cache(maxsize=8)
def _triangulated(
    parts: tuple[Part, ...], segments: int, size_m: float, across: float, finer: tuple[str, ...]
) -> Triangulation:
    """Triangles of the plane; kept, so that other layers do not cut it again."""
    cut, _, columns = _planned(parts, segments)
    times = {label: finer.count(part.name) for label, part in enumerate(cut.parts)}
    return triangulate(columns, size_m, across, times)
