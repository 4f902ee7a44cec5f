"""Arrangement of profiles in the plane: their edges cut where they meet, and which profiles lie on either side."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from geom.arrays import Array, Ints, Mask
from geom.description.profile import Loop, Profile, edges, loop_area
from geom.groups import near_groups

TOLERANCE = 1e-10  # m; points nearer than this are one, as in CAD files: above rounding at 10 m, below any gap


@dataclass(frozen=True)
class Curves:
    """Straight edges and arcs, as arrays over them.

    start, end : (n, 2) points (m);  centre (n, 2), radius (n,), angle (n,), sweep (n,) : of arcs; a sweep of 0 is a
    straight edge.  Arcs run anticlockwise and straight edges up, or right, so that edges on one line agree.
    """

    start: Array
    end: Array
    centre: Array
    radius: Array
    angle: Array
    sweep: Array

    @property
    def curved(self) -> Mask:
        return self.sweep > 0.0

    @property
    def boxes(self) -> Array:
        """(n, 4) bounds (m), a little wider than the curves."""
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        for quarter in range(4):
            passes = (quarter * math.pi / 2 - self.angle) % (2 * math.pi) <= self.sweep
            far = self.centre + self.radius[:, None] * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)][quarter])
            low = np.where((passes & self.curved)[:, None], np.minimum(low, far), low)
            high = np.where((passes & self.curved)[:, None], np.maximum(high, far), high)
        return np.hstack([low - TOLERANCE, high + TOLERANCE])

    def place(self, which: Ints, points: Array) -> Array:
        """How far along its curve (0 to 1) each point lies; nan where it is not on it."""
        along, off = np.where(self.curved[which], self._on_arc(which, points), self._on_line(which, points))
        length = np.where(self.curved, self.radius * self.sweep, np.linalg.norm(self.end - self.start, axis=1))[which]
        inside = (along > -TOLERANCE) & (along < length + TOLERANCE)
        return np.where((np.abs(off) < TOLERANCE) & inside, along / length, np.nan)

    def at(self, which: Ints, place: Array) -> Array:
        """(n, 2) points there."""
        angle = self.angle[which] + place * self.sweep[which]
        round_ = self.centre[which] + self.radius[which, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        straight = self.start[which] + place[:, None] * (self.end - self.start)[which]
        return np.where(self.curved[which, None], round_, straight)

    def _on_line(self, which: Ints, points: Array) -> Array:
        way, away = (self.end - self.start)[which], points - self.start[which]
        length = np.linalg.norm(way, axis=1)
        return np.stack([(way * away).sum(axis=1), way[:, 0] * away[:, 1] - way[:, 1] * away[:, 0]]) / length

    def _on_arc(self, which: Ints, points: Array) -> Array:
        x, y = (points - self.centre[which]).T
        radius, half = self.radius[which], self.sweep[which] / 2
        angle = np.arctan2(y, x) - self.angle[which] - half
        along = (angle + math.pi) % (2 * math.pi) - math.pi + half  # from the middle, so that both ends are near
        return np.stack([along * radius, np.hypot(x, y) - radius])


@dataclass(frozen=True)
class Arrangement:
    """points : (n, 2) where pieces meet (m);  pieces : (m, 2) points from which and to which each runs
    centre (m, 2), radius (m,), sweep (m,) : of arcs, which run anticlockwise; a sweep of 0 is a straight piece
    left, right : (m, k) whether profile k covers that side of it;  corners : (n, k) whether a point is one of its own
    """

    points: Array
    pieces: Ints
    centre: Array
    radius: Array
    sweep: Array
    left: Mask
    right: Mask
    corners: Mask


def arrangement(profiles: Sequence[Profile]) -> Arrangement:
    """All edges of the profiles, cut at each other's ends and where they cross; what coincides is there once."""
    curves, owner, inside_left = _curves(profiles)
    points, ends = _points(curves)
    curve, place, pieces = _cut(curves, points)
    middle = curves.at(curve, place)
    same = np.column_stack([np.sort(pieces, axis=1), near_groups(middle, TOLERANCE)])
    _, first, kind = np.unique(same, axis=0, return_index=True, return_inverse=True)
    kind = kind.ravel()
    left = np.zeros((len(first), len(profiles)), bool)
    right, corners = left.copy(), np.zeros((len(points), len(profiles)), bool)
    np.logical_or.at(left, (kind, owner[curve]), inside_left[curve])
    np.logical_or.at(right, (kind, owner[curve]), ~inside_left[curve])
    within = _within(profiles, middle[first], left | right)
    np.logical_or.at(corners, (ends, np.tile(owner, 2)), True)
    original = curve[first]
    a, b = (points[pieces[first, i]] - curves.centre[original] for i in (0, 1))
    angle = (np.arctan2(b[:, 1], b[:, 0]) - np.arctan2(a[:, 1], a[:, 0])) % (2 * math.pi)
    sweep = np.where(curves.curved[original], angle, 0.0)
    at = (curves.centre[original], curves.radius[original], sweep)
    return Arrangement(points, pieces[first], *at, left | within, right | within, corners)


