"""Drawings (.dxf): lines and arcs of every layer in metres around the machine's axis, and the loops they close."""

import cmath
import itertools
import math
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from geom.description.profile import Loop, Vertex, arc_between, loop_area
from geom.errors import InputError
from geom.limits import MACHINE_BYTES

RIGHT = "a drawing of the cross-section, saved by its program as DXF"
WELD = 5e-6  # m; ends nearer than this are one: a tenth of the thinnest liner
MOST_EDGES = 100_000  # a whole machine of 100 slots with every wire edges has half as many
FLAT = 2e-6  # m; by which chords leave a spline or an ellipse
UNITS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "inch": 0.0254}
_INSUNITS = {1: 0.0254, 2: 0.3048, 4: 1e-3, 5: 1e-2, 6: 1.0, 8: 2.54e-8, 9: 2.54e-5, 13: 1e-6, 14: 0.1}
_NOTE = re.compile(r"(?i)\b(stack_mm|units)\s*=\s*([\w.]+)")

Edge = tuple[complex, complex, float]  # from, to (m), and the bulge of the way between


@dataclass
class Drawing:
    """layers : name -> edges (m);  notes : what its texts say as KEY = VALUE;  others : kinds of entities left out"""

    path: Path
    unit: float = 0.0
    layers: dict[str, list[Edge]] = field(default_factory=lambda: defaultdict(list))
    notes: dict[str, str] = field(default_factory=dict)
    others: Counter[str] = field(default_factory=Counter)


def read_drawing(path: Path, units: str = "") -> Drawing:
    """Every line, arc and curve of the model space, blocks taken apart.

    units : of a drawing that does not say its own.  Raises InputError for a damaged file and for units that are none.
    """
    import ezdxf

    if not path.is_file():
        raise InputError("no such file", str(path), RIGHT)
    MACHINE_BYTES.check(path.stat().st_size, path, "holds")
    try:
        document = ezdxf.readfile(path)
        drawing = Drawing(path, _INSUNITS.get(int(document.header.get("$INSUNITS", 0)), 0.0))
        for _, entity in zip(range(MOST_EDGES), document.modelspace().query("TEXT MTEXT")):
            text = entity.plain_text() if entity.dxftype() == "TEXT" else entity.plain_text(split=False)
            drawing.notes |= {key.lower(): value for key, value in _NOTE.findall(text)}
        units = units or drawing.notes.get("units", "")
        if units and units not in UNITS:
            raise InputError(f"{units[:20]!r} is not a unit of a drawing", str(path), f"one of: {', '.join(UNITS)}")
        drawing.unit = drawing.unit or UNITS.get(units, 0.0)
        if not drawing.unit:
            right = f"--units, one of: {', '.join(UNITS)}; or a text units = mm in the drawing"
            raise InputError("the drawing does not say its units ($INSUNITS)", str(path), right)
        for count, (layer, edge) in enumerate(_edges(document.modelspace(), drawing)):
            if count >= MOST_EDGES:
                raise InputError("has too many lines", str(path), f"up to {MOST_EDGES:,}, blocks taken apart")
            drawing.layers[layer].append(edge)
    except InputError:
        raise
    except (ezdxf.DXFError, OSError, ValueError, LookupError, TypeError, AttributeError, ArithmeticError) as fault:
        raise InputError(f"not readable as DXF: {str(fault)[:80]}", str(path), RIGHT) from None
    except RecursionError:
        raise InputError("its blocks hold each other", str(path), RIGHT) from None
    return drawing


def _edges(entities: Iterable[Any], drawing: Drawing, outer: str = "0") -> Iterator[tuple[str, Edge]]:
    """Edges with their layer.  outer : the layer of the block around them, which those on layer 0 have"""
    for entity in entities:
        layer, kind = entity.dxf.layer if entity.dxf.layer != "0" else outer, entity.dxftype()
        if kind == "INSERT":
            for block in entity.multi_insert() if entity.mcount > 1 else (entity,):
                yield from _edges(block.virtual_entities(), drawing, layer)
        elif kind in ("LWPOLYLINE", "POLYLINE"):
            yield from _edges(entity.virtual_entities(), drawing, layer)
        elif kind in ("SPLINE", "ELLIPSE"):
            points = [_point(p, drawing) for p in entity.flattening(FLAT / drawing.unit)]
            yield from ((layer, (a, b, 0.0)) for a, b in itertools.pairwise(points))
        elif kind == "LINE":
            yield layer, (_point(entity.dxf.start, drawing), _point(entity.dxf.end, drawing), 0.0)
        elif kind == "ARC":
            sweep = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360)
            bulge = math.copysign(math.tan(sweep / 4), entity.dxf.extrusion.z)
            yield layer, (_point(entity.start_point, drawing), _point(entity.end_point, drawing), bulge)
        elif kind == "CIRCLE":
            a, b = (_point(p, drawing) for p in entity.vertices((0, 180)))
            yield from ((layer, (a, b, 1.0)), (layer, (b, a, 1.0)))
        elif kind not in ("TEXT", "MTEXT"):
            drawing.others[kind] += 1


