"""Closed surfaces from what they are drawn of: revolved, extruded with rounded edges, swept; balls, boxes and bolts."""

import numpy as np
import shapely
from shapely import Polygon, box as rectangle
from shapely.geometry.polygon import orient

from extras.portraits.shape import Shape, joined
from thermoscope import plugin as th

SECTIONS = 120  # of a full turn: a silhouette of 0.2 m then shows no corners at 1280 pixels
CORNER = 4  # pieces of a rounded corner
AXIS = 1e-7  # m; nearer to the axis than this is on it


def rounded(polygon: Polygon, convex: float, concave: float = 0.0) -> Polygon:
    """With its corners rounded (m), outer ones and those that point inwards; unchanged where that takes too much."""
    out = polygon
    if concave > 0:
        out = out.buffer(concave, quad_segs=CORNER).buffer(-concave, quad_segs=CORNER)
    if convex > 0:
        out = out.buffer(-convex, quad_segs=CORNER).buffer(convex, quad_segs=CORNER)
    out = out.simplify(2e-5)
    fits = out.geom_type == "Polygon" and out.is_valid and out.area > 0.8 * polygon.area
    return out if fits else polygon


def revolved(section: Polygon, sections: int = SECTIONS) -> Shape:
    """A section, radius and place along the axis (m), turned about the machine's axis."""
    section = orient(section)
    rings = [np.asarray(ring.coords)[:-1] for ring in (section.exterior, *section.interiors)]
    return joined([_turned(ring, sections) for ring in rings])


def _turned(ring: th.Array, sections: int) -> Shape:
    """One closed line of radius and place, turned: points on the axis are one point each."""
    n, angle = len(ring), 2 * np.pi * np.arange(sections) / sections
    r, z = ring.T
    points = np.stack([np.outer(np.cos(angle), r), np.outer(np.sin(angle), r), np.tile(z, (sections, 1))], axis=-1)
    i, j = np.meshgrid(np.arange(sections), np.arange(n), indexing="ij")
    a, b = i * n + j, i * n + (j + 1) % n
    c, d = (i + 1) % sections * n + j, (i + 1) % sections * n + (j + 1) % n
    number = np.arange(sections * n).reshape(sections, n)
    number[:, r < AXIS] = number[0, r < AXIS]
    triangles = number.ravel()[np.concatenate([np.stack([a, c, d], -1), np.stack([a, d, b], -1)]).reshape(-1, 3)]
    distinct = (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)
    return Shape(points.reshape(-1, 3), triangles[distinct])


def extruded(outline: Polygon, z0: float, z1: float, round_m: float = 0.0) -> Shape:
    """An outline between two planes (m); its edges there are rounded off by `round_m` where it is wide enough."""
    outline = orient(outline)
    rings = [np.asarray(ring.coords)[:-1, :2] for ring in (outline.exterior, *outline.interiors)]
    angle = np.linspace(0.0, np.pi / 2, CORNER)
    steps = [(round_m * (1 - np.sin(a)), round_m * (1 - np.cos(a))) for a in angle] if round_m > 0 else [(0.0, 0.0)]
    steps = [*steps, *((inset, z1 - z0 - up) for inset, up in steps[::-1])]
    insets = [_inset(ring) for ring in rings]
    first, *holes = [ring - round_m * by for ring, by in zip(rings, insets, strict=True)]
    end = Polygon(first, holes)
    inside_out = not end.exterior.is_ccw or any(hole.is_ccw for hole in end.interiors)
    if round_m > 0 and (2 * round_m > z1 - z0 or inside_out or not end.is_valid or end.area < 0.3 * outline.area):
        return extruded(outline, z0, z1, round_m / 2 if round_m > 1e-4 else 0.0)
    layers = [[ring - inset * by for ring, by in zip(rings, insets, strict=True)] for inset, _ in steps]
    heights = [z0 + up for _, up in steps]
    return _stacked(layers, heights, end)


def _inset(ring: th.Array) -> th.Array:
    """(n, 2) how far each corner moves when all sides move outwards by one; less at sharp corners."""
    along = np.roll(ring, -1, axis=0) - ring
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    out = np.stack([along[:, 1], -along[:, 0]], axis=1)  # of the side that leaves the corner
    before = np.roll(out, 1, axis=0)
    middle = out + before
    return middle / np.maximum((middle * out).sum(axis=1, keepdims=True), 0.5)


