"""Housing with fins or liquid jackets, flanges, bearings, feet and base."""

from __future__ import annotations

import math
from collections.abc import Sequence

from geom.description import shapes
from geom.description.geometry import Geometry
from geom.description.part import CadShape, Part, Prism
from geom.description.profile import Profile
from geom.description.roles import Role
from geom.families.nozzles import Nozzle
from geom.families.series_dc.jacket import jacket_ring, jacket_walls, nozzles, turns_of
from geom.families.series_dc.layout import Axial, Radii


def enclosure(g: Geometry, z: Axial) -> tuple[Part, ...]:
    r = Radii(g)
    seat, shaft = g.bearing.outer_diameter / 2, g.shaft.bearing_diameter / 2
    flange, bearing = shapes.ring(seat, r.shell), shapes.ring(shaft, seat)
    left, right = (z.flange0, z.inner0), (z.inner1, z.flange1)
    return (
        _housing(g, z, r),
        Part("flange.left", "aluminium-cast", ((flange, *left),), role=Role.END_SHIELD),
        Part("flange.right", "aluminium-cast", ((flange, *right),), role=Role.END_SHIELD),
        Part("bearing.left", "bearing", ((bearing, *left),), role=Role.BEARING),
        Part("bearing.right", "bearing", ((bearing, *right),), role=Role.BEARING),
        Part("feet", "aluminium-cast", _feet(g, z, r), role=Role.FOOT),
        _base(g, z),
        *(nozzle.part() for nozzle in nozzles(g)),
    )


def _housing(g: Geometry, z: Axial, r: Radii) -> Part:
    """The housing; with jackets, as it is made: round bores, and a helix for the rings."""
    bored, helical = nozzles(g), g.jacket.layout == "helical"
    cad_shape = None
    if bored:
        helices = [turns_of(g, r, *span).helix(g.jacket.port) for span in z.jackets.values() if helical]
        cad_shape = CadShape(_walls(g, z, r, None if helical else ()), (*helices, *(nozzle.drill for nozzle in bored)))
    return Part("housing", "aluminium-cast", _walls(g, z, r, bored), cad_shape=cad_shape, role=Role.HOUSING)


def _walls(g: Geometry, z: Axial, r: Radii, bored: Sequence[Nozzle] | None) -> tuple[Prism, ...]:
    """The housing with bores, or for None without channels."""
    finned = Profile(_finned(g, r), (shapes.circle_loop(r.yoke1),))
    prisms: list[Prism] = []
    here = z.inner0
    for name, (z0, z1) in z.jackets.items():
        prisms += [(finned, here, z0)] if here < z0 else []
        bores = None if bored is None else [nozzle for nozzle in bored if nozzle.jacket == name]
        prisms += [(jacket_ring(r), z0, z1)] if bores is None else jacket_walls(g, r, z0, z1, bores)
        here = z1
    return (*prisms, (finned, here, z.inner1))


def _finned(g: Geometry, r: Radii) -> tuple[tuple[float, float, float], ...]:
    around = shapes.spread(g.housing.fins, math.pi / 2, g.housing.fin_spacing / r.shell)
    angles = [a for a in around if not _over_foot(g, r, a)]
    if not angles:
        return shapes.circle_loop(r.shell)
    return shapes.finned_loop(r.shell, g.housing.fin_thickness, r.fins, angles)


def _over_foot(g: Geometry, r: Radii, angle: float) -> bool:
    """A fin here would run into a foot, which is bounded by two vertical planes under the housing."""
    margin = 0.6 * g.housing.fin_thickness
    near, far = r.shell * abs(math.cos(angle)) - margin, r.fins * abs(math.cos(angle)) + margin
    return math.sin(angle) < 0 and near < g.feet.inner + g.feet.width and far > g.feet.inner


def _feet(g: Geometry, z: Axial, r: Radii) -> tuple[Prism, ...]:
    x0, x1 = g.feet.inner, g.feet.inner + g.feet.width
    y0, y1 = -shapes.on_circle(r.shell, x0), -shapes.on_circle(r.shell, x1)
    down = -g.feet.shaft_height
    sweep = math.acos(x0 / r.shell) - math.acos(x1 / r.shell)
    arc = shapes.bulge_of(sweep)
    right = Profile(((x0, down, 0.0), (x1, down, 0.0), (x1, y1, -arc), (x0, y0, 0.0)))
    left = Profile(((-x1, down, 0.0), (-x0, down, 0.0), (-x0, y0, -arc), (-x1, y1, 0.0)))
    near, far = z.inner0 + g.feet.inset, z.inner1 - g.feet.inset
    spans = ((near, near + g.feet.length), (far - g.feet.length, far))
    return tuple((foot, *span) for foot in (left, right) for span in spans)


def _base(g: Geometry, z: Axial) -> Part:
    top, middle = -g.feet.shaft_height, (z.inner0 + z.inner1) / 2
    plate = shapes.rectangle(-g.base.width / 2, g.base.width / 2, top - g.base.thickness, top)
    return Part("base", "steel", ((plate, middle - g.base.length / 2, middle + g.base.length / 2),), role=Role.BASE)
