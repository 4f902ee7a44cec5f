"""From a machine to bodies that look like it: every meshed part, and what the mesh leaves out."""

from collections.abc import Callable

import numpy as np
from shapely import Polygon, box
from shapely.affinity import rotate

from extras.portraits.ends import bearing, shaft, shield
from extras.portraits.making import extruded, oval, revolved, rounded, swept
from extras.portraits.outlines import Outlines, angle_of, radii_of
from extras.portraits.rotating import TURN, commutator, cowl, shaft_fan, wheel
from extras.portraits.shape import Body, Finish, Shape, joined
from extras.portraits.shell import fittings, housing, standing
from thermoscope import plugin as th

STEPS = 25  # along one coil
LOOPS = 3  # of a coil around one tooth that are drawn
LAYERS = 5  # of a coil around a pole that are drawn
FINISH = {
    th.Role.IRON: Finish.LAMINATIONS,
    th.Role.ROTOR: Finish.ROTOR,
    th.Role.CAGE: Finish.CAST,
    th.Role.MAGNET: Finish.MAGNET,
    th.Role.INSULATION: Finish.INSULATION,
    th.Role.WINDING: Finish.COPPER,
    th.Role.COMMUTATOR: Finish.BRASS,
    th.Role.FAN: Finish.RUBBER,
    th.Role.BEARING: Finish.STEEL,
    th.Role.SHAFT: Finish.STEEL,
    th.Role.BASE: Finish.PLATE,
    th.Role.BRUSH: Finish.CARBON,
}
EDGE = 0.0006  # m; edges of plain parts are rounded by this


def wound(o: Outlines, part: th.Part) -> list[Body]:
    """A winding: overhang or pole coils where it has them, else its prisms as they are."""
    stacks = [p for p in o.parts(th.Role.IRON, th.Role.ROTOR) if o.section(p) is None]
    low, high = part.span
    if bool(stacks) and all(high <= s.span[0] + 1e-6 or low >= s.span[1] - 1e-6 for s in stacks):
        side = o.side(part)
        near = part.span[0] if side > 0 else part.span[1]
        straight = [p for p in part.prisms if abs((p[1] if side > 0 else p[2]) - near) < 1e-6]
        outlines = sorted((o.of(p) for p in straight), key=angle_of)
        reach, r = part.span[1] - part.span[0], radii_of(outlines[0])
        angles = np.array([angle_of(outline) for outline in outlines])
        area = outlines[0].area / (r[1] - r[0])  # mean width of a slot
        arches = len(part.prisms) >= 2 * len(straight)
        one = _round_a_tooth(r, area, angles, reach) if arches else _slot_to_slot(r, area, angles, reach)
        whole = joined(one)
        return [Body(part.name, Finish.COPPER, (whole if side > 0 else whole.flipped()).moved((0.0, 0.0, near)))]
    poles = _poles(o, part)
    if poles:
        return [Body(part.name, Finish.COPPER, coil) for coil in poles]
    return [Body(part.name, Finish.COPPER, joined([extruded(o.of(p), *p[1:]) for p in part.prisms]))]


