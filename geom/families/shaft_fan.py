"""An axial fan in a cowl on the left end of a machine, its wheel on the shaft; meshed where the file asks for it."""

import math

from geom.description import shapes
from geom.description.geometry import Group
from geom.description.parameters import Length, Measure
from geom.description.part import Part
from geom.description.roles import Role
from geom.families.fit import Fit, mm

_BLADE = 0.35  # of the pitch, as seen along the axis
_FREE = 0.02  # of the cowl's radius: blade tip to cowl
WHEEL = (0.2, 0.8)  # of the cowl's depth, from its open end: where the wheel begins and ends


def fan_measures(shield: str, radius: Length, shaft: Length) -> tuple[Measure, Measure]:
    """What the cowl is measured in, from the bearing's seat to the shield of that radius, and what the hub is."""
    cowl = Measure(
        f"the way from the bearing's diameter to the {shield}'s",
        lambda g: 2 * (radius(g) - g.fan.cowl) - 1.02 * g.bearing.outer_diameter,
        lambda g: 1.02 * g.bearing.outer_diameter,
    )
    hub = Measure(
        "the way from the shaft's diameter to 0.9 of the cowl's",
        lambda g: 0.9 * g.fan.diameter - 1.05 * shaft(g),
        lambda g: 1.05 * shaft(g),
    )
    return cowl, hub


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


def check_fan(fit: Fit, shaft: float, shield: float) -> None:
    """The cowl stands on the shield around the bearing's seat, the hub between shaft and cowl; diameters (m)."""
    fan, seat = fit.geometry.fan, 1.02 * fit.geometry.bearing.outer_diameter
    if not fan.depth:
        return
    fit.above(seat, "fan.diameter", ", to stand on the flange")
    fit.below(shield - 2 * fan.cowl, "fan.diameter", ", the flange")
    low, high = 1.05 * shaft, 0.9 * fan.diameter
    fit.need(low < fan.hub_diameter < high, "fan.hub_diameter", f"from {low * mm:.4g} to {high * mm:.4g} mm")
