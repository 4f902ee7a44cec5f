"""What closes and carries a machine at its ends: end shields with ribs and bolts, bearings with balls, the shaft."""

import numpy as np
import shapely

from extras.portraits.making import ball, bolt, box, extruded, revolved, rod, rounded
from extras.portraits.outlines import Outlines
from extras.portraits.shape import Body, Finish, Shape, joined
from thermoscope import plugin as th

RIBS, BOLTS, COVER_BOLTS = 8, 8, 4  # for the eye only
EXTENSION = 1.6  # diameters of a shaft that drives something, as in IEC 60072-1
STUB = 0.75  # diameters of overhang from which a shaft counts as extended already


def shield(o: Outlines, part: th.Part) -> list[Body]:
    """The shield itself, rounded, and on it a bearing cover, ribs and bolts."""
    side, sections = o.side(part), o.section(part) or []
    disc = [revolved(rounded(section, 0.003, 0.004)) for section in sections]
    seat = min(section.bounds[0] for section in sections)
    rim = max(section.bounds[2] for section in sections)
    face = part.span[1] if side > 0 else part.span[0]
    thick = min(section.bounds[3] - section.bounds[1] for section in sections)
    thick = min(thick, 0.2 * rim)
    # Radius (m) of what stands in front of a shield: a fan's cowl
    fronts = [
        p for p in o.machine.parts if p is not part and o.role(p) in (th.Role.HOUSING, th.Role.FAN) and o.section(p)
    ]
    outside = [
        p for p in fronts if (p.span[0] >= part.span[1] - 1e-6 if side > 0 else p.span[1] <= part.span[0] + 1e-6)
    ]
    hidden = 1.03 * max((o.reach(p) for p in outside), default=0.0)
    cover = _cover(o, part, seat, thick, side).moved((0.0, 0.0, face))
    start = max(1.45 * seat, hidden)
    count = 0 if start > 0.75 * rim else RIBS
    ribs = [_rib(start, 0.9 * rim, thick, side, k).moved((0.0, 0.0, face)) for k in range(count)]
    thread = float(np.clip(0.035 * rim, 0.003, 0.010))
    at = [(2 * np.pi * (k + 0.5) / BOLTS, 0.94 * rim) for k in range(BOLTS)]
    bolts = [bolt(thread).on_end(angle, radius, face, side) for angle, radius in at if radius > hidden]
    return [
        Body(part.name, Finish.PAINT, joined(disc)),
        Body(part.name, Finish.PAINT, joined([cover, *ribs]), added=True),
        *(Body(part.name, Finish.STEEL, one, added=True, whole=True) for one in bolts),
    ]


def _cover(o: Outlines, part: th.Part, seat: float, thick: float, side: int) -> Shape:
    """A boss around the bearing and the cover in it, its own z from the shield's outer face."""
    shaft = max((s.bounds[2] for p in o.parts(th.Role.SHAFT) for s in _cut_at(o, p, part)), default=0.5 * seat)
    boss = shapely.box(seat, -0.1 * thick, 1.3 * seat, 0.3 * thick)
    lid = shapely.box(shaft + 0.0015, -0.02 * thick, 1.12 * seat, 0.5 * thick)
    ring = revolved(rounded(shapely.union_all([boss, lid]), 0.0015, 0.0015))
    thread = float(np.clip(0.09 * seat, 0.0025, 0.008))
    heads = [
        bolt(thread).on_end(np.pi * (2 * k + 1) / COVER_BOLTS, 0.88 * seat, 0.5 * thick, 1) for k in range(COVER_BOLTS)
    ]
    whole = joined([ring, *heads])
    return whole if side > 0 else whole.flipped()


def _cut_at(o: Outlines, shaft: th.Part, part: th.Part) -> list[shapely.Polygon]:
    """The shaft's section where the shield is."""
    z = sum(part.span) / 2
    return [s for s in o.section(shaft) or [] if s.bounds[1] <= z <= s.bounds[3]]


