"""A machine with several bases to stand on, of which a test uses one or none.

[bases]
bench = "own"                 # foot and base of this file
plate = "pmsm-m1-plate"       # those of another machine file or of the library, with the same body

The other base's parts are called "foot.plate" and "base.plate" and sit on the far side of the machine, away from the
own one; conduction knows no gravity. Its materials, contacts and films are those of its own file.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from geom.description.geometry import Geometry
from geom.description.machine import Machine
from geom.description.part import Part
from geom.errors import InputError

THIS_MACHINE = "own"
PIECES = ("foot", "base")


def based(machine: Machine, load: Callable[[str], Machine], where: str) -> Machine:
    """The machine with the bases that its section [bases] names; itself if there is none."""
    table = machine.sections.get("bases", {})
    others = {name: other for name, other in table.items() if other != THIS_MACHINE}
    place, have = f"{where} [bases]", [part.name for part in machine.parts]
    if table and (len(others) > 1 or len(table) - len(others) != 1 or "base" not in have):
        raise InputError(
            f"{dict(table)!r} is not possible", place, f"one base {THIS_MACHINE!r} of this file and one other machine"
        )
    for name, other in others.items():
        machine = _with_base(machine, name, load(str(other)), place)
    return machine


def _with_base(machine: Machine, name: str, other: Machine, where: str) -> Machine:
    if _body(machine.dimensions) != _body(other.dimensions) or "base" not in [part.name for part in other.parts]:
        raise InputError(f"{other.name} is another machine", where, "one that differs in [geometry.base] alone")
    renamed = {piece: f"{piece}.{name}" for piece in PIECES}
    more = tuple(_turned(other.part(piece), renamed[piece]) for piece in PIECES)
    sections = {**machine.sections}
    out = {}
    for key, value in other.sections.get("contacts", {}).items():
        ends = [renamed.get(end, end) for end in key.split("|")]
        if ends != key.split("|"):
            out["|".join(sorted(ends))] = value
    sections["contacts"] = {**out, **sections.get("contacts", {})}
    films, theirs = sections.get("films", {}), other.sections.get("films", {}).get("outer", {})
    outer = {renamed[piece]: theirs[piece] for piece in PIECES if piece in theirs}
    mine = films.get("outer", {})
    if not isinstance(mine, Mapping):
        raise InputError(f"outer = {str(mine)[:60]} is not a table", f"{machine.name} [films]", "PART = W/m2/K pairs")
    sections["films"] = {**films, "outer": {**mine, **outer}}
    return replace(machine, parts=(*machine.parts, *more), sections=sections)


def _body(geometry: Geometry) -> dict[str, Any]:
    """All of the geometry but the base."""
    return {name: group for name, group in vars(geometry).items() if name != "base"}


def _turned(part: Part, name: str) -> Part:
    """Half a turn about the axis."""
    return replace(part, name=name, prisms=tuple((p.rotated(math.pi), z0, z1) for p, z0, z1 in part.prisms))
