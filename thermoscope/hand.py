"""The hand formula beside the field's value, for every link that has a closed form.

Films: 1 / (h A), A exact from the prismatic description. Contacts: 1 / (g A), and from mean to mean of both parts with
the legs of a plain hollow cylinder (Mellor, Roberts, Turner 1991) or of a thin wall in between. The field's value of
that is the link of the network of means alone, G = inv(mean of K^-1 load): exact, with negative links where three parts
meet. A series of legs ignores those, which is what a ratio far from 1 then says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fem.assembly import FieldModel
from geom import Machine
from geom.areas import PartRow, part_table
from lumped.correlations.windings import mellor
from lumped.linear import linear
from lumped.network import Array, Network

SEGMENTS = 96  # chords per turn: 0.07 % of a disc
WHOLE = 0.9  # a face that touches over less than this share of itself has no closed form
THIN = 0.1  # a wall is thin when its thickness is below this share of the root of its area


@dataclass(frozen=True)
class HandRow:
    """Resistances (K/W) of one link: by the textbook, from the field, and their ratio textbook over field."""

    link: str
    formula: str
    textbook_K_W: float
    field_K_W: float

    @property
    def ratio(self) -> float:
        return self.textbook_K_W / self.field_K_W

    def document(self) -> dict[str, Any]:
        return {**vars(self), "ratio": self.ratio}


def hand_rows(
    machine: Machine, field: FieldModel, network: Network, films: Mapping[str, float], contacts: Mapping[str, float]
) -> list[HandRow]:
    """All links that have a closed form, at film and contact coefficients h and g (W/m2/K)."""
    rows = {row.name: row for row in part_table(machine, SEGMENTS)}
    means = _means(machine, rows, field, network, films, contacts)
    return [*_films(rows, field, films), *_contacts(rows, field, contacts), *means]


def _films(rows: Mapping[str, PartRow], field: FieldModel, films: Mapping[str, float]) -> Iterator[HandRow]:
    for face, film in field.films.items():
        area = rows[film.trace.part].faces.get(face, 0.0)
        if films.get(face, 0.0) > 0 and area > 0:
            yield HandRow(f"film:{face}", "1/(h A)", 1 / (films[face] * area), 1 / (films[face] * film.trace.area))


def _contacts(rows: Mapping[str, PartRow], field: FieldModel, contacts: Mapping[str, float]) -> Iterator[HandRow]:
    for name, touch in field.contacts.items():
        a, b = name.split("|")
        exact = rows[a].contacts[b]
        yield HandRow(f"contact:{name}", "1/(g A)", 1 / (contacts[name] * exact), 1 / (contacts[name] * touch.area))


def _means(
    machine: Machine, rows: Mapping[str, PartRow], field: FieldModel, network: Network, films: Mapping[str, float],
    contacts: Mapping[str, float],
) -> Iterator[HandRow]:  # fmt: skip
    G = of_means(network, films, contacts)
    names = list(field.blocks)
    for name, touch in field.contacts.items():
        a, b = name.split("|")
        legs = [leg(machine, rows, field, part, other, name) for part, other in ((a, b), (b, a))]
        link = -G[names.index(a), names.index(b)]
        if None not in legs and link > 0:
            (one, how), (two, thus) = legs  # type: ignore[misc]
            series = one + 1 / (contacts[name] * touch.area) + two
            yield HandRow(f"{a} to {b}", f"{how} + 1/(g A) + {thus}", series, 1 / float(link))


def of_means(network: Network, films: Mapping[str, float], contacts: Mapping[str, float]) -> Array:
    """(n_part, n_part) W/K between the parts' means, fluids held, in the order of the recovery."""
    system = linear(network, films, contacts)
    means = [i for i, state in enumerate(system.solid) if "#" not in network.states[state]]
    return np.asarray(np.linalg.inv(np.linalg.inv(system.A)[np.ix_(means, means)]))


def leg(
    machine: Machine, rows: Mapping[str, PartRow], field: FieldModel, part: str, other: str, contact: str
) -> tuple[float, str] | None:
    """Resistance (K/W) from a part's mean to its face towards another, and by which formula; None: no closed form."""
    k_plane, k_axial = machine.conductivity(part)
    area, prisms = rows[part].contacts[other], machine.part(part).prisms
    if len(prisms) == 1 and all(_round(loop) for loop in prisms[0][0].loops):
        return _cylinder(prisms[0], k_plane, k_axial, area, field, contact)
    thickness = 2 * rows[part].volume / max(rows[part].contact_area + rows[part].film_area, 1e-12)
    if rows[part].contact_area > 0 and thickness < THIN * np.sqrt(area):
        return thickness / (2 * k_plane * area), "thin wall"
    return None


def _round(loop: Any) -> bool:
    radii = [float(np.hypot(x, y)) for x, y, _ in loop]
    return max(radii) - min(radii) < 1e-9 and all(abs(bulge) > 0 for _, _, bulge in loop)


def _cylinder(
    prism: Any, k_plane: float, k_axial: float, area: float, field: FieldModel, contact: str
) -> tuple[float, str] | None:
    profile, z0, z1 = prism
    outer = float(np.hypot(*profile.outer[0][:2]))
    inner = float(np.hypot(*profile.holes[0][0][:2])) if profile.holes else 1e-6 * outer
    length, at = z1 - z0, _radius_of(field, contact)
    circuit = mellor(outer, inner, length, k_plane, k_axial)
    for name, where, whole, value in (
        ("cylinder, outside", outer, 2 * np.pi * outer * length, circuit.outer),
        ("cylinder, inside", inner, 2 * np.pi * inner * length, circuit.inner),
    ):
        if abs(at - where) < 0.02 * outer and area > WHOLE * whole:
            return value, name
    return (circuit.end, "cylinder, end") if area > WHOLE * np.pi * (outer**2 - inner**2) else None


def _radius_of(field: FieldModel, contact: str) -> float:
    """Mean distance of a contact from the axis (m)."""
    trace = field.contacts[contact].a
    x = field.xyz[trace.dofs]
    return float(trace.b @ np.hypot(x[:, 0], x[:, 1]) / trace.area)
