"""Sections of stacked prisms: between two neighbouring levels every prism is there or not."""

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cached_property

import numpy as np

from geom.arrays import Ints, Mask
from geom.description.part import Prism
from geom.description.profile import Loop, loop_area
from geom.solids.arrangement import arrangement, covers

_DIGITS = 7  # of a level (m); levels that agree in them are one
_CURVATURE = 1e-7  # rad m; how much a curvature counts where directions are the same
Run = tuple[int, ...]  # pieces of the arrangement in a row, with no corner between them
Half = tuple[Run, bool]  # a run, and whether it is walked as it runs
Region = list[list[Half]]  # its loops, the outer one first; it lies on the left of all


class Sections:
    """Prisms (m) that may touch but not overlap.

    plane : arrangement of their profiles;  levels : where prisms begin or end (m)
    left, right : (n_section, n_piece) whether the section covers that side of a piece
    edge : (n_section, n_piece) whether a piece bounds the section
    corner : (n_section, n_point) whether the section's boundary has a corner there
    """

    def __init__(self, prisms: Sequence[Prism]) -> None:
        profiles = {profile: i for i, profile in enumerate(dict.fromkeys(profile for profile, _, _ in prisms))}
        self.plane = arrangement(list(profiles))
        self._points, self._centres = self.plane.points.tolist(), self.plane.centre.tolist()
        self._pieces, self._sweeps = self.plane.pieces.tolist(), self.plane.sweep.tolist()
        exact = {round(z, _DIGITS): z for _, *span in prisms for z in span}
        level = {z: i for i, z in enumerate(sorted(exact))}
        self.levels = [exact[z] for z in level]
        there = np.zeros((len(self.levels) - 1, len(profiles)), bool)
        for profile, *span in prisms:
            start, end = (level[round(z, _DIGITS)] for z in span)
            there[start:end, profiles[profile]] = True
        self.left, self.right = there @ self.plane.left.T, there @ self.plane.right.T
        self.edge = self.left != self.right
        self.corner = there @ self.plane.corners.T | (self._valence(self.edge) > 2)

    def runs(self, section: int) -> list[Run]:
        """The section's boundary, from corner to corner."""
        return self._runs(self.edge[section], self.corner[section])

    @cached_property
    def level_runs(self) -> list[dict[int, Run]]:
        """Of each level, runs by their pieces: what bounds the section below or above, cut at the corners of both."""
        edge, corner = (_below(flags) | _above(flags) for flags in (self.edge, self.corner))
        corner |= self._valence(edge) > 2
        return [{p: run for run in self._runs(*row) for p in run} for row in zip(edge, corner)]

    def regions(self, level: int, ceiling: bool) -> list[Region]:
        """Where the section ends at a level: ceilings of what is below, or floors of what is above."""
        left, right = (
            (_below(side) & ~_above(side) if ceiling else _above(side) & ~_below(side))[level]
            for side in (self.left, self.right)
        )
        runs = dict.fromkeys(self.level_runs[level].values())
        loops = self._loops([(run, bool(left[run[0]])) for run in runs if left[run[0]] != right[run[0]]])
        areas = [self.area([loop]) for loop in loops]
        order = np.argsort(areas).tolist()
        regions = [[loops[i]] for i in order if areas[i] > 0.0]
        for i in order:
            if areas[i] < 0.0:
                regions[self._around(loops[i], [self.outline(outer) for outer, *_ in regions])].append(loops[i])
        return regions

    def ends(self, half: Half) -> tuple[int, int]:
        run, forward = half
        start, end = self._pieces[run[0]][0], self._pieces[run[-1]][1]
        return (start, end) if forward else (end, start)

    def sweep(self, run: Run) -> float:
        return sum([self._sweeps[p] for p in run])

    def angle(self, run: Run, end: int = 0) -> float:
        """Of its start, or its end (1), seen from its centre (rad)."""
        (x, y), (x0, y0) = self._points[self.ends((run, True))[end]], self._centres[run[0]]
        return math.atan2(y - y0, x - x0)

    def outline(self, loop: Iterable[Half]) -> Loop:
        """The loop as a profile has it."""
        starts = ((self._points[self.ends(half)[0]], half) for half in loop)
        return tuple(
            (x, y, math.tan(self.sweep(run) / 4) * (1 if forward else -1)) for (x, y), (run, forward) in starts
        )

    def area(self, region: Region) -> float:
        return sum(loop_area(self.outline(loop)) for loop in region)

    def _valence(self, edge: Mask) -> Ints:
        """(n, n_point) how many of the pieces end at each point."""
        pieces, points = self.plane.pieces, len(self.plane.points)
        return np.array([np.bincount(pieces[row].ravel(), minlength=points) for row in edge])

    def _runs(self, edge: Mask, corner: Mask) -> list[Run]:
        indices, corners, pieces = np.flatnonzero(edge).tolist(), corner.tolist(), self._pieces
        follows = {pieces[p][0]: p for p in indices if not corners[pieces[p][0]]}
        out = []
        for p in indices:
            if corners[pieces[p][0]]:
                run = [p]
                while (following := follows.get(pieces[run[-1]][1])) is not None:
                    run.append(following)
                out.append(tuple(run))
        return out

    def _loops(self, halves: list[Half]) -> list[list[Half]]:
        """Closed walks with the region on the left; where regions meet in a point, each keeps to itself."""
        leaving: dict[int, list[Half]] = defaultdict(list)
        for half in halves:
            leaving[self.ends(half)[0]].append(half)
        loops = []
        while leaving:
            start = next(iter(leaving))
            loop = [leaving[start][0]]
            while True:
                tail, head = self.ends(loop[-1])
                leaving[tail].remove(loop[-1])
                if not leaving[tail]:
                    del leaving[tail]
                if head == start:
                    break
                loop.append(self._sharpest(loop[-1], leaving[head]))
            loops.append(loop)
        return loops

    def _sharpest(self, half: Half, choice: list[Half]) -> Half:
        """The next one clockwise from where it came."""
        if len(choice) == 1:
            return choice[0]
        back = self._direction((half[0], not half[1]))
        return min(choice, key=lambda way: (back - self._direction(way)) % (2 * math.pi))

    def _direction(self, half: Half) -> float:
        """In which it leaves its start (rad)."""
        (run, forward), (start, end) = half, (self.plane.points[i] for i in self.ends(half))
        sign = 1 if forward else -1
        if not self.sweep(run):
            return math.atan2(*(end - start)[::-1])
        return self.angle(run, 0 if forward else 1) + sign * (math.pi / 2 + _CURVATURE / self.plane.radius[run[0]])

    def _around(self, hole: list[Half], outer: list[Loop]) -> int:
        """The smallest loop that goes around a hole."""
        if len(outer) == 1:
            return 0
        inside = self.plane.points[[self.ends(hole[0])[0]]]
        return next(i for i, loop in enumerate(outer) if covers([loop], inside)[0])


def _below(flags: Mask) -> Mask:
    """Of each level, what holds in the section below it."""
    return np.concatenate([np.zeros((1, flags.shape[1]), bool), flags])


def _above(flags: Mask) -> Mask:
    return np.concatenate([flags, np.zeros((1, flags.shape[1]), bool)])
