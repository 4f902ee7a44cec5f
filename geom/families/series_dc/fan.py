"""An axial fan in a cowl on the left flange, its wheel on the shaft."""

from __future__ import annotations

import math
from typing import Any

from geom.description import shapes
from geom.description.part import Part, fluid
from geom.description.roles import Role
from geom.families.series_dc.layout import Axial

_BLADE = 0.35  # of the pitch, as seen along the axis
_FREE = 0.02  # of the cowl's radius: blade tip to cowl


def fan(g: Any, z: Axial) -> tuple[Part, ...]:
    """Cowl, wheel and the air between them; nothing without a fan."""
    if not g.fan.depth:
        return ()
    shaft, hub, inside = g.shaft.bearing_diameter / 2, g.fan.hub_diameter / 2, g.fan.diameter / 2
    half = _BLADE * math.pi / g.fan.blades
    blades = [shapes.sector(hub, inside * (1 - _FREE), a - half, a + half) for a in shapes.evenly(g.fan.blades)]
    z0, z1 = z.fan0 + 0.2 * g.fan.depth, z.fan0 + 0.8 * g.fan.depth
    return (
        Part("fan.cowl", "steel", ((shapes.ring(inside, inside + g.fan.cowl), z.fan0, z.flange0),), role=Role.HOUSING),
        Part(
            "fan.wheel",
            "polyamide-gf30",
            tuple((shape, z0, z1) for shape in (shapes.ring(shaft, hub), *blades)),
            role=Role.FAN,
        ),
        fluid("air.fan", (shapes.disc(inside), z.fan0, z.flange0)),
    )
