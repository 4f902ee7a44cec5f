"""The check of a machine's solids: are their surfaces closed (trimesh), and is their volume that of the formula?"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from geom.description.machine import Machine
from geom.description.part import Part
from geom.disk_cache import atomic_write, cache_file, recalled
from geom.solids.cad import solids

if TYPE_CHECKING:
    import cadquery as cq
    import trimesh


@dataclass(frozen=True)
class CadCheck:
    """One part's surface: volumes of formula, solid and triangulated surface (m3), pieces, watertight or not."""

    part: str
    volume: float
    solid_volume: float
    surface_volume: float
    pieces: int
    watertight: bool


def check_cad(machine: Machine, tolerance_mm: float = 0.02, cache: Path | str | None = None) -> list[CadCheck]:
    """Volume and watertightness of every part; the surface is triangulated to the tolerance."""
    return [_checked(part, tolerance_mm, cache) for part in machine.parts]


def _checked(part: Part, tolerance_mm: float, cache: Path | str | None) -> CadCheck:
    file = cache_file(part, cache, f"check-{tolerance_mm:g}", "json")
    known = file and recalled(file, lambda path: CadCheck(**{**json.loads(path.read_text()), "part": part.name}))
    if known:
        return known
    exact = solids(part, cache)
    surfaces = [surface(solid, tolerance_mm) for solid in exact]
    check = CadCheck(
        part=part.name,
        volume=part.volume,
        solid_volume=sum(solid.Volume() for solid in exact) * 1e-9,
        surface_volume=sum(float(mesh.volume) for mesh in surfaces) * 1e-9,
        pieces=len(exact),
        watertight=all(bool(mesh.is_watertight) for mesh in surfaces),
    )
    if file is not None:
        with atomic_write(file) as partial:
            partial.write_text(json.dumps(vars(check)))
    return check


def surface(solid: cq.Solid, tolerance_mm: float) -> trimesh.Trimesh:
    """Triangulated surface (mm) with equal points merged."""
    import trimesh

    points, triangles = solid.tessellate(tolerance_mm, 0.1)
    return trimesh.Trimesh([point.toTuple() for point in points], triangles, process=True)
