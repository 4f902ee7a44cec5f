"""Exact solids of a machine (cadquery) and their export."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.description.identity import Identity
from geom.description.machine import Machine
from geom.description.part import Part
from geom.disk_cache import atomic_write, cache_file, recalled
from geom.drawings.palette import colour
from geom.errors import InputError
from geom.solids.carved import carved, prism
from geom.solids.glb import write_glb
from geom.solids.step import step_sidecar

if TYPE_CHECKING:
    import cadquery as cq

FORMATS = ("step", "stl", "glb")


def solids(part: Part, cache: Path | str | None = None) -> list[cq.Solid]:
    """Exact solids (mm), touching prisms of the part fused into one; with ports and helices as they are made.

    cache : folder of solids by content of their prisms, so that only what changed is built; None for no cache
    """
    import cadquery as cq

    file = cache_file(part, cache, "solid", "brep")
    if file is None:
        return _built(part)
    solid = recalled(file, lambda path: [cq.Solid(s.wrapped) for s in cq.Shape.importBin(str(path)).Solids()])
    if solid:
        return solid
    exact = _built(part)
    with atomic_write(file) as partial:
        cq.Compound.makeCompound(exact).exportBin(str(partial))
    return exact


def _built(part: Part) -> list[cq.Solid]:
    import cadquery as cq

    if part.cad_shape is not None:
        return carved(part.cad_shape)
    prisms = [prism(profile, z0, z1) for profile, z0, z1 in part.prisms]
    if len(_stacked(part)) == len(prisms):
        return prisms
    whole = prisms[0].fuse(*prisms[1:])  # clean() is slow and has made invalid solids
    return [cq.Solid(solid.wrapped) for solid in whole.Solids()]


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
    """Write the machine as a STEP assembly (mm), a GLB scene (m) and one STL per part (mm); returns what was written.

    Keys are "step", "glb" and "stl:<part>". Beside the STEP file its materials are written, as `import_step` reads
    them. It reads prisms: of a machine with parts made otherwise (`Part.cad_shape`) they are in "step:prisms".
    Raises InputError for an unknown format.
    """
    for name in formats:
        if name not in FORMATS:
            raise InputError(f"unknown format {name!r}", "export", f"known: {', '.join(FORMATS)}")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    whole = assembly(machine, cache)
    paths: dict[str, Path] = {}
    if "step" in formats:
        paths |= _steps(machine, whole, folder, cache)
    if "glb" in formats:
        paths["glb"] = folder / f"{machine.name}.glb"
        write_glb(whole, paths["glb"])
    if "stl" in formats:
        for child in whole.children:
            path = paths[f"stl:{child.name}"] = folder / f"{child.name}.stl"
            shape: Any = child.obj
            shape.exportStl(str(path), tolerance=0.05, angularTolerance=0.1)
    return paths


def _steps(machine: Machine, whole: cq.Assembly, folder: Path, cache: Path | str | None) -> dict[str, Path]:
    """STEP files with their sidecars: as made, and where that differs, as prisms."""
    files = {"step": (folder / f"{machine.name}.step", whole)}
    if any(part.cad_shape is not None for part in machine.parts):
        plain = replace(machine, parts=tuple(replace(part, cad_shape=None) for part in machine.parts))
        files["step:prisms"] = (folder / f"{machine.name}-prisms.step", assembly(plain, cache))
    for path, what in files.values():
        what.export(str(path))
        step_sidecar(path).write_text(_materials(machine), encoding="utf-8")
    return {key: path for key, (path, _) in files.items()}


def _materials(machine: Machine) -> str:
    """What a STEP file cannot say, as TOML."""
    lines = [f"{json.dumps(part.name)} = {json.dumps(part.material)}" for part in machine.parts]
    head = ["[machine]", f"name = {json.dumps(machine.name)}", f"description = {json.dumps(machine.description)}"]
    entries = [f"{json.dumps(part.name)} = {_role(i)}" for part in machine.parts if (i := part.identity) is not None]
    return "\n".join([*head, "", "[materials]", *lines, "", *(["[roles]", *entries, ""] if entries else [])])


def _role(identity: Identity) -> str:
    words = [f"role = {json.dumps(identity.role)}"] if identity.role is not None else []
    return f"{{ {', '.join([*words, f'turns = {json.dumps(bool(identity.turns))}'])} }}"
