"""[outlines] of a machine file: shapes in the plane that no parameter of a family describes, each repeated around."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from geom.description.profile import ArcGrid, Loop, Profile, edges
from geom.errors import InputError

LONGEST_MM = 1e4  # of a coordinate: a wind generator is 5 m wide
MOST_POINTS = 2000  # of one shape, and of shapes in a group: a slot drawn by hand has some ten
MOST_COPIES = 400  # around the axis
OVERLAP = 1e-9  # m2; a common area below this is rounding
INSET = 0.02  # of the radial depth of conductors: so far inside it end turns stay, clear of arcs that touch a circle
NOTHING = 1e-10  # m2; of what is left of a shape whose sides coincide
CROSSED = 0.01  # of a shape's area; chords of arcs that touch cross by less
_RIGHT = "a list of shapes, each a list of at least two points [x, y] or [x, y, bulge] in mm"


@dataclass(frozen=True)
class Outline:
    """Loops (m) as drawn around +x, and how often they stand around the axis."""

    copies: int
    loops: tuple[Loop, ...]

    def around(self) -> list[Profile]:
        """Every copy, as profiles."""
        angles = [2 * math.pi * k / self.copies for k in range(self.copies)]
        return [Profile(loop).rotated(angle) for angle in angles for loop in self.loops]


Outlines = Mapping[str, tuple[Outline, ...]]


def read_outlines(names: Mapping[str, str], table: Any, where: str) -> dict[str, tuple[Outline, ...]]:
    """The groups of shapes of a file, () where it has none of a name.  names : those the family knows, with meanings

    Raises InputError for unknown names, shapes that are no lists of points, and numbers that no machine has.
    """
    for name, groups in table.items():
        place = f"{where} [[outlines.{name}]]"
        if name not in names:
            listed = ", ".join(f"{key} ({words})" for key, words in names.items()) or "none: this family draws its own"
            raise InputError(f"unknown shapes {name!r}", f"{where} [outlines]", f"known: {listed}")
        if not isinstance(groups, list) or not all(isinstance(group, Mapping) for group in groups):
            raise InputError(f"{name} is not a list of tables", place, "copies = 48, loops_mm = [[[x, y], ...]]")
    return {name: tuple(_group(g, f"{where} [[outlines.{name}]]") for g in table.get(name, ())) for name in names}


def _group(group: Mapping[str, Any], where: str) -> Outline:
    for key in group:
        if key not in ("copies", "loops_mm"):
            raise InputError(f"unknown key {key!r}", where, "known: copies, loops_mm")
    copies, loops = group.get("copies"), group.get("loops_mm")
    if isinstance(copies, bool) or not isinstance(copies, int) or not 1 <= copies <= MOST_COPIES:
        raise InputError(f"copies = {str(copies)[:40]} is not possible", where, f"an integer from 1 to {MOST_COPIES}")
    if not isinstance(loops, list) or not 1 <= len(loops) <= MOST_POINTS:
        raise InputError("loops_mm is not possible", where, _RIGHT)
    return Outline(copies, tuple(_loop(loop, f"{where} loops_mm, shape {k + 1}") for k, loop in enumerate(loops)))


def _loop(points: Any, where: str) -> Loop:
    if not isinstance(points, list) or not 2 <= len(points) <= MOST_POINTS:
        raise InputError("is not a shape", where, _RIGHT)
    for point in points:
        numbers = isinstance(point, list) and len(point) in (2, 3)
        if not numbers or not all(isinstance(x, int | float) and abs(x) <= LONGEST_MM for x in point):
            raise InputError(f"{str(point)[:60]} is not a point", where, f"{_RIGHT}, up to {LONGEST_MM:g} mm")
    return tuple((1e-3 * p[0], 1e-3 * p[1], float(p[2]) if len(p) == 3 else 0.0) for p in points)


def refuse_cuts(outlines: Outlines, paths: tuple[str, ...]) -> None:
    """InputError for a shape that crosses itself, or cuts its neighbour or another one of its name.

    paths : names whose shapes are open, and are closed by a circle around the axis
    """
    import shapely

    for name, groups in outlines.items():
        profiles = [profile for group in groups for profile in group.around()[: 2 * len(group.loops)]]
        if name in paths:
            profiles = [Profile(_closed(profile.outer)) for profile in profiles]
        elif any(profile.area < NOTHING for profile in profiles):
            raise InputError("a shape has no area", f"[[outlines.{name}]]", "points around an area, in order")
        grid = ArcGrid(profiles)
        shapes = np.array([profile.to_polygon(grid) for profile in profiles], dtype=object)
        place = f"[[outlines.{name}]]"
        whole = shapely.buffer(shapes, 0.0)
        if (abs(shapely.area(whole) - shapely.area(shapes)) > CROSSED * shapely.area(shapes)).any():
            raise InputError("a shape crosses itself", place, "its points in order, once around")
        tree = shapely.STRtree(whole)
        for i, j in zip(*tree.query(whole)):
            if i < j and (area := shapely.intersection(whole[i], whole[j]).area) > OVERLAP:
                right = f"shapes apart: {groups[0].copies} around leave {360 / groups[0].copies:.4g} degrees for each"
                raise InputError(f"a shape cuts its neighbour by {area * 1e6:.3g} mm2", place, right)


def _closed(path: Loop) -> Loop:
    """An open shape, from its end back to its beginning along a circle."""
    sweep = (_angle(path[-1]) - _angle(path[0])) % (2 * math.pi)
    return (*path[:-1], (*path[-1][:2], -math.tan(sweep / 4)))


def radii(groups: tuple[Outline, ...]) -> list[float]:
    """Distances from the axis of corners and points of arcs, and of straight edges where they are nearest (m)."""
    out = []
    for loop in (loop for group in groups for loop in group.loops):
        for ((x, y, _), arc), end in zip(edges(loop), loop[1:]):
            out += [math.hypot(x, y), math.hypot(*end[:2])]
            if arc is not None:
                out += [math.hypot(*arc.at(arc.start + arc.sweep * share)) for share in (0.25, 0.5, 0.75)]
                continue
            a, way = complex(x, y), complex(*end[:2]) - complex(x, y)
            foot = -(a.conjugate() * way).real / max(abs(way) ** 2, NOTHING)
            out += [abs(a + foot * way)] if 0.0 < foot < 1.0 else []
    return out


def notched_loop(radius: float, groups: tuple[Outline, ...]) -> Loop:
    """A circle (m) with open shapes cut into it: each begins and ends on the circle, anticlockwise."""
    paths = sorted((p.outer for group in groups for p in group.around()), key=lambda path: _angle(path[0]))
    if not paths:
        return (radius, 0.0, 1.0), (-radius, 0.0, 1.0)
    out: list[tuple[float, float, float]] = []
    ends = [(_angle(path[0]), _angle(path[0]) + (_angle(path[-1]) - _angle(path[0])) % (2 * math.pi)) for path in paths]
    for path, (start, end), (following, _) in zip(paths, ends, [*ends[1:], (ends[0][0] + 2 * math.pi, 0.0)]):
        out.append((radius * math.cos(start), radius * math.sin(start), path[0][2]))
        out += path[1:-1]
        if following - end > 1e-7:
            out.append((radius * math.cos(end), radius * math.sin(end), math.tan((following - end) / 4)))
    return tuple(a for a, b in pairwise([*out, out[0]]) if math.dist(a[:2], b[:2]) > 1e-9)


def _angle(point: tuple[float, float, float]) -> float:
    return math.atan2(point[1], point[0])