def _rib(start: float, end: float, thick: float, side: int, number: int) -> Shape:
    """A rib that runs out towards the rim."""
    high, wide = 0.45 * thick, float(np.clip(0.035 * end, 0.003, 0.012))
    slope = shapely.Polygon(
        [(start, -1e-3), (start, high), (start + 0.2 * (end - start), high), (end, 0.1 * high), (end, -1e-3)]
    )
    flat = extruded(slope, -wide / 2, wide / 2, 0.25 * wide)  # x out, y forwards, z around
    upright = flat.placed((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.0, 0.0, 0.0))
    return (upright if side > 0 else upright.flipped()).turned(2 * np.pi * number / RIBS)


def bearing(o: Outlines, part: th.Part) -> list[Body]:
    """Two rings with balls between them."""
    section = (o.section(part) or [])[0]
    r0, z0, r1, z1 = section.bounds
    width, middle, race = z1 - z0, (r0 + r1) / 2, 0.29 * (r1 - r0)
    inner = revolved(rounded(shapely.box(r0, z0, r0 + race, z1), 0.001))
    outer = revolved(rounded(shapely.box(r1 - race, z0, r1, z1), 0.001))
    radius = min(0.30 * (r1 - r0), 0.48 * width)
    count = int(2 * np.pi * middle / (2.5 * radius))
    one = ball(radius).moved((middle, 0.0, (z0 + z1) / 2))
    balls = [one.turned(2 * np.pi * k / count) for k in range(count)]
    return [Body(part.name, Finish.STEEL, joined([inner, outer, *balls]))]


def shaft(o: Outlines, part: th.Part) -> list[Body]:
    """With chamfered steps, and at its longer end an extension with a key."""
    sections = o.section(part)
    if not sections:
        return [Body(part.name, Finish.STEEL, joined([extruded(o.of(p), *p[1:], 0.001) for p in part.prisms]))]
    body = Body(part.name, Finish.STEEL, joined([revolved(rounded(_chamfered(s), 0.0, 0.0)) for s in sections]))
    shields = o.parts(th.Role.END_SHIELD, th.Role.BEARING)
    left = min((p.span[0] for p in shields), default=part.span[0]) - part.span[0]
    right = part.span[1] - max((p.span[1] for p in shields), default=part.span[1])
    side = 1 if right >= left - 1e-6 or any(p.span[1] < o.middle for p in o.parts(th.Role.FAN)) else -1
    end = part.span[1] if side > 0 else part.span[0]
    radius = max(s.bounds[2] for s in sections if s.bounds[1] <= end <= s.bounds[3])
    there = right if side > 0 else left
    if there > STUB * 2 * radius:
        return [body, Body(part.name, Finish.STEEL, _key(radius, end - side * there, there, side), added=True)]
    length = EXTENSION * 2 * radius
    more = rod(0.86 * radius, length, 0.06 * radius, 96)
    more = (more if side > 0 else more.flipped()).moved((0.0, 0.0, end))
    return [body, Body(part.name, Finish.STEEL, joined([more, _key(0.86 * radius, end, length, side)]), added=True)]


def _chamfered(section: shapely.Polygon) -> shapely.Polygon:
    """Corners away from the axis cut by a thirtieth of the radius."""
    _, z0, r1, z1 = section.bounds
    cut = r1 / 30
    mirrored = shapely.union_all([section, shapely.affinity.scale(section, -1.0, 1.0, origin=(0, 0))])
    smooth = mirrored.buffer(-cut, join_style="mitre").buffer(cut, join_style="bevel").simplify(1e-6)
    half = smooth.intersection(shapely.box(0.0, z0, r1, z1))
    return half if half.geom_type == "Polygon" else section


def _key(radius: float, start: float, length: float, side: int) -> Shape:
    """A parallel key on top of a shaft end, as wide as a quarter of the diameter."""
    wide = radius / 2
    key = box(wide, 0.7 * length, 0.55 * wide, 0.08 * wide)
    return key.outward(np.pi / 2, 0.93 * radius, start + side * 0.52 * length)
