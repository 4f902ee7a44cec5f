"""A STEP assembly with named solids becomes a machine like any other: sliced into prisms, meshed, condensed.

Beside `motor.step` may lie `motor.step.toml`:

    [machine]
    name = "motor"                      # default: the file's name
    [import]
    axis = "x"                          # of the machine in the STEP file, default "z"
    origin_mm = [0.0, 0.0, 120.0]       # a point on the axis, default the STEP file's origin
    leave_out = ["bolt*"]               # solids to ignore
    [materials]
    "winding*" = "winding"              # a solid's name, or a pattern; else what parts of that name are made of here
    [fluids]
    coolant = "glycol-50"               # solids that stand for fluids
    [roles]
    "winding*" = "winding"              # its role (geom.description.roles); else guessed from material and place
    "armature" = { role = "winding", turns = true }

and the sections that machine files have besides (ratings, contacts, films, losses, fans, cooling, sensors ...).
Closed voids between the solids become the fluid "air.inside".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.description.machine import SECTIONS, Machine, step_sidecar
from geom.description.materials import material
from geom.description.names import checked_name, plain_name
from geom.description.part import Part, Prism
from geom.description.roles import Identity, Role
from geom.description.toml_file import read_toml
from geom.errors import InputError
from geom.limits import STEP_BYTES
from geom.solids.slicing import sliced

if TYPE_CHECKING:
    import cadquery as cq

INSIDE = "air.inside"
NOTHING = Identity()
_ROTATIONS = {"x": ((0, 1, 0), -90.0), "y": ((1, 0, 0), 90.0), "z": ((0, 0, 1), 0.0)}  # axis and angle (deg) onto z
_KEYS = {"machine": ("name", "description"), "import": ("axis", "origin_mm", "leave_out")}


def machine_in_step(path: Path, usual_materials: Callable[[], Mapping[str, str]]) -> Machine:
    """The machine in a STEP file, with what the TOML file beside it says.

    usual_materials : part name -> material, asked where the file beside it says nothing

    Raises InputError for a file that is missing or has no solids, a solid that is not prismatic along the axis, a
    solid without a known material, and for faults in the TOML file.
    """
    if not path.is_file():
        raise InputError("no such file", str(path), "a STEP file with named solids")
    beside = step_sidecar(path)
    sidecar = _read_sidecar(beside)
    solids = _without_excluded(_solids(path, sidecar.get("import", {}), str(beside)), sidecar, str(beside))
    prisms = _all_sliced(solids, path)
    fluids = sidecar.get("fluids", {})
    _refuse_unused({**sidecar.get("materials", {}), **fluids, **sidecar.get("roles", {})}, prisms, str(beside))
    what = _declared_roles(sidecar.get("roles", {}), prisms, f"{beside} [roles]")
    materials = sidecar.get("materials", {})
    parts = tuple(
        Part(name, _material(name, materials, beside, usual_materials), prisms[name], role=is_.role, turns=is_.turns)
        for name in prisms
        if name not in fluids
        for is_ in [what.get(name, NOTHING)]
    )
    spaces = tuple(
        Part(name, kind, prisms[name], solid=False, role=what.get(name, NOTHING).role or _space(kind))
        for name, kind in fluids.items()
    )
    header = sidecar.get("machine", {})
    return Machine(
        name=checked_name(header.get("name", path.stem), f"{beside} [machine] name"),
        family="step",
        description=header.get("description", f"imported from {path.name}"),
        parts=parts,
        fluids=(*spaces, Part(INSIDE, "air", (), solid=False, role=Role.INNER_AIR)),
        sections={name: table for name, table in sidecar.items() if name in SECTIONS and name != "machine"},
        geometry=None,
        face_names={},
    )


def _space(material_: str) -> Role:
    """What a declared fluid is where nothing else is said: a liquid cools, air is inside."""
    return Role.INNER_AIR if material_ == "air" else Role.COOLANT


def _declared_roles(patterns: Mapping[str, Any], names: Iterable[str], where: str) -> dict[str, Identity]:
    """Solid -> what [roles] says it is; a full name goes before a pattern."""
    out = {}
    for name in names:
        fitting = [name] if name in patterns else [p for p in patterns if fnmatchcase(name, p)]
        if fitting:
            out[name] = _role(patterns[fitting[0]], f"{where} {fitting[0]!r}")
    return out


def _role(entry: Any, where: str) -> Identity:
    table = {"role": entry} if isinstance(entry, str) else entry
    words = [role.value for role in Role]
    fine = isinstance(table, Mapping) and set(table) <= {"role", "turns"} and table.get("role", words[0]) in words
    if not fine or not isinstance(table.get("turns", True), bool):
        right = f"one of {', '.join(words)}; or {{ role = ..., turns = true }}"
        raise InputError(f"{entry!r} is no role", where, right)
    turns = table.get("turns")
    return Identity(Role(table["role"]) if "role" in table else None, None if turns is None else bool(turns))


def _read_sidecar(path: Path) -> dict[str, Any]:
    if not path.is_file():
        return {}
    sidecar = read_toml(path, "what a STEP file does not say: [materials], [fluids], [losses.NAME] ...")
    sections = (
        "import",
        "fluids",
        "roles",
        *(section for section in SECTIONS if section not in ("geometry", "outlines")),
    )
    for section, table in sidecar.items():
        if section not in sections or not isinstance(table, Mapping):
            raise InputError(f"unknown section [{section}]", str(path), f"known: {', '.join(sections)}")
        for key in table:
            if key not in _KEYS.get(section, (key,)):
                raise InputError(f"unknown key {key!r}", f"{path} [{section}]", f"known: {', '.join(_KEYS[section])}")
    return sidecar


def _solids(path: Path, sidecar: Mapping[str, Any], where: str) -> dict[str, list[cq.Solid]]:
    """Solids (mm) by name, turned and moved so that the machine's axis is z."""
    import cadquery as cq

    axis, origin = sidecar.get("axis", "z"), sidecar.get("origin_mm", [0.0, 0.0, 0.0])
    if axis not in _ROTATIONS:
        raise InputError(f"{axis!r} is no axis", f"{where} [import] axis", f"one of {', '.join(_ROTATIONS)}")
    if not (isinstance(origin, list) and len(origin) == 3 and all(isinstance(x, (int, float)) for x in origin)):
        raise InputError(f"{origin!r} is no point", f"{where} [import] origin_mm", "write [x, y, z]")
    rotation = cq.Location(cq.Vector(), cq.Vector(*_ROTATIONS[axis][0]), _ROTATIONS[axis][1])
    translation = cq.Location(cq.Vector(*(-float(x) for x in origin)))
    by_name: dict[str, list[cq.Solid]] = {}
    for shape, name, place, _ in _assembly(path):
        body = shape.moved(rotation * translation * place)
        if body.Solids():
            by_name.setdefault(name.split("/")[-1].replace("|", "_"), []).extend(body.Solids())
    if not by_name:
        raise InputError("no solids", str(path), "a STEP assembly of named solids")
    return by_name


