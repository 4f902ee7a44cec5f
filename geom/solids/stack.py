"""Prisms stacked on one another as exact solids: their common boundary, read off their sections.

The boundary of a section is drawn up into walls; where the sections below and above a level differ there is a floor or
a ceiling. Straight edges become planes, arcs cylinders. Nothing is intersected in space, and nothing is approximated.
"""

import math
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from OCP.Geom import Geom_Circle, Geom_CylindricalSurface, Geom_Plane, Geom_Surface

from geom.description.part import Prism
from geom.groups import joined_groups
from geom.solids.brep import Boundary, Oriented, axes, line, line_2d
from geom.solids.sections import Region, Run, Sections

if TYPE_CHECKING:
    import cadquery as cq

mm = 1e3
Key = tuple[str, int, int]  # of an edge


@dataclass(frozen=True)
class _Face:
    """A face, the keys of its edges, and what it adds to the volume (mm3)."""

    face: Any
    edges: tuple[Key, ...]
    volume: float = 0.0


def stacked(prisms: Sequence[Prism]) -> "list[cq.Solid]":
    """Exact solids (mm) of prisms (m) that may touch but not overlap, touching ones made one."""
    stack = _Stack(prisms)
    shells = _shells(stack.walls() + stack.floors())
    outer = [stack.make.solid([stack.make.shell(s)]) for s, volume in shells if volume > 0.0]
    for faces, _ in (pair for pair in shells if pair[1] < 0.0):
        void = stack.make.shell(faces)
        holder = 0 if len(outer) == 1 else _holder(outer, void)
        outer[holder] = stack.make.solid([*(shell.wrapped for shell in outer[holder].Shells()), void])
    return outer


def _shells(faces: list[_Face]) -> list[tuple[list[Any], float]]:
    """Faces that hang together by edges of two, and the volume they enclose; a void's is negative."""
    of: dict[Key, list[int]] = defaultdict(list)
    for i, face in enumerate(faces):
        for key in face.edges:
            of[key].append(i)
    pairs = np.array([pair for pair in of.values() if len(pair) == 2])
    which = joined_groups(len(faces), pairs)
    volume = np.bincount(which, [face.volume for face in faces])
    members: list[list[Any]] = [[] for _ in volume]
    for face, i in zip(faces, which):
        members[i].append(face.face)
    return list(zip(members, volume.tolist()))


def _holder(outer: "list[cq.Solid]", void: Any) -> int:
    """Which solid a void is in."""
    import cadquery as cq

    inside = cq.Shape.cast(void).Vertices()[0].Center()
    return next(i for i, solid in enumerate(outer) if solid.isInside(inside))


