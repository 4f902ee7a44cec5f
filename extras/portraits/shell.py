"""What stands around the active parts: housing, feet, base, terminal box, lifting eye, jacket ports."""

import numpy as np
import shapely

from extras.portraits.making import bolt, box, extruded, hexagon, oval, revolved, rod, rounded, swept
from extras.portraits.outlines import Outlines
from extras.portraits.shape import Body, Finish, Shape, joined
from thermoscope import plugin as th

BOX_ANGLE = np.deg2rad(62.0)  # beside the top: behind the usual cut
UP = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))  # x across, y backwards along the axis, z up


def housing(o: Outlines, part: th.Part) -> list[Body]:
    """Fins with rounded tops and fillets at their feet; pipes as pipes."""
    pipe = _pipe(o, part)
    if pipe is not None:
        return pipe
    sections = o.section(part)
    if sections:
        return [Body(part.name, Finish.PAINT, joined([revolved(rounded(s, 0.0015, 0.0015)) for s in sections]))]
    edge = 0.0015 if len(part.prisms) == 1 else 0.0
    pieces = [extruded(rounded(o.of(p), 0.0018, 0.0025), *p[1:], edge) for p in part.prisms]
    return [Body(part.name, Finish.PAINT, joined(pieces))]


def _pipe(o: Outlines, part: th.Part) -> list[Body] | None:
    """A port's tube, with a nut, a nozzle and a piece of hose."""
    one = None if part.cad_shape is None else part.cad_shape.start
    if not isinstance(one, th.Rod):
        return None
    r, angle, z = one.diameter / 2, one.angle, one.z
    nut = extruded(hexagon(1.35 * r), 0.0, 0.8 * r, 0.08 * r)
    hose = _hose(0.95 * r, 6.0 * r)
    return [
        Body(part.name, Finish.STEEL, rod(r, one.outer - one.inner, 0.0, 48).outward(angle, one.inner, z)),
        Body(part.name, Finish.BRASS, nut.outward(angle, one.outer, z), added=True, whole=True),
        Body(part.name, Finish.RUBBER, hose.outward(angle, one.outer + 0.8 * r, z), added=True, whole=True),
    ]


def _hose(radius: float, length: float) -> Shape:
    """Straight out, then bent along the axis."""
    t = np.linspace(0.0, np.pi / 2, 12)
    bend = np.stack([np.zeros_like(t), -length / 2 * (1 - np.cos(t)), length / 2 * (0.4 + np.sin(t))], axis=1)
    path = np.concatenate([[[0.0, 0.0, 0.0]], bend])
    return swept(path, np.tile([1.0, 0.0, 0.0], (len(path), 1)), oval(2 * radius, 2 * radius, 20, 2.0))


def standing(o: Outlines, part: th.Part) -> list[Body]:
    """Feet with a bolted sole; the base as it is, its edges rounded."""
    base = o.role(part) is th.Role.BASE
    finish = Finish.PLATE if base else Finish.PAINT
    body = Body(part.name, finish, joined([extruded(o.of(p), *p[1:], 0.002) for p in part.prisms]))
    if base:
        return [body]
    return [body, *(b for p in part.prisms for b in _sole(part, o.of(p), *p[1:]))]


def _sole(part: th.Part, outline: shapely.Polygon, z0: float, z1: float) -> list[Body]:
    """A plate under a foot, wider than the foot, with a bolt on either side in a hole that is seen around it."""
    x0, low, x1, top = outline.bounds
    thick, over = min(0.25 * (top - low), 0.016), float(np.clip(0.35 * (x1 - x0), 0.012, 0.035))
    flat = shapely.box(x0 - over, z0, x1 + over, z1)
    holes = [(x, z) for x in (x0 - over / 2, x1 + over / 2) for z in _bolted(z0, z1)]
    drilled = flat.difference(shapely.union_all([shapely.Point(at).buffer(0.26 * over) for at in holes]))
    plate = extruded(rounded(flat, 0.3 * over).intersection(drilled), 0.0, thick, 0.0015)
    plate = plate.placed((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, -1.0, 0.0), (0.0, low + thick, 0.0))
    heads = [bolt(0.36 * over).placed(*UP, (x, low + thick, z)) for x, z in holes]
    return [
        Body(part.name, Finish.PAINT, plate, added=True),
        *(Body(part.name, Finish.STEEL, head, added=True, whole=True) for head in heads),
    ]


def _bolted(z0: float, z1: float) -> list[float]:
    """Where bolts stand along a foot: one on a short foot, two on a long one."""
    return [(z0 + z1) / 2] if z1 - z0 < 0.06 else [z0 + 0.2 * (z1 - z0), z1 - 0.2 * (z1 - z0)]


