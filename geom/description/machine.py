"""A machine: its parts, its fluids, its materials, and the sections others read."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geom.description.geometry import NO_FEATURES, Features, Geometry
from geom.description.materials import Material, filled, material, with_properties
from geom.description.parameters import is_number
from geom.description.part import Part, Port
from geom.errors import InputError

SECTIONS: tuple[str, ...] = ("machine", "ratings", "geometry", "outlines", "materials", "contacts", "films", "losses")
SECTIONS += ("fans", "cooling", "spray", "sensors", "calibration", "bases")
LARGEST_RATING = 1e9  # in the unit of its key, as of all that a recording may hold
ENVELOPE = "envelope_mm"


def check_ratings(sections: Mapping[str, Any], where: str) -> None:
    """InputError where [ratings] holds anything but numbers and an envelope."""
    for key, value in sections.get("ratings", {}).items():
        fits = is_number(value) and 0.0 <= value <= LARGEST_RATING
        if key != ENVELOPE and not fits:
            right = f"a number from 0 to {LARGEST_RATING:g}"
            raise InputError(f"{key} = {str(value)[:40]!r} is not possible", f"{where} [ratings]", right)


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
    geometry: Geometry | None
    face_names: Mapping[tuple[str, str], str]
    source: str = ""
    assumed: str = ""
    ports: tuple[Port, ...] = ()
    features: Features = NO_FEATURES

    @property
    def dimensions(self) -> Geometry:
        """The family's parameters; InputError for an imported machine, which has none."""
        if self.geometry is None:
            raise InputError("was imported: it has no parameters of a family", self.name, "a machine of a family")
        return self.geometry

    def part(self, name: str) -> Part:
        """The solid or fluid of this name; InputError if there is none."""
        parts = {part.name: part for part in (*self.parts, *self.fluids)}
        if name not in parts:
            raise InputError(f"unknown part {name!r}", self.name, f"known: {', '.join(parts)}")
        return parts[name]

    def material_of(self, name: str) -> Material:
        """What the part is made of, [materials] overrides and the winding's fill and impregnation included."""
        part = self.part(name)
        usual = material(part.material) if part.filling is None else filled(part.material, *part.filling)
        return with_properties(usual, part.properties)

    def conductivity(self, name: str) -> tuple[float, float]:
        """Conductivity of the part across and along the axis (W/m/K)."""
        material = self.material_of(name)
        return material.k_plane, material.k_axial

    def face_name(self, part: str, fluid: str) -> str:
        """Name of the face where a part meets a fluid, e.g. "flange.right.outer"."""
        usual = {"ambient": f"{part}.outer", "airgap": f"{part}.gap"}.get(fluid, f"{part}.{fluid}")
        return self.face_names.get((part, fluid), usual)

    @property
    def extent(self) -> tuple[float, float, float]:
        """Overall size (m): along the axis, across it, and high."""
        x0, y0, x1, y1 = zip(*(profile.bounds for part in self.parts for profile, _, _ in part.prisms))
        spans = [part.span for part in self.parts]
        return max(z1 for _, z1 in spans) - min(z0 for z0, _ in spans), max(x1) - min(x0), max(y1) - min(y0)


def step_sidecar(path: Path | str) -> Path:
    """Where materials and other sections of a machine in a STEP file stand."""
    return Path(f"{path}.toml")
