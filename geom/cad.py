"""Exact solids of a machine (cadquery), their export, and the check of their surfaces (trimesh)."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.errors import InputError
from geom.kept import kept_file, written_whole
from geom.machine import Machine
from geom.palette import colour
from geom.part import Part
from geom.step import step_sidecar

if TYPE_CHECKING:
    import cadquery as cq
    import trimesh

FORMATS = ("step", "stl", "glb")


@dataclass(frozen=True)
class CadCheck:
    """One part's surface: volumes of formula, solid and triangulated surface (m3), pieces, watertight or not."""

    part: str
    volume: float
    solid_volume: float
    surface_volume: float
    pieces: int
    watertight: bool


def solids(part: Part, cache: Path | str | None = None) -> list[cq.Solid]:
    """Exact solids (mm), touching prisms of the part fused into one.

    cache : folder of solids by content of their prisms, so that only what changed is built; None for no cache
    """
    import cadquery as cq

    kept = kept_file(part, cache, "solid", "brep")
    if kept is None:
        return _built(part)
    if kept.exists():
        return [cq.Solid(solid.wrapped) for solid in cq.Shape.importBin(str(kept)).Solids()]
    found = _built(part)
    with written_whole(kept) as partial:
        cq.Compound.makeCompound(found).exportBin(str(partial))
    return found


def _built(part: Part) -> list[cq.Solid]:
    import cadquery as cq

    prisms = [_prism(profile, z0, z1) for profile, z0, z1 in part.prisms]
    if len(_stacked(part)) == len(prisms):
        return prisms
    whole = prisms[0].fuse(*prisms[1:])  # clean() is slow and has made invalid solids
    return [cq.Solid(solid.wrapped) for solid in whole.Solids()]


def _prism(profile: Any, z0: float, z1: float) -> cq.Solid:
    import cadquery as cq

    face = profile.scaled(1e3).to_face()
    return cq.Solid.extrudeLinear(face, cq.Vector(0, 0, (z1 - z0) * 1e3)).translate(cq.Vector(0, 0, z0 * 1e3))


def _stacked(part: Part) -> set[int]:
    """Indices of prisms that touch no other prism of the part at an end plane."""
    starts = [round(z0, 7) for _, z0, _ in part.prisms]
    ends = [round(z1, 7) for _, _, z1 in part.prisms]
    return {i for i, (a, b) in enumerate(zip(starts, ends)) if a not in ends and b not in starts}


def assembly(machine: Machine, cache: Path | str | None = None) -> cq.Assembly:
    """All parts as a coloured assembly (mm), named as everywhere else."""
    import cadquery as cq

    whole = cq.Assembly(name=machine.name)
    for part in machine.parts:
        shape = cq.Compound.makeCompound(solids(part, cache))
        whole.add(shape, name=part.name, color=cq.Color(*colour(part.material)))
    return whole


def export_cad(
    machine: Machine, folder: Path | str, formats: tuple[str, ...] = FORMATS, cache: Path | str | None = None
) -> dict[str, Path]:
    """Write the machine as STEP and GLB assemblies and one STL per part (mm); returns what was written.

    Keys are "step", "glb" and "stl:<part>". Beside the STEP file its materials are written, as `import_step` reads
    them. Raises InputError for an unknown format.
    """
    for name in formats:
        if name not in FORMATS:
            raise InputError(f"unknown format {name!r}", "export", f"known: {', '.join(FORMATS)}")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    whole = assembly(machine, cache)
    written: dict[str, Path] = {}
    for name in [name for name in ("step", "glb") if name in formats]:
        written[name] = folder / f"{machine.name}.{name}"
        whole.export(str(written[name]), tolerance=0.1, angularTolerance=0.1)
    if "step" in formats:
        step_sidecar(written["step"]).write_text(_materials(machine), encoding="utf-8")
    if "stl" in formats:
        for child in whole.children:
            path = written[f"stl:{child.name}"] = folder / f"{child.name}.stl"
            shape: Any = child.obj
            shape.exportStl(str(path), tolerance=0.05, angularTolerance=0.1)
    return written


def _materials(machine: Machine) -> str:
    """What a STEP file cannot say, as TOML."""
    lines = [f"{json.dumps(part.name)} = {json.dumps(part.material)}" for part in machine.parts]
    head = ["[machine]", f"name = {json.dumps(machine.name)}", f"description = {json.dumps(machine.description)}"]
    return "\n".join([*head, "", "[materials]", *lines, ""])


def check_cad(machine: Machine, tolerance_mm: float = 0.02, cache: Path | str | None = None) -> list[CadCheck]:
    """Volume and watertightness of every part; the surface is triangulated to the tolerance."""
    return [_checked(part, tolerance_mm, cache) for part in machine.parts]


def _checked(part: Part, tolerance_mm: float, cache: Path | str | None) -> CadCheck:
    kept = kept_file(part, cache, f"check-{tolerance_mm:g}", "json")
    if kept is not None and kept.exists():
        return CadCheck(**{**json.loads(kept.read_text()), "part": part.name})
    found = solids(part, cache)
    surfaces = [surface(solid, tolerance_mm) for solid in found]
    check = CadCheck(
        part=part.name,
        volume=part.volume,
        solid_volume=sum(solid.Volume() for solid in found) * 1e-9,
        surface_volume=sum(float(mesh.volume) for mesh in surfaces) * 1e-9,
        pieces=len(found),
        watertight=all(bool(mesh.is_watertight) for mesh in surfaces),
    )
    if kept is not None:
        with written_whole(kept) as partial:
            partial.write_text(json.dumps(vars(check)))
    return check


def surface(solid: cq.Solid, tolerance_mm: float) -> trimesh.Trimesh:
    """Triangulated surface (mm) with equal points merged."""
    import trimesh

    points, triangles = solid.tessellate(tolerance_mm, 0.1)
    return trimesh.Trimesh([point.toTuple() for point in points], triangles, process=True)
