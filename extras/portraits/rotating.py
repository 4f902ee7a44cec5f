"""Fans with their cowls, and commutators with brushes."""

import numpy as np
import shapely

from extras.portraits.making import box, extruded, oval, revolved, rod, rounded, swept
from extras.portraits.outlines import Outlines, angle_of, radii_of
from extras.portraits.shape import Body, Finish, Shape, joined
from thermoscope import plugin as th

BLADES = 9  # of a shaft fan that is not meshed
TURN = 0.017  # rad: a cut through the axis then runs through bars, not along the insulation between two
BARS = 2  # of a smeared commutator, per rotor slot


def wheel(o: Outlines, part: th.Part) -> list[Body]:
    """A hub with twisted blades, where the mesh has flat ones; and a guard in front."""
    hubs = [p for p in part.prisms if o.of(p).interiors]
    blades = [p for p in part.prisms if not o.of(p).interiors]
    z0, z1 = part.span
    hub = [extruded(o.of(p), *p[1:], 0.002) for p in hubs]
    if not blades:
        return [Body(part.name, Finish.RUBBER, joined(hub))]
    r0, r1 = radii_of(o.of(blades[0]))
    vanes = [_blade(r0, r1, z1 - z0, (z0 + z1) / 2, angle_of(o.of(p)), len(blades)) for p in blades]
    return [Body(part.name, Finish.RUBBER, joined([*hub, *vanes]))]


def _blade(r0: float, r1: float, deep: float, z: float, angle: float, count: int) -> Shape:
    """Steeper at the hub than at the tip."""
    radius = np.linspace(0.96 * r0, r1, 12)
    pitch = np.deg2rad(np.linspace(62.0, 32.0, 12))
    out = np.array([np.cos(angle), np.sin(angle), 0.0])
    around = np.array([-np.sin(angle), np.cos(angle), 0.0])
    across = np.cos(pitch)[:, None] * around + np.sin(pitch)[:, None] * np.array([0.0, 0.0, 1.0])
    chord = min(0.95 * deep / np.sin(pitch[0]), 1.5 * 2 * np.pi * r0 / count)
    return swept(radius[:, None] * out + [0.0, 0.0, z], across, oval(chord, 0.07 * chord, 14, 2.2))


def cowl(o: Outlines, part: th.Part) -> list[Body]:
    """A meshed cowl, with a guard over its outer end."""
    sections = o.section(part) or []
    r0, z0, _, z1 = shapely.union_all(sections).bounds
    meshes = [revolved(rounded(s, 0.0005)) for s in sections]
    side = o.side(part)
    return [
        Body(part.name, Finish.PAINT, joined(meshes)),
        Body(part.name, Finish.STEEL, _cover(r0, z1 if side > 0 else z0), added=True),
    ]


def _cover(radius: float, z: float) -> Shape:
    """Wires in rings, and four spokes."""
    wire = max(0.009 * radius, 0.0008)
    rings = [revolved(shapely.Point(r, z).buffer(wire, quad_segs=2), 90) for r in np.linspace(0.2, 0.98, 9) * radius]
    spoke = rod(1.2 * wire, 0.8 * radius, 0.0, 8)
    return joined([*rings, *(spoke.outward(np.pi / 4 + k * np.pi / 2, 0.18 * radius, z) for k in range(4))])


def shaft_fan(o: Outlines) -> list[Body]:
    """Fan and cowl of a machine that blows over its housing, where the mesh has neither: on the left."""
    blows = "cowl" in o.machine.sections.get("fans", {})
    housings, shields = o.parts(th.Role.HOUSING), o.parts(th.Role.END_SHIELD)
    if not blows or o.parts(th.Role.FAN) or not housings or not shields:
        return []
    body, shield = housings[0], min(shields, key=lambda p: p.span[0])
    reach, face = 1.015 * o.reach(body), shield.span[0]
    deep, wall = 0.5 * reach, 0.012 * reach
    back, over = face - deep, body.span[0] + 0.18 * (body.span[1] - body.span[0])
    outside = [(reach, over), (reach, back + 0.12 * reach), (0.88 * reach, back), (0.70 * reach, back)]
    shell = shapely.LineString(outside).buffer(wall, cap_style="flat", join_style="round", quad_segs=3)
    shafts = [s for p in o.parts(th.Role.SHAFT) for s in o.section(p) or []]
    radius = 0.7 * max((s.bounds[2] for s in shafts), default=0.15 * reach)
    fan = _radial_fan(radius, 0.74 * reach, back + 0.2 * deep, face - 0.18 * deep)
    stub = rod(radius, 0.85 * deep).flipped().moved((0, 0, face))
    return [
        Body(body.name, Finish.PAINT, revolved(shell), added=True),
        Body(body.name, Finish.STEEL, _cover(0.71 * reach, back), added=True),
        Body(shield.name, Finish.RUBBER, fan, added=True),
        *(Body(p.name, Finish.STEEL, stub, added=True) for p in o.parts(th.Role.SHAFT)[:1]),
    ]


