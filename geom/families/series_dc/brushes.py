"""Brush gear: carbons on the commutator, and the arms that hold them and lead their heat to the right flange."""

from __future__ import annotations

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, extrude
from geom.description.roles import Role
from geom.families.series_dc.layout import Axial

_FREE = 0.1  # of the commutator's length: riser to brush


def brush_gear(g: Geometry, z: Axial) -> tuple[Part, ...]:
    """An arm per row of carbons, from the riser to the flange; nothing without arms."""
    b, surface = g.brushes, g.commutator.diameter / 2
    if not b.arms:
        return ()
    begin, top = z.riser1 + _FREE * g.commutator.length, surface + b.height
    angles, half = shapes.evenly(b.arms, math.pi / 2), b.arc * math.pi / b.arms
    carbons = [shapes.sector(surface, top, a - half, a + half) for a in angles]
    arms = [shapes.sector(top, top + b.arm, a - half, a + half) for a in angles]
    return (
        Part("brushes", "carbon", extrude(carbons, begin, z.bars1), role=Role.BRUSH),
        Part("brush.arms", "steel", extrude(arms, begin, z.inner1), role=Role.BRUSH),
    )