def _assembly(path: Path) -> Any:
    import cadquery as cq

    STEP_BYTES.check(path.stat().st_size, path, "holds")
    with path.open("rb") as file:
        if b"ISO-10303-21" not in file.read(200):  # OpenCASCADE would say so on stdout
            raise InputError("not a STEP file", str(path), "a STEP assembly of named solids")
    try:
        return list(cq.Assembly.load(str(path)))
    except Exception as error:  # OpenCASCADE's readers raise whatever comes to hand
        raise InputError(f"not readable: {error}", str(path), "a STEP assembly of named solids") from error


def _without_excluded(
    solids: dict[str, list[cq.Solid]], sidecar: Mapping[str, Any], where: str
) -> dict[str, list[cq.Solid]]:
    patterns = sidecar.get("import", {}).get("leave_out", [])
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in solids):
            raise _no_solid(pattern, solids, f"{where} [import] leave_out")
    return {name: pieces for name, pieces in solids.items() if not any(fnmatchcase(name, p) for p in patterns)}


def _all_sliced(solids: Mapping[str, list[cq.Solid]], path: Path) -> dict[str, tuple[Prism, ...]]:
    """Prisms by name; one error that names every solid that cannot be sliced."""
    prisms, faults = {}, []
    for name, pieces in solids.items():
        try:
            prisms[plain_name(name, f"{path} solid")] = tuple(
                prism for solid in pieces for prism in sliced(solid, name)
            )
        except InputError as fault:
            faults.append(fault)
    if faults:
        what = "; ".join(f"{fault.where}: {fault.what}" for fault in faults)
        raise InputError(what, str(path), f"{faults[0].right} ([import] leave_out in {step_sidecar(path).name})")
    return prisms


def _refuse_unused(patterns: Mapping[str, Any], prisms: Mapping[str, Any], where: str) -> None:
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in prisms):
            raise _no_solid(pattern, prisms, where)


def _no_solid(pattern: str, names: Mapping[str, Any], where: str) -> InputError:
    return InputError(f"no solid is called {pattern!r}", where, f"the file has: {', '.join(names)}")


def _material(
    name: str, materials: Mapping[str, str], beside: Path, usual_materials: Callable[[], Mapping[str, str]]
) -> str:
    """Material of a solid: the table's entry of that name, its first pattern that fits, or the library's habit."""
    fitting = (m for pattern, m in materials.items() if fnmatchcase(name, pattern))
    word = materials[name] if name in materials else next(fitting, None)
    if word is not None:
        return material(word).name
    if name not in usual_materials():
        right = f'write [materials] "{name}" = "steel"'
        raise InputError(f"no material for the solid {name!r}", str(beside), right)
    return usual_materials()[name]
