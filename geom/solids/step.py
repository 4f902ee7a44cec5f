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

from collections.abc import Callable, Iterable, Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

from geom.description.machine import SECTIONS, Machine, check_ratings, step_sidecar
from geom.description.materials import Properties, read_entry
from geom.description.names import checked_name
from geom.description.part import Part
from geom.description.roles import Identity, Role
from geom.description.toml_file import read_toml
from geom.errors import InputError
from geom.solids.step_prisms import no_solid, step_prisms

INSIDE = "air.inside"
NOTHING = Identity()
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
    prisms = step_prisms(path, sidecar.get("import", {}))
    fluids = sidecar.get("fluids", {})
    for pattern in {**sidecar.get("materials", {}), **fluids, **sidecar.get("roles", {})}:
        if not any(fnmatchcase(name, pattern) for name in prisms):
            raise no_solid(pattern, prisms, str(beside))
    what = _declared_roles(sidecar.get("roles", {}), prisms, f"{beside} [roles]")
    materials = sidecar.get("materials", {})
    parts = tuple(
        Part(name, kind, prisms[name], role=is_.role, turns=is_.turns, properties=properties)
        for name in prisms
        if name not in fluids
        for is_ in [what.get(name, NOTHING)]
        for kind, properties in [_material(name, materials, beside, usual_materials)]
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
        raise InputError(f"{entry!r} is not a role", where, right)
    turns = table.get("turns")
    return Identity(Role(table["role"]) if "role" in table else None, None if turns is None else bool(turns))


def _read_sidecar(path: Path) -> dict[str, Any]:
    if not path.is_file():
        return {}
    sidecar = read_toml(path, "what a STEP file does not say: [materials], [fluids], [losses.NAME] ...")
    others = (section for section in SECTIONS if section not in ("geometry", "outlines"))
    sections = ("import", "fluids", "roles", *others)
    for section, table in sidecar.items():
        if section not in sections or not isinstance(table, Mapping):
            raise InputError(f"unknown section [{section}]", str(path), f"known: {', '.join(sections)}")
        for key in table:
            if key not in _KEYS.get(section, (key,)):
                raise InputError(f"unknown key {key!r}", f"{path} [{section}]", f"known: {', '.join(_KEYS[section])}")
    check_ratings(sidecar, str(path))
    return sidecar


def _material(
    name: str, materials: Mapping[str, Any], beside: Path, usual_materials: Callable[[], Mapping[str, str]]
) -> tuple[str, Properties]:
    """Material of a solid: the table's entry of that name, its first pattern that fits, or the library's habit."""
    fitting = (m for pattern, m in materials.items() if fnmatchcase(name, pattern))
    word = materials[name] if name in materials else next(fitting, {})
    usual = "" if not isinstance(word, Mapping) or word.get("like") else usual_materials().get(name)
    if usual is None:
        right = f'write [materials] "{name}" = "steel"'
        raise InputError(f"no material for the solid {name!r}", str(beside), right)
    return read_entry(word, usual, f"{beside} [materials] {name}")