def _slot_to_slot(r: tuple[float, float], wide: float, angles: th.Array, reach: float) -> list[Shape]:
    """A coil per slot: out in the outer layer, over an apex, back in the inner layer, as preformed coils are."""
    pitch, height = 2 * np.pi / len(angles), 0.46 * (r[1] - r[0])
    middle = (r[0] + r[1]) / 2
    span = int(np.clip(round(1.7 * reach / (pitch * middle)), 2, max(len(angles) // 4, 2)))
    t = np.linspace(0.0, 1.0, STEPS)
    up = reach * 0.94 * (1 - np.abs(2 * t - 1) ** 1.5)
    inwards = np.clip((t - 0.38) / 0.24, 0.0, 1.0)
    radius = r[1] - height / 2 - (r[1] - r[0] - height) * inwards**2 * (3 - 2 * inwards)
    slope = np.arctan(span * pitch * middle / (2 * reach))
    section = oval(height, min(0.95 * wide, 0.88 * pitch * middle * np.cos(slope)), 10)
    return [_coil(radius, start + span * pitch * t, up, section) for start in angles]


def _round_a_tooth(r: tuple[float, float], wide: float, angles: th.Array, reach: float) -> list[Shape]:
    """Half a slot's width of wire around every tooth, in a few loops one over the other."""
    middle, out = (r[0] + r[1]) / 2, []
    t = np.linspace(-1.0, 1.0, STEPS)
    for start, following in zip(angles, [*angles[1:], angles[0] + 2 * np.pi]):
        centre, half = (start + following) / 2, (following - start) / 2
        for loop in range(LOOPS):
            share = (loop + 0.5) / LOOPS
            away = half - 0.5 * wide * (1 - share) / middle
            up = reach * (0.35 + 0.58 * share) * (1 - np.abs(t) ** 3.5) ** (1 / 2.2)
            section = oval(0.97 * (r[1] - r[0]), 0.95 * 0.5 * wide / LOOPS + 0.10 * reach / LOOPS, 12)
            out.append(_coil(np.full(STEPS, middle), centre + away * t, up, section))
    return out


def _coil(radius: th.Array, angle: th.Array, up: th.Array, section: th.Array) -> Shape:
    """Its section's x points away from the axis."""
    outwards = np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
    return swept(radius[:, None] * outwards + up[:, None] * [0.0, 0.0, 1.0], outwards, section)


def _poles(o: Outlines, part: th.Part) -> list[Shape]:
    """A coil round every pole: a frame with rounded corners, wound in layers; none where the part is not like that."""
    poles = [o.of(p) for q in o.parts(th.Role.IRON) if len(q.prisms) > 1 for p in q.prisms]
    if len(part.prisms) != 4 * len(poles) or not poles:
        return []
    prisms = [(o.of(p), *p[1:]) for p in part.prisms]
    return [_frame(prisms, angle_of(pole)) for pole in poles]


def _frame(sections: list[tuple[Polygon, float, float]], angle: float) -> Shape:
    mine = [(rotate(q, np.pi / 2 - angle, origin=(0, 0), use_radians=True), z0, z1) for q, z0, z1 in sections]
    mine = [(q, z0, z1) for q, z0, z1 in mine if abs(angle_of(q) - np.pi / 2) < np.pi / 4 and q.centroid.y > 0]
    x0, y0 = min(q.bounds[0] for q, _, _ in mine), min(q.bounds[1] for q, _, _ in mine)
    x1, y1 = max(q.bounds[2] for q, _, _ in mine), max(q.bounds[3] for q, _, _ in mine)
    z0, z1 = min(z for _, z, _ in mine), max(z for _, _, z in mine)
    wide = min(q.bounds[2] - q.bounds[0] for q, _, _ in mine)
    around = rounded(box(x0, z0, x1, z1), 0.8 * wide)
    hole = box(x0 + wide, z0 + wide, x1 - wide, z1 - wide)
    step = (y1 - y0) / LAYERS
    one = extruded(around.difference(hole), 0.0, 0.96 * step, 0.2 * step)
    return joined([one.outward(angle, y0 + k * step, 0.0) for k in range(LAYERS)])


def dressed(machine: th.MachineDescription) -> list[Body]:
    """Bodies of all parts of a machine, then what is added for the picture."""
    o = Outlines(machine)
    out = [body for part in machine.parts for body in _MAKERS.get(o.role(part), _plain)(o, part)]  # type: ignore[arg-type]
    return [*out, *shaft_fan(o), *fittings(o)]


def _plain(o: Outlines, part: th.Part) -> list[Body]:
    """As it is described, its edges a little rounded."""
    role = o.role(part)
    finish = FINISH.get(role, Finish.CAST) if role else Finish.CAST
    sections = o.section(part)
    if sections:
        return [Body(part.name, finish, joined([revolved(rounded(s, 0.001)) for s in sections]))]
    plain = joined([extruded(o.of(p), *p[1:], EDGE) for p in part.prisms])
    # The insulation of a commutator is as long as its bars, and lies between them
    between = any(np.allclose(part.span, p.span) for p in o.parts(th.Role.COMMUTATOR)) and len(part.prisms) > 4
    return [Body(part.name, finish, plain.turned(TURN) if between else plain)]


def _housing(o: Outlines, part: th.Part) -> list[Body]:
    """A cowl stands before or behind the shields; all else is housing."""
    shields = [p.span for p in o.parts(th.Role.END_SHIELD)]
    outside = bool(shields) and (
        part.span[1] <= min(a for a, _ in shields) + 1e-6 or part.span[0] >= max(b for _, b in shields) - 1e-6
    )
    return cowl(o, part) if outside and o.section(part) else housing(o, part)


def _or_plain(maker: Callable[[Outlines, th.Part], list[Body]]) -> Callable[[Outlines, th.Part], list[Body]]:
    """Shields and bearings that are not round (of an imported assembly) stay as they are."""
    return lambda o, part: maker(o, part) if o.section(part) else _plain(o, part)


_MAKERS: dict[th.Role, Callable[[Outlines, th.Part], list[Body]]] = {
    th.Role.WINDING: wound,
    th.Role.END_SHIELD: _or_plain(shield),
    th.Role.BEARING: _or_plain(bearing),
    th.Role.SHAFT: shaft,
    th.Role.HOUSING: _housing,
    th.Role.FOOT: standing,
    th.Role.BASE: standing,
    th.Role.FAN: wheel,
    th.Role.COMMUTATOR: commutator,
}
