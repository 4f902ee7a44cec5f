"""Machine files: the library, the families, and from a file's tables, or a STEP file, to a machine."""

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

from geom.description.bases import based
from geom.description.machine import ENVELOPE, SECTIONS, Machine, check_ratings
from geom.description.materials import read_entry
from geom.description.names import checked_name
from geom.description.outlines import read_outlines
from geom.description.parameters import is_number
from geom.description.part import Part
from geom.description.reading import read_geometry
from geom.description.toml_file import read_toml
from geom.errors import InputError
from geom.families import radial_flux, series_dc
from geom.families.cross_section import CROSS_SECTION
from geom.families.family import Family
from geom.families.proportions import remedy
from geom.importing.assumptions import USUAL_TEMPLATE
from geom.importing.draft import Draft
from geom.importing.dxf import read_section
from geom.importing.motor_cad import read_motor_cad
from geom.importing.pyleecan import read_pyleecan
from geom.limits import MACHINE_BYTES
from geom.plugins import plugins
from geom.solids.step import machine_in_step
from geom.solids.step_prisms import LARGEST_MM

LIBRARY = Path(__file__).parent / "machines"
_HEADER = ("name", "family", "description", "source", "assumed", "like", "without")

DRAWING = ".dxf"
IMPORTERS: dict[str, Callable[..., Draft]] = {".json": read_pyleecan, ".mot": read_motor_cad, DRAWING: read_section}


def import_draft(
    path: Path, family_template: str = USUAL_TEMPLATE, stack_mm: float | None = None, units: str = ""
) -> Draft:
    """The machine file in the making. Raises InputError for files of other kinds, and for what is wrong in them.

    stack_mm, units : what a drawing may not know: length of the stack, unit of its coordinates
    """
    suffix = path.suffix.lower()
    if suffix not in IMPORTERS:
        right = f"one of: {', '.join(IMPORTERS)}; a loss map with --machine MACHINE"
        raise InputError(f"{path.suffix or 'no ending'} is not a machine file of another program", str(path), right)
    if suffix == DRAWING:
        return read_section(path, family_template, stack_mm, units)
    if stack_mm is not None or units:
        raise InputError("--stack-mm and --units are for drawings", str(path), "without them: the file knows both")
    return IMPORTERS[suffix](path, family_template)


def is_foreign_machine(path: Path) -> bool:
    """Is it a machine file of another program?  JSON is one of pyleecan where it names a class; else a recording."""
    suffix = path.suffix.lower()
    if suffix != ".json":
        return suffix in IMPORTERS
    with path.open("rb") as file:  # a recording may be a hundred times as large
        return b'"__class__"' in file.read(MACHINE_BYTES.most)


def library() -> dict[str, Path]:
    """The machines that come with the tool, by name."""
    return {path.stem: path for path in sorted(LIBRARY.glob("*.toml"))}


def families() -> dict[str, Family]:
    """All families by name, those of other packages too (entry points "thermoscope.families")."""
    builtin = (series_dc.FAMILY, radial_flux.PMSM, radial_flux.TEFC, CROSS_SECTION)
    return {family.name: family for family in (*builtin, *plugins("families").values())}


def load_machine(source: str | Path) -> Machine:
    """The machine described by a file, one of the library by name, or the one in a STEP file (see geom.solids.step).

    Raises InputError for a missing file, broken TOML, unknown sections or keys, missing units, values out
    of range, and geometry that does not fit.
    """
    path = library().get(str(source), Path(source))
    if path.suffix.lower() in (".step", ".stp"):
        return import_step(path)
    if path.suffix.lower() in IMPORTERS:
        return machine_from(import_draft(path).sections(), str(path))
    if path.suffix != ".toml" or not path.is_file():
        right = f"a .toml, .step{', '.join(['', *IMPORTERS])} file, or one of: {', '.join(library())}"
        raise InputError(f"no machine {str(source)!r}", "", right)
    return machine_from(read_toml(path, "a machine file with [machine] and [geometry]"), str(path))


def import_step(path: str | Path) -> Machine:
    """The machine in a STEP file and the TOML file beside it, see geom.solids.step."""
    return machine_in_step(Path(path), _usual_materials)


@cache
def _usual_materials() -> Mapping[str, str]:
    """Part name -> material, where all families agree on it."""
    default = [family.build(read_geometry(family.parameters, {}, name)) for name, family in families().items()]
    parts = [part for built in default for part in built if part.solid]
    return {a.name: a.material for a in parts if all(b.material == a.material for b in parts if b.name == a.name)}


