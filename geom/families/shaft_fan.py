"""An axial fan in a cowl on the left end of a machine, its wheel on the shaft; meshed where the file asks for it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from geom.description import shapes
from geom.description.geometry import Group
from geom.description.parameters import Parameter, Scale
from geom.description.part import Part
from geom.description.roles import Role

P = Parameter
Rule = tuple[bool, str, float, str]  # holds, key, value as in the file, what would be right
_BLADE = 0.35  # of the pitch, as seen along the axis
_FREE = 0.02  # of the cowl's radius: blade tip to cowl
WHEEL = (0.2, 0.8)  # of the cowl's depth, from its open end: where the wheel begins and ends
mm = 1e3


def fan_parameters(
    plate: str,
    of: Mapping[str, Callable[[float, float], Scale]],
    diameter: float,
    cowl: float,
    hub: float,
    within: float,
) -> tuple[Parameter, ...]:
    """[geometry.fan] of a family whose fan stands before the left `plate`.

    diameter, cowl, hub : their usual lengths (mm);  within : largest share of what the family measures the cowl in
    of : what depth, wall, cowl and hub are measured in
    """
    return (
        P(
            "fan.depth_mm",
            0.0,
            0.0,
            500.0,
            f"cowl with a fan on the shaft, in front of the left {plate}; 0 is none",
            off=True,
            of=of["depth"](0.1, 0.5),
        ),
        P("fan.cowl_mm", cowl, 0.5, 20.0, "wall of the cowl", of=of["wall"](0.003, 0.02)),
        P("fan.diameter_mm", diameter, 20.0, 2500.0, "inside of the cowl", of=of["cowl"](0.3, within)),
        P("fan.hub_diameter_mm", hub, 6.0, 800.0, "hub of the fan on the shaft", of=of["hub"](0.05, 0.6)),
        P("fan.blades", 7, 2, 24, "blades of the fan"),
    )


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
        (
            fan.diameter > 1.02 * seat,
            "fan.diameter_mm",
            fan.diameter * mm,
            f"more than {1.02 * seat * mm:.4g} mm, to stand on the flange",
        ),
        (
            fan.diameter + 2 * fan.cowl < shield,
            "fan.diameter_mm",
            fan.diameter * mm,
            f"less than {(shield - 2 * fan.cowl) * mm:.4g} mm, the flange",
        ),
        (
            1.05 * shaft < fan.hub_diameter < 0.9 * fan.diameter,
            "fan.hub_diameter_mm",
            fan.hub_diameter * mm,
            f"from {1.05 * shaft * mm:.4g} to {0.9 * fan.diameter * mm:.4g} mm",
        ),
    )
