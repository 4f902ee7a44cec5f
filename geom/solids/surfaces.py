"""The check of a machine's solids: are their surfaces closed (trimesh), and is their volume that of the formula?"""

import json
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from geom.description.machine import Machine
from geom.description.part import Part
from geom.disk_cache import cache_file, recalled, store
from geom.solids.cad import solids

if TYPE_CHECKING:
    import cadquery as cq
    import trimesh

ANGLE = 0.1  # rad
_STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


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
    import cadquery as cq

    file = cache_file(part, cache, f"check-{tolerance_mm:g}", "json")
    check = file and recalled(file, lambda path: CadCheck(**{**json.loads(path.read_text()), "part": part.name}))
    if check:
        return check
    exact = solids(part, cache)
    times = Counter(solid.located(cq.Location()) for solid in exact)  # copies of one solid are looked at once
    surfaces = {solid: surface(solid, tolerance_mm) for solid in times}
    check = CadCheck(
        part=part.name,
        volume=part.volume,
        solid_volume=sum(n * solid.Volume() for solid, n in times.items()) * 1e-9,
        surface_volume=sum(n * float(surfaces[solid].volume) for solid, n in times.items()) * 1e-9,
        pieces=len(exact),
        watertight=all(bool(mesh.is_watertight) for mesh in surfaces.values()),
    )
    if file is not None:
        store(file, json.dumps(vars(check)))
    return check


def surface(solid: "cq.Solid", tolerance_mm: float) -> "trimesh.Trimesh":
    """Triangulated surface (mm) with equal points merged.

    tolerance_mm : how far triangles may lie from the solid; they also turn by at most `ANGLE` from one to the next
    """
    import trimesh
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools
    from OCP.IMeshTools import IMeshTools_MeshAlgoType, IMeshTools_Parameters

    how = IMeshTools_Parameters()
    how.Deflection, how.Angle = tolerance_mm, ANGLE
    how.MeshAlgo = IMeshTools_MeshAlgoType.IMeshTools_MeshAlgoType_Delabella  # five times as fast on a plate with slots
    BRepTools.Clean_s(solid.wrapped)
    BRepMesh_IncrementalMesh(solid.wrapped, how)
    corners = _triangles(solid)
    return trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3), process=True)


def _triangles(solid: "cq.Solid") -> Array:
    """(3 n, 3) corners (mm), by a binary STL file: asked for one by one they take longer than to be made."""
    from OCP.StlAPI import StlAPI_Writer

    writer = StlAPI_Writer()
    writer.ASCIIMode = False
    with TemporaryDirectory() as folder:
        file = Path(folder) / "surface.stl"
        writer.Write(solid.wrapped, str(file))
        return np.fromfile(file, _STL, offset=84)["corners"].reshape(-1, 3).astype(float)
