"""The commutator: one homogeneous body, or copper bars with mica between them and to the hub."""

from __future__ import annotations

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, Prism, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.series_dc.layout import Axial, Radii


def commutator(g: Geometry, z: Axial, r: Radii) -> tuple[Part, ...]:
    """Risers up to the winding, then the brush surface."""
    hub, zones = (
        g.shaft.hub_diameter / 2,
        ((r.wire_top, z.ring1, z.riser1), (g.commutator.diameter / 2, z.riser1, z.bars1)),
    )
    if not g.commutator.bars:
        return (
            Part(
                "commutator",
                "commutator",
                tuple((shapes.ring(hub, top), a, b) for top, a, b in zones),
                role=Role.COMMUTATOR,
            ),
        )
    return (
        Part(
            "commutator",
            "copper",
            tuple(prism for zone in zones for prism in _bars(g, hub, *zone)),
            role=Role.COMMUTATOR,
        ),
        Part(
            "commutator.mica",
            "mica",
            tuple(prism for zone in zones for prism in _mica(g, hub, *zone)),
            role=Role.INSULATION,
            turns=True,
        ),
    )


def _half_gap(g: Geometry) -> float:
    """Half the angle (rad) of the mica between two bars, at the brush surface."""
    return g.commutator.mica / g.commutator.diameter


def _bars(g: Geometry, hub: float, top: float, z0: float, z1: float) -> tuple[Prism, ...]:
    half_gap, angles = _half_gap(g), shapes.evenly(g.commutator.bars)
    pitch = angles[1]
    return extrude(
        [shapes.sector(hub + g.commutator.mica, top, a + half_gap, a + pitch - half_gap) for a in angles], z0, z1
    )


def _mica(g: Geometry, hub: float, top: float, z0: float, z1: float) -> tuple[Prism, ...]:
    half_gap, inner = _half_gap(g), hub + g.commutator.mica
    between = [shapes.sector(inner, top, a - half_gap, a + half_gap) for a in shapes.evenly(g.commutator.bars)]
    ends = sorted(a + side for a in shapes.evenly(g.commutator.bars) for side in (-half_gap, half_gap))
    around = tuple(shapes.polar(inner, a, shapes.bulge_of(gap)) for a, gap in zip(ends, shapes.gaps(ends)))
    return extrude([Profile(around, (shapes.circle_loop(hub),)), *between], z0, z1)
