"""An axial fan in a cowl on the left end of a machine, its wheel on the shaft; meshed where the file asks for it."""

from __future__ import annotations

import math

from geom.description import shapes
from geom.description.geometry import Group
from geom.description.part import Part
from geom.description.roles import Role

Rule = tuple[bool, str, float, str]  # holds, key, value as in the file, what would be right
_BLADE = 0.35  # of the pitch, as seen along the axis
_FREE = 0.02  # of the cowl's radius: blade tip to cowl
WHEEL = (0.2, 0.8)  # of the cowl's depth, from its open end: where the wheel begins and ends
mm = 1e3


def shaft_fan(fan: Group, shaft: float, z0: float, z1: float) -> tuple[Part, ...]:
    """Cowl from z0 to the end shield at z1, and the wheel on a shaft of that radius (m); nothing without a fan."""
    if not fan.depth:
        return ()
    hub, inside = fan.hub_diameter / 2, fan.diameter / 2
    half = _BLADE * math.pi / fan.blades
    blades = [shapes.sector(hub, inside * (1 - _FREE), a - half, a + half) for a in shapes.evenly(fan.blades)]
    begin, end = (z0 + share * fan.depth for share in WHEEL)
    return (
        Part("fan.cowl", "steel", ((shapes.ring(inside, inside + fan.cowl), z0, z1),), role=Role.HOUSING),
        Part(
            "fan.wheel",
            "polyamide-gf30",
            tuple((shape, begin, end) for shape in (shapes.ring(shaft, hub), *blades)),
            role=Role.FAN,
        ),
    )


def fan_rules(fan: Group, shaft: float, seat: float, shield: float) -> tuple[Rule, ...]:
    """The cowl stands on the shield around the bearing's seat, the hub between shaft and cowl; diameters (m)."""
    if not fan.depth:
        return ()
    return (
        (fan.diameter > 1.02 * seat, "fan.diameter_mm", fan.diameter * mm,
         f"more than {1.02 * seat * mm:.4g} mm, to stand on the flange"),
        (fan.diameter + 2 * fan.cowl < shield, "fan.diameter_mm", fan.diameter * mm,
         f"less than {(shield - 2 * fan.cowl) * mm:.4g} mm, the flange"),
        (1.05 * shaft < fan.hub_diameter < 0.9 * fan.diameter, "fan.hub_diameter_mm",
         fan.hub_diameter * mm,
         f"from {1.05 * shaft * mm:.4g} to {0.9 * fan.diameter * mm:.4g} mm"),
    )  # fmt: skip
