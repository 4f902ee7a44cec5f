"""Yoke, poles and field coils."""

import math

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import Part, Prism, extrude
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.series_dc.layout import Axial, Radii


def stator(g: Geometry, z: Axial) -> tuple[Part, ...]:
    r = Radii(g)
    angles = shapes.evenly(g.stator.poles, math.pi / 2)
    sides = [shapes.rectangle(r.coil0, r.coil1, *y) for y in ((-r.coil_side, -r.insulated), (r.insulated, r.coil_side))]
    across = shapes.rectangle(r.coil0, r.coil1, -r.coil_side, r.coil_side)
    plates = [shapes.rectangle(r.coil0, r.coil1, *y) for y in ((-r.insulated, -r.body), (r.body, r.insulated))]
    cap = shapes.rectangle(r.coil0, r.coil1, -r.insulated, r.insulated)
    inner0, inner1 = z.core0 - g.field.insulation, z.core1 + g.field.insulation
    coil = (*extrude(sides, inner0, inner1), (across, z.field0, inner0), (across, inner1, z.field1))
    lining = (*extrude(plates, z.core0, z.core1), (cap, inner0, z.core0), (cap, z.core1, inner1))
    poles, filling = shapes.turned(_pole(g, r), angles), (g.field.fill, g.field.impregnation)
    return (
        Part("yoke", "steel", ((shapes.ring(r.yoke0, r.yoke1), z.yoke0, z.yoke1),), role=Role.IRON),
        Part("poles", "electrical-steel", extrude(poles, z.core0, z.core1), role=Role.IRON),
        Part("winding.field", "field-winding", _around(coil, angles), filling, role=Role.WINDING),
        Part("field.insulation", "insulation", _around(lining, angles), role=Role.INSULATION),
    )


def _around(prisms: tuple[Prism, ...], angles: list[float]) -> tuple[Prism, ...]:
    return tuple((profile.rotated(angle), z0, z1) for angle in angles for profile, z0, z1 in prisms)


def _pole(g: Geometry, r: Radii) -> Profile:
    """The shoe's back is straight, or goes around the circle of its tips where it would come nearer to the axis."""
    tip = math.pi / g.stator.poles * g.stator.pole_arc
    root = shapes.on_circle(r.yoke0, r.body)
    back, tips = math.hypot(r.shoe_back, r.body), r.bore + g.stator.tip
    leaves = math.atan2(r.body, r.shoe_back) + math.acos(min(tips / back, 1.0))  # where a tangent leaves the circle
    around, rounded = shapes.bulge_of(tip - leaves), leaves < tip and tips < back
    first = [shapes.polar(tips, -tip, around), shapes.polar(tips, -leaves)] if rounded else [shapes.polar(tips, -tip)]
    return Profile(
        (
            shapes.polar(r.bore, -tip),
            *first,
            (r.shoe_back, -r.body, 0.0),
            (root, -r.body, shapes.bulge_of(2 * math.asin(r.body / r.yoke0))),
            (root, r.body, 0.0),
            (r.shoe_back, r.body, 0.0),
            *([shapes.polar(tips, leaves, around)] if rounded else []),
            shapes.polar(tips, tip),
            shapes.polar(r.bore, tip, -shapes.bulge_of(2 * tip)),
        )
    )