def fittings(o: Outlines) -> list[Body]:
    """Terminal box and lifting eye, on the housing or, without one, on the laminations."""
    around = [p for p in o.parts(th.Role.HOUSING) if _pipe(o, p) is None and p.span[1] - p.span[0] > 0.3 * _length(o)]
    carrier = next(iter(around or o.parts(th.Role.IRON)), None)
    if carrier is None:
        return []
    reach = o.reach(carrier)
    # Of the wall from which fins rise: what half of all rays are inside (m)
    outline = np.asarray(o.of(carrier.prisms[0]).exterior.coords)
    inner = min(float(np.hypot(*outline.T[:2]).min()), reach)
    z0, z1 = carrier.span
    return [*_terminal_box(carrier, reach, inner, (z0, z1)), *_eye(carrier, reach, inner, (z0 + z1) / 2)]


def _length(o: Outlines) -> float:
    spans = [p.span for p in o.parts(th.Role.END_SHIELD)] or [p.span for p in o.machine.parts]
    return max(b for _, b in spans) - min(a for a, _ in spans)


def _terminal_box(part: th.Part, reach: float, inner: float, span: tuple[float, float]) -> list[Body]:
    """A box on a neck, a lid with four screws, two cable glands with a piece of cable."""
    wide, long, high = 0.52 * reach, min(0.7 * reach, 0.42 * (span[1] - span[0])), 0.26 * reach
    z = span[0] + 0.5 * (span[1] - span[0])
    foot, lid = reach - inner + 0.06 * reach, 0.16 * high
    shapes = [
        (Finish.PAINT, box(0.7 * wide, 0.8 * long, foot, 0.001).outward(BOX_ANGLE, inner - 0.02 * reach, z)),
        (Finish.PAINT, box(wide, long, high, 0.03 * reach).outward(BOX_ANGLE, inner - 0.02 * reach + foot, z)),
    ]
    top = inner - 0.02 * reach + foot + high
    shapes.append((Finish.PAINT, box(1.04 * wide, 1.04 * long, lid, 0.012 * reach).outward(BOX_ANGLE, top, z)))
    for i in (-1, 1):
        for j in (-1, 1):
            head = bolt(0.022 * reach).moved((0.45 * i * wide, 0.45 * j * long, 0.0))
            shapes.append((Finish.STEEL, head.outward(BOX_ANGLE, top + lid, z)))
        shapes += _gland(0.062 * reach, (0.5 * wide, 0.24 * i * long, 0.5 * high), top - high, z)
    return [Body(part.name, finish, shape, added=True, whole=True) for finish, shape in shapes]


def _gland(radius: float, at: tuple[float, float, float], height: float, z: float) -> list[tuple[Finish, Shape]]:
    """A nut and a cable that leaves the box sideways and hangs down; `at` (m) on the box's side."""
    nut = extruded(hexagon(1.3 * radius), 0.0, 1.2 * radius, 0.1 * radius)
    t = np.linspace(0.0, np.pi / 3, 10)
    path = np.stack([5 * radius * np.sin(t), np.zeros_like(t), -5 * radius * (1 - np.cos(t))], axis=1)
    cable = swept(path, np.tile([0.0, 1.0, 0.0], (len(t), 1)), oval(1.3 * radius, 1.3 * radius, 16, 2.0))
    aside = nut.placed((0.0, 0.0, -1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), at)
    return [
        (Finish.BRASS, aside.mirrored().outward(BOX_ANGLE, height, z)),
        (Finish.RUBBER, cable.moved(at).mirrored().outward(BOX_ANGLE, height, z)),
    ]


def _eye(part: th.Part, reach: float, inner: float, z: float) -> list[Body]:
    """A lifting eye on top (ISO 3266, about)."""
    ring, thick = 0.085 * reach, 0.024 * reach
    t = 2 * np.pi * np.arange(36) / 36
    path = np.stack([ring * np.cos(t), np.zeros_like(t), ring * np.sin(t)], axis=1)
    eye = swept(path, path / ring, oval(2 * thick, 2 * thick, 14, 2.0), shut=True).moved((0.0, 0.0, ring + thick))
    neck = rod(1.6 * thick, reach - inner + 1.5 * thick, 0.2 * thick)
    return [
        Body(part.name, Finish.STEEL, eye.outward(np.pi / 2, reach + thick, z), added=True, whole=True),
        Body(part.name, Finish.STEEL, neck.outward(np.pi / 2, inner, z), added=True, whole=True),
    ]