def covers(loops: Iterable[Loop], points: Array) -> Mask:
    """(n,) whether the points (n, 2) (m) lie inside the loops (even-odd); on an edge either may be said.

    A ray crosses the chords; a point between an arc and its chord changes sides once more. A point on a chord is taken
    to lie a little above it, or right of an upright one, by both tests alike.
    """
    inside = np.zeros(len(points), bool)
    x, y = points.T
    for loop in loops:
        for (a, arc), b in zip(edges(loop), (*loop[1:], loop[0])):
            low, high = sorted((a[:2], b[:2]), key=lambda p: (p[1], p[0]))
            dx, dy = high[0] - low[0], high[1] - low[1]
            cross = dx * (y - low[1]) - dy * (x - low[0])
            leftwards = (cross > 0.0) | ((cross == 0.0) & (dx > 0.0))
            inside ^= (low[1] <= y) & (y < high[1]) & leftwards
            if arc is not None:
                disc = np.hypot(x - arc.x, y - arc.y) < arc.radius
                inside ^= disc & (leftwards == ((a[2] < 0.0) == (low == a[:2])))
    return inside


def _curves(profiles: Sequence[Profile]) -> tuple[Curves, Ints, Mask]:
    """All edges; the profile of each, and whether it has the profile on its left."""
    rows, owner, inside_left = [], [], []
    for k, profile in enumerate(profiles):
        for loop in profile.loops:
            anticlockwise = (loop_area(loop) > 0.0) == (loop is profile.outer)
            for (a, arc), b in zip(edges(loop), (*loop[1:], loop[0])):
                row = (a[0], a[1], b[0], b[1], 0.0, 0.0, 1.0, 0.0, 0.0)
                if arc is not None:
                    row = (*row[:4], arc.x, arc.y, arc.radius, arc.start, arc.sweep)
                forward = arc.sweep > 0.0 if arc is not None else _upwards(*row[:4])
                rows.append(row if forward else _backward(row))
                owner.append(k)
                inside_left.append(forward == anticlockwise)
    table = np.array(rows)
    curves = Curves(table[:, :2], table[:, 2:4], table[:, 4:6], *table[:, 6:].T)
    return curves, np.array(owner), np.array(inside_left)


def _upwards(x0: float, y0: float, x1: float, y1: float) -> bool:
    flat = abs(y1 - y0) < 1e-6 * abs(x1 - x0)
    return x1 > x0 if flat else y1 > y0


def _backward(row: tuple[float, ...]) -> tuple[float, ...]:
    x0, y0, x1, y1, x, y, radius, start, sweep = row
    return x1, y1, x0, y0, x, y, radius, start + sweep, -sweep


def _points(curves: Curves) -> tuple[Array, Ints]:
    """Ends and crossings, nearly equal ones made one; which point every start, then every end, is."""
    crossings = _crossings(curves)
    loose = np.concatenate([curves.start, curves.end, crossings])
    which = near_groups(loose, TOLERANCE)
    _, first = np.unique(which, return_index=True)
    return loose[first], which[: 2 * len(curves.start)]