def _radial_fan(radius: float, tip: float, z0: float, z1: float) -> Shape:
    """A disc at the machine's side with straight blades: it blows alike both ways round."""
    disc = revolved(rounded(shapely.box(radius, z1 - 0.1 * (z1 - z0), tip, z1), 0.0005))
    hub = revolved(rounded(shapely.box(radius, z0, 1.6 * radius, z1), 0.001))
    side = shapely.Polygon(
        [(1.5 * radius, z0), (0.75 * tip, z0), (tip, z0 + 0.45 * (z1 - z0)), (tip, z1), (1.5 * radius, z1)]
    )
    thick = 0.02 * tip
    flat = extruded(side, -thick / 2, thick / 2, 0.2 * thick)
    one = flat.placed((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.0, 0.0, 0.0))
    return joined([disc, hub, *(one.turned(2 * np.pi * k / BLADES) for k in range(BLADES))])


def commutator(o: Outlines, part: th.Part) -> list[Body]:
    """Its bars, and brushes in their holders on them, one row for every main pole, where the mesh has none."""
    outlines = [(o.of(p), *p[1:]) for p in part.prisms]
    low = min(radii_of(q)[1] for q, _, _ in outlines)
    z0 = min(z for q, z, _ in outlines if radii_of(q)[1] < low + 1e-6)
    z1 = max(z for q, _, z in outlines if radii_of(q)[1] < low + 1e-6)
    pieces = [extruded(q, a, b, 0.0004) for q, a, b in (outlines if len(outlines) > 4 else _bars(o, outlines))]
    poles = [angle_of(o.of(q)) for p in o.parts(th.Role.IRON) if len(p.prisms) > 1 for q in p.prisms]
    rows = [] if o.parts(th.Role.BRUSH) else poles  # meshed ones are drawn as they are
    brushes = [b for angle in rows for b in _brush(part, low, (z0, z1), angle)]
    return [Body(part.name, Finish.BRASS, joined(pieces).turned(TURN)), *brushes]


def _bars(
    o: Outlines, outlines: list[tuple[shapely.Polygon, float, float]]
) -> list[tuple[shapely.Polygon, float, float]]:
    """Smeared rings cut into bars, as many as there usually are."""
    slots = max((len(p.prisms) for p in o.parts(th.Role.INSULATION)), default=24)
    out = []
    for outline, z0, z1 in outlines:
        reach = 2 * radii_of(outline)[1]
        gap = [
            shapely.LineString([(0, 0), (reach * np.cos(a), reach * np.sin(a))]).buffer(0.0004)
            for a in 2 * np.pi * np.arange(BARS * slots) / (BARS * slots)
        ]
        pieces = outline.difference(shapely.union_all(gap))
        out += [(piece, z0, z1) for piece in pieces.geoms]
    return out


def _brush(part: th.Part, radius: float, span: tuple[float, float], angle: float) -> list[Body]:
    """Two carbons side by side in boxes on one arm, with their springs."""
    length, out = span[1] - span[0], []
    wide, long, high = 0.24 * radius, 0.34 * length, 0.42 * radius
    for share in (0.3, 0.72):
        z = span[0] + share * length
        carbon = box(wide, long, high, 0.0008).outward(angle, radius, z)
        holder = box(1.35 * wide, 1.2 * long, 0.55 * high, 0.001).outward(angle, radius + 0.3 * high, z)
        out += [Body(part.name, Finish.CARBON, carbon, added=True), Body(part.name, Finish.BRASS, holder, added=True)]
    arm = rod(0.22 * wide, 1.25 * length).moved((0.0, 0.0, span[0]))
    at = radius + 0.55 * high
    beside = arm.moved((at * np.cos(angle), at * np.sin(angle), 0.0)).turned(0.95 * wide / at)
    return [*out, Body(part.name, Finish.STEEL, beside, added=True)]