def machine_from(sections: Mapping[str, Any], where: str = "machine") -> Machine:
    """The machine described by the tables of a machine file; `where` names it in errors."""
    sections = completed(sections, where)
    for section, table in sections.items():
        if section not in SECTIONS:
            raise InputError(f"unknown section [{section}]", where, f"known: {', '.join(SECTIONS)}")
        if not isinstance(table, Mapping):
            raise InputError(f"{section!r} is not a section", where, f"write [{section}]")
    check_ratings(sections, where)
    header = sections.get("machine", {})
    family = _family(header, where)
    table = sections.get("geometry", {})
    values = read_geometry(family.parameters, table, where)
    if family.outlines or "outlines" in sections:
        values.outlines = read_outlines(family.outlines, sections.get("outlines", {}), where)
    try:
        built = family.build(values)
    except InputError as error:
        cure = "" if sections.get("outlines") else remedy(family, table, error)
        right = "; ".join(words for words in (error.right, cure) if words)
        raise InputError(error.what, f"{where} {error.where}", right) from error
    built = _with_materials(built, sections.get("materials", {}), where)
    machine = Machine(
        name=checked_name(header.get("name", Path(where).stem), f"{where} [machine] name"),
        family=family.name,
        description=header.get("description", family.doc),
        parts=tuple(part for part in built if part.solid),
        fluids=tuple(part for part in built if not part.solid),
        sections={name: table for name, table in sections.items() if name not in ("machine", "geometry", "outlines")},
        geometry=values,
        face_names=family.face_names,
        source=header.get("source", ""),
        assumed=header.get("assumed", ""),
        ports=family.ports(values),
        features=family.features(values),
    )
    _refuse_outside_envelope(machine, where)
    return based(machine, load_machine, where)


def completed(sections: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    """The tables of a machine file that says only what differs from a machine of the library, in full.

    [machine] like = NAME is that machine; without = ["films.outer", ...] are keys of its file that are left out.
    """
    header = sections.get("machine")
    if not isinstance(header, Mapping) or not {"like", "without"} & set(header):
        return sections
    place, name, without = f"{where} [machine]", header.get("like"), header.get("without", [])
    if not isinstance(name, str) or name not in library():
        raise InputError(f"like = {str(name)[:60]!r} is not a machine that comes along", place, ", ".join(library()))
    original = completed(read_toml(library()[name], "a machine file"), name)
    new_header = {key: value for key, value in header.items() if key not in ("like", "without")}
    tables = _without(original, ["machine", "name"])
    for key in without if isinstance(without, list) else [without]:
        try:
            # The words of a key with dots, as TOML reads it: 'contacts."base|foot"' has contacts and base|foot.
            words, inner = [], tomllib.loads(f"{key} = 0")
            while isinstance(inner, dict):
                ((word, inner),) = inner.items()
                words.append(word)
            tables = _without(tables, words)
        except ValueError:
            what, right = f"without: {name} has no {str(key)[:60]!r}", """such as ["fans", 'contacts."base|foot"']"""
            raise InputError(what, place, right) from None
    return _overlaid(tables, {**sections, "machine": new_header})


def _without(table: Mapping[str, Any], words: Sequence[str]) -> dict[str, Any]:
    """Tables without a key of theirs, given by its words. ValueError where they have none."""
    first, *rest = words
    if not isinstance(table, Mapping) or first not in table:
        raise ValueError(first)
    left = {key: value for key, value in table.items() if key != first}
    return {**table, first: _without(table[first], rest)} if rest else left


def _overlaid(table: Mapping[str, Any], above: Mapping[str, Any]) -> dict[str, Any]:
    """Tables with the values of other tables in place of theirs."""
    both = {key: value for key, value in above.items() if isinstance(value, Mapping) and key in table}
    inner = {k: _overlaid(table[k], value) for k, value in both.items() if isinstance(table[k], Mapping)}
    return {**table, **above, **inner}


def _refuse_outside_envelope(machine: Machine, where: str) -> None:
    """[ratings] envelope_mm = [length, width, height], where given, holds the whole machine."""
    envelope = machine.sections.get("ratings", {}).get(ENVELOPE)
    if envelope is None:
        return
    place = f"{where} [ratings] envelope_mm"
    sizes = envelope if isinstance(envelope, list) else []
    if len(sizes) != 3 or not all(is_number(size) and 0.0 < size <= LARGEST_MM for size in sizes):
        raise InputError(f"{envelope!r} is not an envelope", place, "write [length, width, height]")
    for word, size, limit in zip(("length", "width", "height"), machine.extent, sizes):
        if size * 1e3 > limit + 1e-6:
            raise InputError(
                f"the machine's {word} of {size * 1e3:.4g} mm exceeds {limit:.4g} mm", place, "make it fit"
            )


def _family(header: Mapping[str, Any], where: str) -> Family:
    for key in header:
        if key not in _HEADER:
            raise InputError(f"unknown key {key!r}", f"{where} [machine]", f"known: {', '.join(_HEADER)}")
    for key, value in header.items():
        if not isinstance(value, str):
            raise InputError(f"{key} = {str(value)[:60]} is not text", f"{where} [machine]", "words in quotes")
    available = families()
    if header.get("family") not in available:
        where = f"{where} [machine] family"
        raise InputError(f"{header.get('family')!r} is not a family", where, f"known: {', '.join(available)}")
    return available[header["family"]]


def _with_materials(parts: tuple[Part, ...], materials: Mapping[str, Any], where: str) -> tuple[Part, ...]:
    names = [part.name for part in parts if part.solid]
    for part in materials:
        if part not in names:
            raise InputError(f"unknown part {part!r}", f"{where} [materials]", f"known: {', '.join(names)}")

    def with_material(part: Part) -> Part:
        name, properties = read_entry(materials[part.name], part.material, f"{where} [materials] {part.name}")
        return replace(part, material=name, properties=properties)

    return tuple(with_material(part) if part.name in materials else part for part in parts)