def _point(vector: Any, drawing: Drawing) -> complex:
    point = complex(vector.x, vector.y) * drawing.unit
    if not cmath.isfinite(point) or abs(point) > 1e3:
        raise InputError(f"a point lies at {point:.3g} m", str(drawing.path), "a drawing of a machine, and its units")
    return point


def axis_of(edges_of_iron: Iterable[Edge]) -> complex:
    """The centre of the longest arc, 0 where there is none or it is there already."""
    arcs = [arc_between((a.real, a.imag, bulge), _vertex(b)) for a, b, bulge in edges_of_iron if bulge]
    if not arcs:
        return 0j
    longest = max(arcs, key=lambda arc: arc.radius * abs(arc.sweep))
    centre = complex(longest.x, longest.y)
    return centre if abs(centre) > WELD else 0j


def _vertex(z: complex) -> Vertex:
    return z.real, z.imag, 0.0


def middle(edge: Edge) -> complex:
    """The point half way along."""
    a, b, bulge = edge
    return along(edge, 0.5) if bulge else (a + b) / 2


def along(edge: Edge, share: float) -> complex:
    """The point at a share of the way."""
    a, b, bulge = edge
    if not bulge:
        return a + share * (b - a)
    arc = arc_between((a.real, a.imag, bulge), _vertex(b))
    return complex(*arc.at(arc.start + share * arc.sweep))


def piece(edge: Edge, start: float, end: float) -> Edge:
    """From one share of the way to another."""
    return along(edge, start), along(edge, end), math.tan(math.atan(edge[2]) * (end - start))


def turned(edge: Edge, angle: float) -> Edge:
    turn = cmath.exp(1j * angle)
    return edge[0] * turn, edge[1] * turn, edge[2]


def sector_of(iron: Sequence[Edge], where: str) -> tuple[int, float]:
    """How often what is edges stands around the axis, and the angle (rad) at which it begins; InputError for others."""
    points = (along(edge, float(share)) for edge in iron for share in np.linspace(0, 1, 129))
    angles = sorted({cmath.phase(z) for z in points if abs(z) > WELD})
    if not angles:
        raise InputError("has no lines", where, RIGHT)
    gap, start = max((b - a, b) for a, b in itertools.pairwise([*angles, angles[0] + 2 * math.pi]))
    if gap < math.radians(3):  # what a sector of half the machine leaves is 180 degrees; a step along a circle is 2.8
        return 1, 0.0
    count = 2 * math.pi / (2 * math.pi - gap)
    if abs(count - round(count)) > 0.005 * count:
        what = f"it spans {360 / count:.5g} degrees, {count:.4g} times in a turn"
        raise InputError(what, where, "one slot or pole pitch, several, or the whole machine, around its axis")
    return round(count), start


def whole_turn(edges: Iterable[Edge], copies: int, start: float, cut: bool) -> list[Edge]:
    """What stands around the axis.  cut : without the lines along both ends of the sector"""
    pitch = 2 * math.pi / copies
    sides = [cmath.exp(-1j * (start + k * pitch)) for k in (0, 1)]

    def on_ray(z: complex, side: complex) -> bool:
        return (z * side).real > -WELD and abs((z * side).imag) < WELD

    def is_cut(edge: Edge) -> bool:
        return not edge[2] and any(on_ray(edge[0], side) and on_ray(edge[1], side) for side in sides)

    rest = [edge for edge in edges if copies == 1 or not cut or not is_cut(edge)]
    return [turned(edge, k * pitch) for k in range(copies) for edge in rest]


