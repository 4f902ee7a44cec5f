"""The hand formula beside the field's value, for every link that has a closed form.

Films: 1 / (h A), A exact from the prismatic description. Contacts: 1 / (g A), and from mean to mean of both parts with
the legs of a plain hollow cylinder (Mellor, Roberts, Turner 1991) or half a thin wall on either side. The field's value
of that is its difference of means over the heat that passes: equal to the legs where neither part is heated itself.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from fem.matrices.assembly import FieldModel
from geom import Machine
from geom.description.part import Prism
from geom.description.profile import Loop
from geom.meshing.areas import PartRow, part_table
from geom.table import TableRow
from lumped.build.crosscheck import CrossCheck
from lumped.correlations.windings import mellor
from lumped.machine.path import stem

SEGMENTS = 96  # chords per turn: 0.07 % of a disc
WHOLE = 0.9  # a face that touches over less than this share of itself has no closed form
THIN = 2e-3  # m, a layer up to this thickness is a wall
LEAST = 0.01  # of all heat: below it a difference over a heat means nothing


@dataclass(frozen=True)
class AnalyticalCheck(TableRow):
    """Resistances (K/W) of one link: by the textbook, from the field, and their ratio textbook over field."""

    properties = ("ratio",)

    link: str
    formula: str
    textbook_K_W: float
    field_K_W: float

    @property
    def ratio(self) -> float:
        return self.textbook_K_W / self.field_K_W


def analytical_checks(machine: Machine, field: FieldModel, check: CrossCheck) -> list[AnalyticalCheck]:
    """All links that have a closed form, at the point of a cross-check."""
    rows = {row.name: row for row in part_table(machine, SEGMENTS)}
    films, contacts = check.at.films, check.at.contacts
    return [*_films(rows, field, films), *_contacts(rows, field, contacts), *_means(machine, rows, field, check)]


def _films(rows: Mapping[str, PartRow], field: FieldModel, films: Mapping[str, float]) -> Iterator[AnalyticalCheck]:
    cells: dict[str, list[str]] = {}
    for cell in field.films:
        cells.setdefault(stem(cell), []).append(cell)
    for face, face_cells in cells.items():
        exact = rows[field.films[face_cells[0]].trace.part].faces.get(face, 0.0)
        areas = np.array([field.films[cell].trace.area for cell in face_cells])
        G = float(areas @ [films.get(cell, 0.0) for cell in face_cells])
        if G > 0 and exact > 0:
            yield AnalyticalCheck(f"film:{face}", "1/(h A)", areas.sum() / (G * exact), 1 / G)


def _contacts(
    rows: Mapping[str, PartRow], field: FieldModel, contacts: Mapping[str, float]
) -> Iterator[AnalyticalCheck]:
    for name, touch in field.contacts.items():
        a, b = name.split("|")
        exact = rows[a].contacts[b]
        yield AnalyticalCheck(
            f"contact:{name}", "1/(g A)", 1 / (contacts[name] * exact), 1 / (contacts[name] * touch.area)
        )


def _means(
    machine: Machine, rows: Mapping[str, PartRow], field: FieldModel, check: CrossCheck
) -> Iterator[AnalyticalCheck]:
    mean = {part.place: part.fem_mean_C for part in check.parts}
    for link in check.links:
        kind, name = link.link.split(":", 1)
        if kind != "contact" or abs(link.fem_W) < LEAST * check.heat:
            continue
        a, b = link.parts
        one, two = (leg(machine, rows, field, *pair, name) for pair in ((a, b), (b, a)))
        if one is not None and two is not None:
            series = one[0] + 1 / (check.at.contacts[name] * field.contacts[name].area) + two[0]
            yield AnalyticalCheck(
                f"{a} to {b}", f"{one[1]} + 1/(g A) + {two[1]}", series, (mean[a] - mean[b]) / link.fem_W
            )


def leg(
    machine: Machine, rows: Mapping[str, PartRow], field: FieldModel, part: str, other: str, contact: str
) -> tuple[float, str] | None:
    """Resistance (K/W) from a part's mean to its face towards another, and by which formula; None: no closed form."""
    k_plane, k_axial = machine.conductivity(part)
    area, prisms = rows[part].contacts[other], machine.part(part).prisms
    if len(prisms) == 1 and all(_round(loop) for loop in prisms[0][0].loops):
        return _cylinder(prisms[0], k_plane, k_axial, area, field, contact)
    thickness = 2 * rows[part].volume / max(rows[part].contact_area + rows[part].film_area, 1e-12)
    if thickness < THIN:
        return thickness / (2 * k_plane * area), "thin wall"
    return None


def _round(loop: Loop) -> bool:
    radii = [float(np.hypot(x, y)) for x, y, _ in loop]
    return max(radii) - min(radii) < 1e-9 and all(abs(bulge) > 0 for _, _, bulge in loop)


def _cylinder(
    prism: Prism, k_plane: float, k_axial: float, area: float, field: FieldModel, contact: str
) -> tuple[float, str] | None:
    profile, z0, z1 = prism
    outer = float(np.hypot(*profile.outer[0][:2]))
    inner = float(np.hypot(*profile.holes[0][0][:2])) if profile.holes else 1e-6 * outer
    # Mean distance of a contact from the axis (m).
    trace = field.contacts[contact].a
    x = field.xyz[trace.dofs]
    length, at = z1 - z0, float(trace.b @ np.hypot(x[:, 0], x[:, 1]) / trace.area)
    circuit = mellor(outer, inner, length, k_plane, k_axial)
    for name, where, whole, value in (
        ("cylinder, outside", outer, 2 * np.pi * outer * length, circuit.outer),
        ("cylinder, inside", inner, 2 * np.pi * inner * length, circuit.inner),
    ):
        if abs(at - where) < 0.02 * outer:
            return (value, name) if area > WHOLE * whole else None
    return (circuit.end, "cylinder, end") if area > WHOLE * np.pi * (outer**2 - inner**2) else None