class _Stack:
    """The faces of all sections, with the edges that they share."""

    def __init__(self, prisms: Sequence[Prism]) -> None:
        self.of = Sections(prisms)
        self.points, self.centres = (mm * self.of.plane.points).tolist(), (mm * self.of.plane.centre).tolist()
        self.radii = (mm * self.of.plane.radius).tolist()
        self.make = Boundary()
        self.vertices: dict[tuple[int, int], Any] = {}
        self.edges: dict[Key, Any] = {}

    def walls(self) -> list[_Face]:
        sections = range(len(self.of.levels) - 1)
        return [self._wall(run, section) for section in sections for run in self.of.runs(section)]

    def floors(self) -> list[_Face]:
        return [
            self._floor(region, level, ceiling)
            for level in range(len(self.of.levels))
            for ceiling in (True, False)
            for region in self.of.regions(level, ceiling)
        ]

    def _wall(self, run: Run, section: int) -> _Face:
        """Along u from left to right as seen from the right of the run, and up."""
        start, end = self.of.ends((run, True))
        bottom, top = (self._across(run, section + i) for i in (0, 1))
        left, right = (self._up(point, section) for point in (start, end))
        loop = [*((key, True) for key in bottom), (right, True), *((key, False) for key in top[::-1]), (left, False)]
        surface = self._surface(run, section)
        if self.of.sweep(run):
            self._lay(run, section, surface, [*bottom, *top], left, right)
        oriented = [(self.edges[key], forward) for key, forward in loop]
        outward = bool(self.of.left[section, run[0]])
        return _Face(self.make.face(surface, [oriented], outward), tuple(key for key, _ in loop))

    def _surface(self, run: Run, section: int) -> Geom_Surface:
        start, end = self.of.ends((run, True))
        x, y, z = self._place(start, section)
        if not self.of.sweep(run):
            dx, dy = self.points[end][0] - x, self.points[end][1] - y
            return Geom_Plane(axes((x, y, z), (dy, -dx, 0.0), (dx, dy, 0.0)))
        cx, cy = self.centres[run[0]]
        around = axes((cx, cy, z), (0.0, 0.0, 1.0), (x - cx, y - cy, 0.0))
        return Geom_CylindricalSurface(around, self.radii[run[0]])

    def _lay(self, run: Run, section: int, surface: Geom_Surface, level: list[Key], left: Key, right: Key) -> None:
        """Tells the edges of a cylinder how they run on it: angle from its start, height above its foot."""
        height = mm * (self.of.levels[section + 1] - self.of.levels[section])
        for key in level:
            _, first, at = key
            angle = self.of.angle(self.of.level_runs[at][first])
            rotation = (angle - self.of.angle(run) + 1e-6) % (2 * math.pi) - 1e-6  # rounding is no full turn
            self.make.lay(self.edges[key], line_2d(rotation - angle, height * (at - section), 1.0, 0.0), surface)
        for key, rotation in ((left, 0.0), (right, self.of.sweep(run))):
            self.make.lay(self.edges[key], line_2d(rotation, 0.0, 0.0, 1.0), surface)

    def _floor(self, region: Region, level: int, ceiling: bool) -> _Face:
        z = mm * self.of.levels[level]
        loops = [[(self._edge(run, level), forward) for run, forward in loop] for loop in region]
        plane = Geom_Plane(axes((0.0, 0.0, z), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)))
        oriented: list[list[Oriented]] = [[(self.edges[key], forward) for key, forward in loop] for loop in loops]
        face = self.make.face(plane, oriented, ceiling)
        volume = self.of.area(region) * mm**2 * z * (1 if ceiling else -1)
        return _Face(face, tuple(key for loop in loops for key, _ in loop), volume)

    def _place(self, point: int, level: int) -> tuple[float, float, float]:
        x, y = self.points[point]
        return x, y, mm * self.of.levels[level]

    def _vertex(self, point: int, level: int) -> Any:
        if (point, level) not in self.vertices:
            self.vertices[point, level] = self.make.vertex(self._place(point, level))
        return self.vertices[point, level]

    def _across(self, run: Run, level: int) -> list[Key]:
        """The edges on a level along a run of a section."""
        return [self._edge(part, level) for part in dict.fromkeys(self.of.level_runs[level][p] for p in run)]

    def _edge(self, run: Run, level: int) -> Key:
        key = ("across", run[0], level)
        if key not in self.edges:
            start, end = (self._vertex(point, level) for point in self.of.ends((run, True)))
            self.edges[key] = self.make.edge(*self._curve(run, level), start, end)
        return key

    def _curve(self, run: Run, level: int) -> tuple[Any, float, float]:
        if not self.of.sweep(run):
            return line(*(self._place(point, level) for point in self.of.ends((run, True))))
        x, y = self.centres[run[0]]
        around = axes((x, y, mm * self.of.levels[level]), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)).Ax2()
        first = self.of.angle(run)
        return Geom_Circle(around, self.radii[run[0]]), first, first + self.of.sweep(run)

    def _up(self, point: int, section: int) -> Key:
        """The upright edge at a point through a section."""
        key = ("up", point, section)
        if key not in self.edges:
            below, above = (self._vertex(point, section + i) for i in (0, 1))
            curve = line(*(self._place(point, section + i) for i in (0, 1)))
            self.edges[key] = self.make.edge(*curve, below, above)
        return key
