"""A machine: its parts, its fluids, its materials, and the sections others read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from geom.bases import based
from geom.errors import InputError
from geom.families import Family, families
from geom.materials import Material, filled, material
from geom.names import checked_name
from geom.part import Part, Port
from geom.profile import ArcGrid
from geom.reading import read_geometry
from geom.toml_file import read_toml

LIBRARY = Path(__file__).parent / "machines"
SECTIONS = (
    "machine", "ratings", "geometry", "materials", "contacts", "films", "losses", "fans", "cooling", "sensors",
    "calibration", "bases",
)  # fmt: skip
_HEADER = ("name", "family", "description", "source", "assumed")


@dataclass(frozen=True)
class Machine:
    """Named prismatic parts and fluids, and what the file says beyond geometry.

    parts : solids; fluids : declared fluid spaces ("ambient" is everything else)
    sections : raw tables of the file, e.g. sections["ratings"]
    geometry : the family's parameters in SI, as groups (machine.geometry.rotor.stack_length); None if imported
    ports : inlets and outlets of liquid jackets, by name
    source : where its numbers were published; assumed : which of them are assumed
    """

    name: str
    family: str
    description: str
    parts: tuple[Part, ...]
    fluids: tuple[Part, ...]
    sections: Mapping[str, Any]
    geometry: Any
    face_names: Mapping[tuple[str, str], str]
    source: str = ""
    assumed: str = ""
    ports: tuple[Port, ...] = ()

    def part(self, name: str) -> Part:
        """The solid or fluid of this name; InputError if there is none."""
        known = {part.name: part for part in (*self.parts, *self.fluids)}
        if name not in known:
            raise InputError(f"unknown part {name!r}", self.name, f"known: {', '.join(known)}")
        return known[name]

    def material_of(self, name: str) -> Material:
        """What the part is made of, [materials] overrides and the winding's fill and impregnation included."""
        part = self.part(name)
        return material(part.material) if part.filling is None else filled(part.material, *part.filling)

    def conductivity(self, name: str) -> tuple[float, float]:
        """Conductivity of the part across and along the axis (W/m/K)."""
        found = self.material_of(name)
        return found.k_plane, found.k_axial

    def face_name(self, part: str, fluid: str) -> str:
        """Name of the face where a part meets a fluid, e.g. "flange.right.outer"."""
        usual = {"ambient": f"{part}.outer", "airgap": f"{part}.gap"}.get(fluid, f"{part}.{fluid}")
        return self.face_names.get((part, fluid), usual)

    @property
    def extent(self) -> tuple[float, float, float]:
        """Overall size (m): along the axis, across it, and high."""
        import shapely

        profiles = [profile for part in self.parts for profile, _, _ in part.prisms]
        grid = ArcGrid(profiles, 72)
        x0, y0, x1, y1 = shapely.total_bounds([profile.to_polygon(grid) for profile in profiles])
        spans = [part.span for part in self.parts]
        return max(z1 for _, z1 in spans) - min(z0 for z0, _ in spans), float(x1 - x0), float(y1 - y0)

    def point_in(self, name: str) -> tuple[float, float, float]:
        """A point (m) well inside the part: in the plane inside its largest prism, at half its length."""
        import shapely

        prisms = self.part(name).prisms
        profile, z0, z1 = max(prisms, key=lambda prism: prism[0].area * (prism[2] - prism[1]))
        inside = shapely.maximum_inscribed_circle(profile.to_polygon(ArcGrid([profile], 72)))
        return float(inside.coords[0][0]), float(inside.coords[0][1]), (z0 + z1) / 2


def library() -> dict[str, Path]:
    """The machines that come with the tool, by name."""
    return {path.stem: path for path in sorted(LIBRARY.glob("*.toml"))}


def load_machine(source: str | Path) -> Machine:
    """The machine described by a file, one of the library by name, or the one in a STEP file (see geom.step).

    Raises InputError for a missing file, broken TOML, unknown sections or keys, missing units, values out
    of range, and geometry that does not fit.
    """
    path = library().get(str(source), Path(source))
    if path.suffix.lower() in (".step", ".stp"):
        from geom.step import import_step

        return import_step(path)
    if path.suffix != ".toml" or not path.is_file():
        raise InputError(f"no machine {str(source)!r}", "", f"a .toml or .step file, or one of: {', '.join(library())}")
    return machine_from(read_toml(path, "a machine file with [machine] and [geometry]"), path.name)


def machine_from(sections: Mapping[str, Any], where: str = "machine") -> Machine:
    """The machine described by the tables of a machine file; `where` names it in errors."""
    for section, table in sections.items():
        if section not in SECTIONS:
            raise InputError(f"unknown section [{section}]", where, f"known: {', '.join(SECTIONS)}")
        if not isinstance(table, Mapping):
            raise InputError(f"{section!r} is not a section", where, f"write [{section}]")
    header = sections.get("machine", {})
    family = _family(header, where)
    values = read_geometry(family.parameters, sections.get("geometry", {}), where)
    try:
        built = family.build(values)
    except InputError as error:
        raise InputError(error.what, f"{where} {error.where}", error.right) from error
    built = _with_materials(built, sections.get("materials", {}), where)
    machine = Machine(
        name=checked_name(header.get("name", Path(where).stem), f"{where} [machine] name"),
        family=family.name,
        description=header.get("description", family.doc),
        parts=tuple(part for part in built if part.solid),
        fluids=tuple(part for part in built if not part.solid),
        sections={name: table for name, table in sections.items() if name not in ("machine", "geometry")},
        geometry=values,
        face_names=family.face_names,
        source=header.get("source", ""),
        assumed=header.get("assumed", ""),
        ports=family.ports(values),
    )
    _refuse_outside_envelope(machine, where)
    return based(machine, load_machine, where)


def _refuse_outside_envelope(machine: Machine, where: str) -> None:
    """[ratings] envelope_mm = [length, width, height], where given, holds the whole machine."""
    allowed = machine.sections.get("ratings", {}).get("envelope_mm")
    if allowed is None:
        return
    place = f"{where} [ratings] envelope_mm"
    if not isinstance(allowed, list) or len(allowed) != 3 or not all(isinstance(v, (int, float)) for v in allowed):
        raise InputError(f"{allowed!r} is not an envelope", place, "write [length, width, height]")
    for word, size, limit in zip(("length", "width", "height"), machine.extent, allowed):
        if size * 1e3 > limit + 1e-6:
            raise InputError(
                f"the machine's {word} of {size * 1e3:.4g} mm exceeds {limit:.4g} mm", place, "make it fit"
            )


def _family(header: Mapping[str, Any], where: str) -> Family:
    for key in header:
        if key not in _HEADER:
            raise InputError(f"unknown key {key!r}", f"{where} [machine]", f"known: {', '.join(_HEADER)}")
    known = families()
    if header.get("family") not in known:
        where = f"{where} [machine] family"
        raise InputError(f"{header.get('family')!r} is no family", where, f"known: {', '.join(known)}")
    return known[header["family"]]


def _with_materials(parts: tuple[Part, ...], chosen: Mapping[str, Any], where: str) -> tuple[Part, ...]:
    names = [part.name for part in parts]
    for part, name in chosen.items():
        if part not in names:
            raise InputError(f"unknown part {part!r}", f"{where} [materials]", f"known: {', '.join(names)}")
        material(name)
    return tuple(replace(part, material=chosen.get(part.name, part.material)) for part in parts)
