"""The dimensions that a drawing shows: diameters, lengths along the axis, and what is counted."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from geom.description.geometry import Geometry
from geom.description.part import Part
from geom.description.roles import Role

if TYPE_CHECKING:
    from geom.description.machine import Machine

Diameter = tuple[str, float]  # what, m
Length = tuple[str, float, float]  # what, from, to (m)


def diameters(machine: Machine) -> list[Diameter]:
    """Round things, smallest first."""
    parts = {part.name: part for part in machine.parts}
    word_of = {
        "shaft": "shaft",
        "bearing.left": "bearing",
        "rotor.core": "rotor",
        "yoke": "yoke",
        "stator.core": "laminations",
    }
    by_word = {word: 2 * _radius(parts[name]) for name, word in word_of.items() if name in parts}
    if "rotor" in by_word and (stator := getattr(machine.geometry, "stator", None)):
        by_word["bore"] = by_word["rotor"] + 2 * stator.air_gap
    return sorted(by_word.items(), key=lambda d: d[1])


def lengths(machine: Machine) -> list[Length]:
    """Along the axis, shortest first: stack, over the end windings, over the end-caps, overall."""
    words = {"stack": Role.ROTOR, "end windings": Role.WINDING, "end-caps": Role.END_SHIELD}
    spans = {word: _span([p for p in machine.parts if p.role is role]) for word, role in words.items()}
    spans["overall"] = _span(list(machine.parts))
    measures = [(word, *span) for word, span in spans.items() if span is not None]
    return sorted(measures, key=lambda length: length[2] - length[1])


def counts(machine: Machine) -> str:
    """Slots, poles, bars, fins and the air gap in words."""
    return ", ".join(_counted(machine.geometry))


def _counted(g: Geometry | None) -> Iterator[str]:
    if g is None:
        return
    for group in ("stator", "rotor", "commutator", "housing"):
        for key in ("slots", "poles", "bars", "ducts", "fins"):
            number = getattr(getattr(g, group, None), key, 0)
            if number and (key != "fins" or getattr(g.housing, "kind", "axial-fins").endswith("fins")):
                yield f"{number} {'commutator ' if group == 'commutator' else ''}{key}"
    if hasattr(g, "stator"):
        yield f"air gap {g.stator.air_gap * 1e3:g} mm"


def _radius(part: Part) -> float:
    return max(math.hypot(x, y) for profile, _, _ in part.prisms for x, y, _ in profile.outer)


def _span(parts: list[Part]) -> tuple[float, float] | None:
    if not parts:
        return None
    return min(p.span[0] for p in parts), max(p.span[1] for p in parts)
