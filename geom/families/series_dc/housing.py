"""Housing with fins or liquid jackets, flanges, bearings, feet and base."""

from __future__ import annotations

import math
from typing import Any

from geom import shapes
from geom.families.series_dc.layout import Axial, Radii
from geom.part import Part, Prism, extrude, fluid
from geom.profile import Profile


def enclosure(g: Any, z: Axial) -> tuple[Part, ...]:
    r = Radii(g)
    seat, shaft = g.bearing.outer_diameter / 2, g.shaft.bearing_diameter / 2
    flange, bearing = shapes.ring(seat, r.shell), shapes.ring(shaft, seat)
    left, right = (z.flange0, z.inner0), (z.inner1, z.flange1)
    return (
        Part("housing", "aluminium-cast", _housing(g, z, r)),
        Part("flange.left", "aluminium-cast", ((flange, *left),)),
        Part("flange.right", "aluminium-cast", ((flange, *right),)),
        Part("bearing.left", "bearing", ((bearing, *left),)),
        Part("bearing.right", "bearing", ((bearing, *right),)),
        Part("feet", "aluminium-cast", _feet(g, z, r)),
        _base(g, z),
    )


def _housing(g: Any, z: Axial, r: Radii) -> tuple[Prism, ...]:
    finned = Profile(_finned(g, r), (shapes.circle_loop(r.yoke1),))
    prisms: list[Prism] = []
    here = z.inner0
    for name, (z0, z1) in z.jackets.items():
        prisms += [(finned, here, z0)] if here < z0 else []
        prisms += _jacket_walls(g, z, r, name)
        here = z1
    return (*prisms, (finned, here, z.inner1))


def _jacket_walls(g: Any, z: Axial, r: Radii, name: str) -> list[Prism]:
    """The housing's wall around the channels of one jacket."""
    z0, z1 = z.jackets[name]
    solid = shapes.ring(r.yoke1, r.jacket)
    if g.jacket.layout == "zigzag":
        channels = tuple(channel.outer for channel in _channels(g, r))
        pierced = Profile(solid.outer, (*solid.holes, *channels))
        rib = g.jacket.rib
        return [(solid, z0, z0 + rib), (pierced, z0 + rib, z1 - rib), (solid, z1 - rib, z1)]
    inner, outer = shapes.ring(r.yoke1, r.shell), shapes.ring(r.channel, r.jacket)
    turns = _turns(g, z0, z1)
    ends = [z0, *(z for turn in turns for z in turn), z1]
    ribs = [(solid, a, b) for a, b in zip(ends[::2], ends[1::2])]
    return ribs + [(ring, a, b) for a, b in turns for ring in (inner, outer)]


def _channels(g: Any, r: Radii) -> list[Profile]:
    half = math.pi / g.jacket.channels - g.jacket.rib / 2 / r.shell
    start = shapes.evenly(g.jacket.channels, math.pi / 2)
    return [shapes.sector(r.shell, r.channel, angle - half, angle + half) for angle in start]


def _turns(g: Any, z0: float, z1: float) -> list[tuple[float, float]]:
    """Axial range of each turn of a helical jacket, ribs between and at both ends."""
    pitch = (z1 - z0 - g.jacket.rib) / g.jacket.turns
    return [(z0 + i * pitch + g.jacket.rib, z0 + (i + 1) * pitch) for i in range(g.jacket.turns)]


def coolant(g: Any, z: Axial) -> tuple[Part, ...]:
    """What flows in the jackets, one fluid each."""
    r = Radii(g)
    return tuple(fluid(name, *_channel_prisms(g, r, *span), material="glycol-50") for name, span in z.jackets.items())


def _channel_prisms(g: Any, r: Radii, z0: float, z1: float) -> tuple[Prism, ...]:
    if g.jacket.layout == "zigzag":
        return extrude(_channels(g, r), z0 + g.jacket.rib, z1 - g.jacket.rib)
    return tuple((shapes.ring(r.shell, r.channel), a, b) for a, b in _turns(g, z0, z1))


def _finned(g: Any, r: Radii) -> tuple[tuple[float, float, float], ...]:
    angles = [a for a in shapes.evenly(g.housing.fins, math.pi / 2) if not _over_foot(g, r, a)]
    if not angles:
        return shapes.circle_loop(r.shell)
    return shapes.finned_loop(r.shell, g.housing.fin_thickness, r.fins, angles)


def _over_foot(g: Any, r: Radii, angle: float) -> bool:
    """A fin here would run into a foot, which is bounded by two vertical planes under the housing."""
    margin = 0.6 * g.housing.fin_thickness
    near, far = r.shell * abs(math.cos(angle)) - margin, r.fins * abs(math.cos(angle)) + margin
    return math.sin(angle) < 0 and near < g.feet.inner + g.feet.width and far > g.feet.inner


def _feet(g: Any, z: Axial, r: Radii) -> tuple[Prism, ...]:
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


def _base(g: Any, z: Axial) -> Part:
    top, middle = -g.feet.shaft_height, (z.inner0 + z.inner1) / 2
    plate = shapes.rectangle(-g.base.width / 2, g.base.width / 2, top - g.base.thickness, top)
    return Part("base", "steel", ((plate, middle - g.base.length / 2, middle + g.base.length / 2),))