def _stacked(layers: list[list[th.Array]], heights: list[float], end: Polygon) -> Shape:
    sizes = [len(ring) for ring in layers[0]]
    total = sum(sizes)
    points = np.concatenate(
        [np.column_stack([np.concatenate(rings), np.full(total, z)]) for rings, z in zip(layers, heights, strict=True)]
    )
    following = np.concatenate(
        [s + (np.arange(n) + 1) % n for s, n in zip(np.cumsum([0, *sizes[:-1]]), sizes, strict=True)]
    )
    here = np.arange(total)
    near, far = [here, following, following + total], [here, following + total, here + total]
    side = np.concatenate([np.stack(near, 1), np.stack(far, 1)])
    sides = [side + k * total for k in range(len(heights) - 1)]
    lid = filled(end)
    return Shape(points, np.concatenate([*sides, lid[:, ::-1], lid + total * (len(heights) - 1)]))


def filled(outline: Polygon) -> th.Ints:
    """Triangles that fill an outline, by the numbers of its corners: outer ring, then holes; anticlockwise."""
    rings = [np.asarray(ring.coords)[:-1, :2] for ring in (outline.exterior, *outline.interiors)]
    number = {tuple(p): i for i, p in enumerate(np.concatenate(rings).tolist())}
    pieces = shapely.constrained_delaunay_triangles(outline).geoms
    corners = np.array([[number[tuple(c)] for c in list(piece.exterior.coords)[:3]] for piece in pieces])
    a, b, c = np.concatenate(rings)[corners].transpose(1, 0, 2)
    left = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] > 0
    return np.asarray(np.where(left[:, None], corners, corners[:, ::-1]), np.int64)


def swept(path: th.Array, across: th.Array, section: th.Array, shut: bool = False) -> Shape:
    """A section along a line; its own x along `across` (n, 3), its y square to that and to the line.

    path : (n, 3) m;  section : (m, 2) m, anticlockwise and convex;  shut : the line's end meets its start
    """
    n, m = len(path), len(section)
    along = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0) if shut else np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    x = across - (across * along).sum(axis=1, keepdims=True) * along
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y = np.cross(along, x)
    points = path[:, None] + section[None, :, :1] * x[:, None] + section[None, :, 1:] * y[:, None]
    i, j = np.meshgrid(np.arange(n if shut else n - 1), np.arange(m), indexing="ij")
    a, b = i * m + j, i * m + (j + 1) % m
    c, d = (i + 1) % n * m + j, (i + 1) % n * m + (j + 1) % m
    triangles = np.concatenate([np.stack([a, b, d], -1), np.stack([a, d, c], -1)]).reshape(-1, 3)
    if not shut:
        fan = np.stack([np.zeros(m - 2, int), np.arange(1, m - 1), np.arange(2, m)], axis=1)
        triangles = np.concatenate([triangles, fan[:, ::-1], fan + (n - 1) * m])
    return Shape(points.reshape(-1, 3), triangles)


def oval(width: float, height: float, corners: int = 14, power: float = 3.0) -> th.Array:
    """(corners, 2) m, a rounded rectangle: a superellipse (Lame)."""
    t = 2 * np.pi * (np.arange(corners) + 0.5) / corners
    c, s = np.cos(t), np.sin(t)
    return (
        np.stack([np.sign(c) * np.abs(c) ** (2 / power) * width, np.sign(s) * np.abs(s) ** (2 / power) * height], 1) / 2
    )


def ball(radius: float) -> Shape:
    t = np.linspace(-np.pi / 2, np.pi / 2, 13)
    return revolved(Polygon(radius * np.stack([np.cos(t) * (np.abs(t) < 1.57), np.sin(t)], axis=1)), 20)


def box(width: float, length: float, height: float, round_m: float) -> Shape:
    """Standing on its own origin: x and y from the middle, z up (m)."""
    flat = rectangle(-width / 2, -length / 2, width / 2, length / 2)
    return extruded(rounded(flat, min(2 * round_m, 0.3 * width, 0.3 * length)), 0.0, height, round_m)


def rod(radius: float, length: float, round_m: float = 0.0, sections: int = 24) -> Shape:
    """A round bar along z from its own origin (m)."""
    k = round_m
    return revolved(Polygon([(0, 0), (radius, 0), (radius, length - k), (radius - k, length), (0, length)]), sections)


def hexagon(radius: float) -> Polygon:
    """Of a nut or a head, by the radius of its corners (m)."""
    t = np.pi / 3 * np.arange(6)
    return Polygon(radius * np.stack([np.cos(t), np.sin(t)], axis=1))


def bolt(thread: float) -> Shape:
    """Hexagon head on a washer, z outwards (m): proportions of ISO 4017 and ISO 7089."""
    head = hexagon(1.5 * thread / np.sqrt(3))
    washer = rod(1.1 * thread, 0.16 * thread)
    return joined([washer, extruded(head, 0.16 * thread, 0.8 * thread, 0.06 * thread)])
