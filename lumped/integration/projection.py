"""A factor that is known in finer steps than the knots of a run: parabolas that keep its integral over every interval.

Heat is kept, so that a node whose time constant is long against an interval feels no difference. Where the factor is
far from a parabola (a switch), the interval is cut at the record's own samples.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from geom.arrays import Array, Ints, Mask
from lumped.integration.curve import SMALL, Curve

SWITCH = 0.1  # of the largest factor of an interval: more than measuring noise moves a current or a speed


@dataclass(frozen=True)
class Grid:
    """Knots `time` (nt,) and the finer samples fine_time (n,) that reach from the first of them to the last (s), worked
    out once for all factors.

    full (nt,) of the interval that ends at a knot: does a finer sample lie inside?
    """

    time: Array
    fine_time: Array
    full: Mask

    @classmethod
    def of(cls, time: Array, fine_time: Array) -> "Grid":
        """Knots over finer samples."""
        first, last = np.searchsorted(fine_time, time, "right"), np.searchsorted(fine_time, time, "left")
        return cls(time, fine_time, np.append(False, last[1:] > first[:-1]))

    @cached_property
    def cell(self) -> Ints:
        """(n,) the interval that each finer sample lies in."""
        return np.searchsorted(self.time, self.fine_time, "right") - 1

    @cached_property
    def inner(self) -> Ints:
        """The finer samples between two knots, not at one."""
        cell = self.cell
        inner = (cell >= 0) & (cell < self.time.size - 1)
        inner[inner] = (self.fine_time[inner] > self.time[cell[inner]]) & self.full[cell[inner] + 1]
        return np.flatnonzero(inner)

    @cached_property
    def share(self) -> Array:
        """Of its interval, where each of these lies."""
        time, cell = self.time, self.cell[self.inner]
        return np.asarray((self.fine_time[self.inner] - time[cell]) / (time[cell + 1] - time[cell]))

    @cached_property
    def middle(self) -> Array:
        """(nt - 1,) s"""
        return 0.5 * (self.time[1:] + self.time[:-1])

    @cached_property
    def step(self) -> Array:
        """(n - 1,) s between finer samples."""
        return np.diff(self.fine_time)

    @cached_property
    def places(self) -> tuple[Ints, Array]:
        """The finer sample before each knot and each middle, and the share of the step behind it."""
        at = np.concatenate([self.time, self.middle])
        k = np.clip(np.searchsorted(self.fine_time, at, "right") - 1, 0, self.step.size - 1)
        return k, (at - self.fine_time[k]) / self.step[k]

    def integral(self, fine: Curve) -> Array:
        """(2 nt - 1,) integral from the first finer sample to each knot and each middle, exact for its parabolas."""
        (k, s), h = self.places, self.step
        f0, f1, bulge = fine.value[:-1], fine.value[1:], np.broadcast_to(fine.bulge, self.fine_time.shape)[1:]
        upto = np.concatenate([[0.0], np.cumsum(h * (0.5 * (f0 + f1) + bulge / 1.5))])
        part = s * f0[k] + 0.5 * s**2 * (f1[k] - f0[k]) + bulge[k] * (2.0 * s**2 - s**3 / 0.75)
        return np.asarray(upto[k] + h[k] * part)


def projected(near: Curve, fine: Curve, grid: Grid) -> Curve:
    """near : the curve at the knots, right where no finer sample lies between two of them;  fine : at the samples"""
    if fine.value.ndim == 0:
        return Curve(fine.value, np.zeros(()), np.empty(0))
    full, cell, inner, fine_time = grid.full, grid.cell, grid.inner, grid.fine_time
    if not full.any():
        return near
    whole = grid.integral(fine)
    value, bulge = _equal_integrals(near, grid, full, whole)
    largest, off = _deviation_from_parabola(value, bulge, grid, fine.value[inner])
    cut = off > SWITCH * largest
    if cut.any():
        value, bulge = _equal_integrals(near, grid, full & ~cut, whole)
    # Of all fine samples those at which to cut: at both ends of a switch; all where an interval has none
    to = np.minimum(cell + 1, cut.size - 1)
    mine = np.zeros(cell.size, bool)
    mine[inner] = cut[to[inner]]
    jump = np.abs(np.diff(fine.value)) > SWITCH * np.maximum(largest[to[1:]], largest[to[:-1]])
    ends = np.append(jump, False) | np.append(False, jump)
    stepping = np.zeros(cut.size, bool)
    stepping[to[mine & ends]] = True
    edges = mine & (ends | ~stepping[to])
    return Curve(value, bulge, _positions(near, grid, cut, fine_time[edges], fine))


def _equal_integrals(near: Curve, grid: Grid, smooth: Mask, whole: Array) -> tuple[Array, Array]:
    """Values and bulges that keep the integral of every interval that is full of finer samples.

    smooth (nt,) : intervals between two of which the value is a mean over half of both;  whole : as of Grid.integral
    """
    time, middle, full = grid.time, grid.middle, grid.full
    inside = smooth[1:-1] & smooth[2:]
    at, half = whole[: time.size], whole[time.size :]
    value, bulge = np.broadcast_to(near.value, time.shape).copy(), np.broadcast_to(near.bulge, time.shape).copy()
    value[1:-1][inside] = (np.diff(half)[inside]) / np.diff(middle)[inside]
    mean = np.diff(at)[full[1:]] / np.diff(time)[full[1:]]
    bulge[full] = 1.5 * (mean - 0.5 * (value[1:] + value[:-1])[full[1:]])
    return value, bulge


def _deviation_from_parabola(value: Array, bulge: Array, grid: Grid, f: Array) -> tuple[Array, Array]:
    """(nt,) of the interval that ends at a knot: its largest factor, and how far its samples are from its parabola.

    f : the factor at the samples between knots
    """
    cell, s = grid.cell[grid.inner], grid.share
    line = value[cell] + s * (value[cell + 1] - value[cell]) + 4.0 * s * (1.0 - s) * bulge[cell + 1]
    largest, off = np.abs(value), np.zeros(value.size)
    largest[1:] = np.maximum(largest[1:], largest[:-1])
    np.maximum.at(largest, cell + 1, np.abs(f))
    np.maximum.at(off, cell + 1, np.abs(f - line))
    return np.maximum(largest, SMALL * np.abs(f).max(initial=0.0)), off


def _positions(near: Curve, grid: Grid, cut: Mask, edges: Array, fine: Curve) -> Array:
    """Where to cut: at some samples and, in the intervals that are cut, where the factor turns between samples;
    elsewhere as the near curve says."""
    time, full, fine_time = grid.time, grid.full, grid.fine_time
    knots = near.inserted[~full[near.inserted.astype(np.int64) + 1]]
    t = np.concatenate([edges, np.interp(fine.inserted, np.arange(fine_time.size), fine_time)])
    t = t[(t > time[0]) & (t < time[-1])]
    k = np.searchsorted(time, t, "right") - 1
    mine = full[k + 1] & cut[k + 1] & (t > time[k])
    t, k = t[mine], k[mine]
    return np.concatenate([knots, k + (t - time[k]) / (time[k + 1] - time[k])])
