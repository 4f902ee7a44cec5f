"""Exact solids of a machine (cadquery) and their export."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.description.machine import Machine, step_sidecar
from geom.description.materials import colour, entry_of
from geom.description.names import file_stem
from geom.description.part import CadShape, Helix, Part, Prism, Rod
from geom.description.roles import Identity
from geom.disk_cache import cache_file, recalled, stored
from geom.errors import InputError
from geom.solids.brep import Boundary
from geom.solids.screw import channel
from geom.solids.stack import stacked

if TYPE_CHECKING:
    import cadquery as cq

FORMATS = ("step", "stl", "glb")
_DIGITS = 10  # of a length (m); profiles that agree in them are equal


def solids(part: Part, cache: Path | str | None = None) -> list[cq.Solid]:
    """Exact solids (mm), prisms that stand on one another made one; with ports and helices as they are made.

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
    with stored(file) as partial:
        cq.Compound.makeCompound(exact).exportBin(str(partial))
    return exact


def _built(part: Part) -> list[cq.Solid]:
    if part.cad_shape is not None:
        return carved(part.cad_shape)
    starts, ends = ({round(z, 7) for z in planes} for planes in list(zip(*part.prisms))[1:])
    return stacked(part.prisms) if starts & ends else _single(part.prisms)


def _single(prisms: Sequence[Prism]) -> list[cq.Solid]:
    """Prisms of which none stands on another; of equal ones around the axis one is built, the others are it, turned."""
    import cadquery as cq

    solids_of: dict[tuple[Any, ...], tuple[float, cq.Solid]] = {}
    out = []
    for profile, z0, z1 in prisms:
        angle = math.atan2(profile.outer[0][1], profile.outer[0][0])
        shape = np.concatenate([np.ravel(loop) for loop in profile.rotated(-angle).loops]).round(_DIGITS)
        key = (*(len(loop) for loop in profile.loops), *(shape + 0.0).tolist(), z0, z1)
        if key not in solids_of:
            solids_of[key] = angle, stacked([(profile, z0, z1)])[0]
        first, solid = solids_of[key]
        out.append(solid.moved(cq.Location(cq.Vector(), cq.Vector(0, 0, 1), math.degrees(angle - first))))
    return out


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
            path = paths[f"stl:{child.name}"] = folder / f"{file_stem(child.name)}.stl"
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
        # What a STEP file cannot say, as TOML.
        import tomlkit

        roles = {part.name: _role(part.identity) for part in machine.parts if part.identity is not None}
        document = {
            "machine": {"name": machine.name, "description": machine.description},
            "materials": {part.name: entry_of(part.material, part.properties) for part in machine.parts},
        }
        step_sidecar(path).write_text(tomlkit.dumps(document | ({"roles": roles} if roles else {})), encoding="utf-8")
    return {key: path for key, (path, _) in files.items()}


def _role(identity: Identity) -> dict[str, str | bool]:
    return ({} if identity.role is None else {"role": str(identity.role)}) | {"turns": bool(identity.turns)}


def write_glb(whole: cq.Assembly, path: Path) -> None:
    """The assembly (mm, z along the machine's axis) as glTF, binary, as its users expect it: metres, y upwards, one
    named node per part."""
    from cadquery.occ_impl.assembly import toCAF
    from OCP.Message import Message_ProgressRange
    from OCP.RWGltf import RWGltf_CafWriter
    from OCP.RWMesh import RWMesh_CoordinateSystem
    from OCP.TCollection import TCollection_AsciiString
    from OCP.TColStd import TColStd_IndexedDataMapOfStringString

    _, document = toCAF(whole, False, True, 0.1, 0.1)  # mm, rad: how far triangles may lie from the surface
    writer = RWGltf_CafWriter(TCollection_AsciiString(str(path)), True)
    writer.SetMergeFaces(True)
    system = writer.ChangeCoordinateSystemConverter()
    system.SetInputLengthUnit(1e-3)  # m
    system.SetInputCoordinateSystem(RWMesh_CoordinateSystem.RWMesh_CoordinateSystem_Zup)
    writer.Perform(document, TColStd_IndexedDataMapOfStringString(), Message_ProgressRange())


def carved(shape: CadShape) -> list[cq.Solid]:
    """The solids (mm) that are left of the start: round ports and helical channels, which prisms can only simplify.

    Helices lie wholly inside the start.
    """
    import cadquery as cq

    body: Any
    (body,) = [_rod(shape.start)] if isinstance(shape.start, Rod) else stacked(shape.start)
    voids = [channel(cut) for cut in shape.cuts if isinstance(cut, Helix)]
    if voids:
        shells = [shell.wrapped for shell in body.Shells()]
        inside = [shell.wrapped.Reversed() for void in voids for shell in void.Shells()]
        body = Boundary().solid([*shells, *inside])
    pieces = (cut for cut in shape.cuts if not isinstance(cut, Helix))
    tools = [_rod(piece) if isinstance(piece, Rod) else stacked([piece])[0] for piece in pieces]
    return [cq.Solid(solid.wrapped) for solid in body.cut(*tools).Solids()] if tools else [body]


def _rod(rod: Rod) -> cq.Solid:
    import cadquery as cq

    out = cq.Vector(math.cos(rod.angle), math.sin(rod.angle), 0)
    foot = out * (rod.inner * 1e3) + cq.Vector(0, 0, rod.z * 1e3)
    return cq.Solid.makeCylinder(rod.diameter * 500, (rod.outer - rod.inner) * 1e3, foot, out)
