"""The commutator, one homogeneous body or copper bars with mica between them and to the hub; and its brush gear."""

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, Prism, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.series_dc.layout import Axial, Radii

_FREE = 0.1  # of the commutator's length: riser to brush


def commutator(g: Geometry, z: Axial, r: Radii) -> tuple[Part, ...]:
    """Risers up to the winding, then the brush surface."""
    hub = g.shaft.hub_diameter / 2
    zones = ((r.wire_top, z.ring1, z.riser1), (g.commutator.diameter / 2, z.riser1, z.bars1))
    if not g.commutator.bars:
        rings = tuple((shapes.ring(hub, top), a, b) for top, a, b in zones)
        return (Part("commutator", "commutator", rings, role=Role.COMMUTATOR),)
    half_gap, angles = g.commutator.mica / g.commutator.diameter, shapes.evenly(g.commutator.bars)
    inner, pitch = hub + g.commutator.mica, angles[1]
    ends = sorted(a + side for a in angles for side in (-half_gap, half_gap))
    around = tuple(shapes.polar(inner, a, shapes.bulge_of(gap)) for a, gap in zip(ends, shapes.gaps(ends)))
    sleeve = Profile(around, (shapes.circle_loop(hub),))
    bars, mica = list[Prism](), list[Prism]()
    for top, a0, a1 in zones:
        bars += extrude([shapes.sector(inner, top, a + half_gap, a + pitch - half_gap) for a in angles], a0, a1)
        between = [shapes.sector(inner, top, a - half_gap, a + half_gap) for a in angles]
        mica += extrude([sleeve, *between], a0, a1)
    return (
        Part("commutator", "copper", tuple(bars), role=Role.COMMUTATOR),
        Part("commutator.mica", "mica", tuple(mica), role=Role.INSULATION, turns=True),
    )


def brush_gear(g: Geometry, z: Axial) -> tuple[Part, ...]:
    """Carbons, and an arm per row that holds them and leads their heat to the right flange; nothing without arms."""
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
