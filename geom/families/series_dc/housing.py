"""Housing with fins or liquid jackets, flanges, bearings, feet and base."""

from __future__ import annotations

import math
from typing import Any

from geom import shapes
from geom.families.series_dc.layout import Axial, Radii
from geom.part import Part, Port, Prism, extrude, fluid
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
        passages = _zigzag(g, r, z0, z1)
        pierced = [(Profile(solid.outer, (*solid.holes, *(c.outer for c in cs))), a, b) for cs, a, b in passages]
        return [(solid, z0, z0 + g.jacket.rib), *pierced, (solid, z1 - g.jacket.rib, z1)]
    inner, outer = shapes.ring(r.yoke1, r.shell), shapes.ring(r.channel, r.jacket)
    turns = _turns(g, z0, z1)
    ends = [z0, *(z for turn in turns for z in turn), z1]
    ribs = [(solid, a, b) for a, b in zip(ends[::2], ends[1::2])]
    return ribs + [(ring, a, b) for a, b in turns for ring in (inner, outer)]


def _zigzag(g: Any, r: Radii, z0: float, z1: float) -> list[tuple[list[Profile], float, float]]:
    """Channels along the axis, straight first; then those joined in pairs at the left end, and at the right end."""
    first, last, n = z0 + g.jacket.rib, z1 - g.jacket.rib, g.jacket.channels
    turn = turn_length(g, z0, z1)
    straight, left = [(i, i) for i in range(n)], [(i, min(i + 1, n - 1)) for i in range(0, n, 2)]
    right = [(0, 0), *((i, min(i + 1, n - 1)) for i in range(1, n, 2))]
    zones = ((straight, first + turn, last - turn), (left, first, first + turn), (right, last - turn, last))
    return [([_channel(g, r, *pair) for pair in pairs], a, b) for pairs, a, b in zones]


def turn_length(g: Any, z0: float, z1: float) -> float:
    """Axial length (m) over which two channels are joined: as deep as they are high, if there is room."""
    return min(g.jacket.height, 0.3 * (z1 - z0 - 2 * g.jacket.rib))


def _channel(g: Any, r: Radii, i: int, j: int) -> Profile:
    """From channel i to channel j, what lies between included."""
    half = math.pi / g.jacket.channels - g.jacket.rib / 2 / r.shell
    pitch, top = 2 * math.pi / g.jacket.channels, math.pi / 2
    return shapes.sector(r.shell, r.channel, top + i * pitch - half, top + j * pitch + half)


def _turns(g: Any, z0: float, z1: float) -> list[tuple[float, float]]:
    """Axial range of each turn of a helical jacket, ribs between and at both ends."""
    pitch = (z1 - z0 - g.jacket.rib) / g.jacket.turns
    return [(z0 + i * pitch + g.jacket.rib, z0 + (i + 1) * pitch) for i in range(g.jacket.turns)]


def coolant(g: Any, z: Axial) -> tuple[Part, ...]:
    """What flows in the jackets, one fluid each."""
    r = Radii(g)
    return tuple(fluid(name, *_channel_prisms(g, r, *span), material="glycol-50") for name, span in z.jackets.items())


def ports(g: Any) -> tuple[Port, ...]:
    """Inlet and outlet of every jacket, on its outer wall: first and last channel or turn."""
    r = Radii(g)
    return tuple(port for name, span in Axial(g).jackets.items() for port in _ports(g, r, name, *span))


def _ports(g: Any, r: Radii, name: str, z0: float, z1: float) -> tuple[Port, Port]:
    top, n = math.pi / 2, g.jacket.channels
    if g.jacket.layout == "helical":
        turns = _turns(g, z0, z1)
        ends = [(top, sum(turns[0]) / 2), (top, sum(turns[-1]) / 2)]
    else:
        turn = turn_length(g, z0, z1) / 2
        near, far = z0 + g.jacket.rib + turn, z1 - g.jacket.rib - turn
        ends = [(top, far), (top + (n - 1) * 2 * math.pi / n, far if n % 2 == 0 else near)]
    first, last = ((r.jacket * math.cos(a), r.jacket * math.sin(a), z) for a, z in ends)
    return Port(f"{name}.inlet", name, first), Port(f"{name}.outlet", name, last)


def _channel_prisms(g: Any, r: Radii, z0: float, z1: float) -> tuple[Prism, ...]:
    if g.jacket.layout == "zigzag":
        return tuple(prism for channels, a, b in _zigzag(g, r, z0, z1) for prism in extrude(channels, a, b))
    return tuple((shapes.ring(r.shell, r.channel), a, b) for a, b in _turns(g, z0, z1))


def _finned(g: Any, r: Radii) -> tuple[tuple[float, float, float], ...]:
    around = shapes.spread(g.housing.fins, math.pi / 2, g.housing.fin_spacing / r.shell)
    angles = [a for a in around if not _over_foot(g, r, a)]
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