def loops_and_paths(
    edges: Sequence[Edge], where: str, paths: bool = False, seams: bool = False
) -> tuple[list[Loop], list[Loop]]:
    """What the edges enclose as loops, anticlockwise, each without others inside it; and paths that stay open.

    paths : whether these may be;  seams : whether a radius between two other edges divides what is one
    Raises InputError with the point where an outline is open.
    """
    every = _welded(edges)
    if seams:
        ends = Counter(z for edge in every for z in edge[:2])
        every = [edge for edge in every if not (_is_radial(edge) and min(ends[z] for z in edge[:2]) > 2)]
    ways = {(a, b, bulge) for edge in every for a, b, bulge in (edge, reverse(edge))}
    leaving: dict[complex, list[Edge]] = defaultdict(list)
    for way in ways:
        leaving[way[0]].append(way)
    for around in leaving.values():
        around.sort(key=_direction)
    unclosed: list[Loop] = []
    loose = [z for z, around in leaving.items() if len(around) == 1]
    for z in sorted(loose, key=lambda z: (abs(cmath.phase(z)), abs(z))):
        if not paths:
            right = f"two ends at every point, within {1e3 * WELD:g} mm of each other"
            raise InputError(f"an outline is open at x = {1e3 * z.real:.6g}, y = {1e3 * z.imag:.6g} mm", where, right)
        chain = [leaving[z][0]] if leaving[z][0] in ways else []
        while chain and len(rest := [w for w in leaving[chain[-1][1]] if w != reverse(chain[-1])]) == 1:
            chain.append(rest[0])
        if chain:
            ways -= {way for edge in chain for way in (edge, reverse(edge))}
            unclosed.append((*((a.real, a.imag, bulge) for a, _, bulge in chain), _vertex(chain[-1][1])))
    closed = []
    left = [way for edge in every for way in (edge, reverse(edge)) if way in ways]
    for first in left:  # around what lies on the left of a way: at every point the next one to the right
        if first not in ways:
            continue
        chain = [first]
        while True:
            around = leaving[chain[-1][1]]
            following = around[around.index(reverse(chain[-1])) - 1]
            if following == chain[0]:
                break
            chain.append(following)
        ways -= set(chain)
        closed.append(tuple((a.real, a.imag, bulge) for a, _, bulge in chain))
    return [loop for loop in closed if loop_area(loop) > WELD**2], unclosed


def reverse(edge: Edge) -> Edge:
    return edge[1], edge[0], -edge[2]


def _direction(edge: Edge) -> tuple[float, float]:
    """Angle (rad) at which it leaves; of two that leave together the one that turns left is further round."""
    a, b, bulge = edge
    angle = (cmath.phase(b - a) - 2 * math.atan(bulge)) % (2 * math.pi)
    return round(angle, 6) % round(2 * math.pi, 6), bulge / abs(b - a)


def _is_radial(edge: Edge) -> bool:
    """Along a radius?"""
    a, b, bulge = edge
    return not bulge and abs((a.conjugate() * b).imag) < WELD * abs(b - a)


def edges_of(loop: Loop) -> list[Edge]:
    """Of a closed loop, each with both ends."""
    return [(complex(*a[:2]), complex(*b[:2]), a[2]) for a, b in zip(loop, (*loop[1:], loop[0]))]


def _welded(edges: Sequence[Edge]) -> list[Edge]:
    """With one point for ends that nearly meet, circles around the axis as such, and nothing twice."""
    from geom.groups import near_groups

    if not edges:
        return []
    z = np.array([end for edge in edges for end in edge[:2]])
    group = near_groups(np.column_stack([z.real, z.imag]), WELD)
    node = (np.bincount(group, z.real) + 1j * np.bincount(group, z.imag)) / np.bincount(group)
    around = sorted((abs(edge[0]), k) for k, edge in enumerate(edges) if _is_concentric(edge))
    circle, last = 0.0, -1.0
    for radius, k in around:
        circle = circle if radius - last < WELD else round(radius, 9)
        last = radius
        for at in group[2 * k : 2 * k + 2]:
            node[at] *= circle / abs(node[at])
    concentric = {k for _, k in around}
    out: dict[Any, Edge] = {}
    for k, (_, _, bulge) in enumerate(edges):
        a, b = complex(node[group[2 * k]]), complex(node[group[2 * k + 1]])
        if a == b:
            continue
        if k in concentric:
            sweep = 4 * math.atan(bulge)
            bulge = math.tan((sweep + cmath.phase(b / a * cmath.exp(-1j * sweep))) / 4)
        half = middle((a, b, bulge)) / (4 * WELD)
        out.setdefault((frozenset((a, b)), round(half.real), round(half.imag)), (a, b, bulge))
    return list(out.values())


def _is_concentric(edge: Edge) -> bool:
    if not edge[2]:
        return False
    arc = arc_between((edge[0].real, edge[0].imag, edge[2]), _vertex(edge[1]))
    return math.hypot(arc.x, arc.y) < WELD and arc.radius > WELD