def _crossings(curves: Curves) -> Array:
    boxes = shapely.box(*curves.boxes.T)
    i, j = shapely.STRtree(boxes).query(boxes)
    i, j = i[i < j], j[i < j]
    swap = curves.curved[i] & ~curves.curved[j]
    i, j = np.where(swap, j, i), np.where(swap, i, j)  # straight ones first
    arcs = curves.curved[i].astype(int) + curves.curved[j]
    meetings = [meet(curves, i[arcs == n], j[arcs == n]) for n, meet in enumerate((_lines, _line_circle, _circles))]
    first, second, points = (np.concatenate(x) for x in zip(*meetings))
    on_both = ~np.isnan(curves.place(first, points)) & ~np.isnan(curves.place(second, points))
    return points[on_both]


Meeting = tuple[Ints, Ints, Array]  # pairs of curves and a point on both lines or circles


def _lines(curves: Curves, i: Ints, j: Ints) -> Meeting:
    r, s, offset = (curves.end - curves.start)[i], (curves.end - curves.start)[j], curves.start[j] - curves.start[i]
    across = r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0]
    skew = np.abs(across) > 1e-9 * np.linalg.norm(r, axis=1) * np.linalg.norm(s, axis=1)
    i, j, r, s, offset, across = i[skew], j[skew], r[skew], s[skew], offset[skew], across[skew]
    place = (offset[:, 0] * s[:, 1] - offset[:, 1] * s[:, 0]) / across
    return i, j, curves.start[i] + place[:, None] * r


def _line_circle(curves: Curves, i: Ints, j: Ints) -> Meeting:
    way = (curves.end - curves.start)[i]
    way = way / np.linalg.norm(way, axis=1)[:, None]
    foot = curves.start[i] + ((curves.centre[j] - curves.start[i]) * way).sum(axis=1)[:, None] * way
    return _both_sides(i, j, foot, way, np.linalg.norm(foot - curves.centre[j], axis=1), curves.radius[j])


def _circles(curves: Curves, i: Ints, j: Ints) -> Meeting:
    offset = curves.centre[j] - curves.centre[i]
    distance = np.linalg.norm(offset, axis=1)
    i, j, offset, distance = (x[distance > TOLERANCE] for x in (i, j, offset, distance))
    axis = offset / distance[:, None]
    along = (curves.radius[i] ** 2 - curves.radius[j] ** 2 + distance**2) / (2 * distance)
    foot = curves.centre[i] + along[:, None] * axis
    return _both_sides(i, j, foot, axis @ np.array([(0.0, 1.0), (-1.0, 0.0)]), np.abs(along), curves.radius[i])


def _both_sides(i: Ints, j: Ints, foot: Array, way: Array, distance: Array, radius: Array) -> Meeting:
    """The points of a chord's line on a circle: either side of the foot of the perpendicular, which touches or cuts."""
    near = distance < radius + TOLERANCE
    half = np.sqrt(np.maximum(radius**2 - distance**2, 0.0))[near, None] * way[near]
    return np.tile(i[near], 2), np.tile(j[near], 2), np.concatenate([foot[near] - half, foot[near] + half])


def _cut(curves: Curves, points: Array) -> tuple[Ints, Array, Ints]:
    """Pieces between neighbouring points of a curve: its number, the place of their middles, and their two points."""
    point, curve = shapely.STRtree(shapely.box(*curves.boxes.T)).query(shapely.points(points))
    place = curves.place(curve, points[point])
    on = ~np.isnan(place)
    order = np.lexsort((place[on], curve[on]))
    curve, point, place = curve[on][order], point[on][order], place[on][order]
    follows = curve[1:] == curve[:-1]
    pieces = np.column_stack([point[:-1], point[1:]])[follows]
    return curve[1:][follows], (place[1:] + place[:-1])[follows] / 2, pieces


def _within(profiles: Sequence[Profile], points: Array, on: Mask) -> Mask:
    """(m, k) whether a point lies inside a profile whose edge it is not on."""
    inside = np.zeros_like(on)
    for k, profile in enumerate(profiles):
        x0, y0, x1, y1 = profile.bounds
        x, y = points.T
        near = np.flatnonzero(~on[:, k] & (x > x0) & (x < x1) & (y > y0) & (y < y1))
        inside[near, k] = covers(profile.loops, points[near])
    return inside
