"""How an input factor runs between the samples, where the inputs are linear: as parabolas, as many as it needs."""

from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

import numpy as np

from geom.arrays import Array, Ints, Mask
from lumped.numerics.knots import halfway
from lumped.transfer.ranges import within_silence

CURVED = 1e-3  # of the largest factor of an interval: what a parabola may miss, times its share of the interval
MISSED = 0.01  # and however short that is: a cell of 0.1 J/K follows at once (to |x|^0.8 from 0 on it misses 0.024)
SMALL = 1e-2  # of the largest factor of a record: less than that counts as that
FLAT, FAR = 1e-4, 0.02  # a factor that bends less, over inputs that move less, is a parabola without another look
FINEST = 1e-3  # of an interval
QUARTERS = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
ROUNDING = 1e-12  # of the largest: what is smaller comes from rounding, not from the record


class Curve(NamedTuple):
    """value () or (nt,) at the samples;  inserted (k,) positions (index of a sample plus share) at which one should cut

    bulge () or (nt,) : how far above the mean of both ends the factor is in the middle of the interval that ends there
    """

    value: Array
    bulge: Array
    inserted: Array


NONE, LEVEL = np.empty(0), np.zeros(())


def between(x: Array, at: Array) -> Array:
    """(n,) values at positions, linear between the samples."""
    k = np.minimum(at.astype(np.int64), max(x.size - 2, 0))
    share, end = at - k, np.minimum(k + 1, x.size - 1)
    return np.where(share == 0.0, x[k], (1.0 - share) * x[k] + share * x[end])


class Moves(NamedTuple):
    """left : the samples after which an input moves;  far (nt - 1,) : whether by more than FAR of its largest

    extremes : the samples at which an input is least or largest
    """

    left: Ints
    far: Mask
    extremes: Array

    @property
    def positions(self) -> Array:
        """Of the samples, then of the middles of the intervals in which an input moves."""
        return np.concatenate([np.arange(self.far.size + 1.0), self.left + 0.5])

    def at_positions(self, x: Array) -> Array:
        """An input (nt,) there."""
        return np.concatenate([x, 0.5 * (x[self.left] + x[self.left + 1])])


class Between(Mapping[str, Array]):
    """Inputs at some positions, each made when it is first read.  at : from an input at its samples to these"""

    def __init__(self, inputs: Mapping[str, Array], at: Callable[[Array], Array]) -> None:
        self.inputs, self.at = inputs, at
        self._made: dict[str, Array] = {}

    def __getitem__(self, name: str) -> Array:
        if name not in self._made:
            self._made[name] = self.at(self.inputs[name])
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.inputs)

    def __len__(self) -> int:
        return len(self.inputs)


def parabolas(c: Curve, knots: Array, at: Array) -> Array:
    """(n,) a curve at positions between its knots."""
    k = np.clip(np.searchsorted(knots, at, "right") - 1, 0, knots.size - 2)
    s, bulge = (at - knots[k]) / (knots[k + 1] - knots[k]), np.broadcast_to(c.bulge, knots.shape)
    return np.asarray(c.value[k] + s * (c.value[k + 1] - c.value[k]) + 4.0 * s * (1.0 - s) * bulge[k + 1])


def straight(value: Array) -> Curve:
    """A factor that is linear between the samples."""
    return Curve(value, LEVEL, NONE)


def curve(
    every: Array,
    factor: Callable[[Array], Array],
    moves: Moves,
    turns: Array = NONE,
    skip: Mask | None = None,
    share: float = 1.0,
) -> Curve:
    """From a factor, () where it never changes.  every : the factor at moves.positions;  factor : at any positions

    moves : where its inputs move between samples;  turns : positions at which it may have a corner
    skip (nt,) : the intervals that end there are not to be cut;  share : of CURVED and MISSED that counts
    """
    if every.ndim == 0:
        return straight(every)
    nt = moves.far.size + 1
    bulge, intervals, limits = np.zeros(nt), np.empty(nt, np.int64), np.array([ROUNDING, FLAT, SMALL, 0.0])
    count = halfway(every, moves.left, moves.far, limits, bulge, intervals)
    if count < 0:
        return straight(every[0])
    near = intervals[:count]

    def again(at: Array) -> Array:
        """Beside the extremes, for laws that look for the largest of what they are given."""
        return factor(np.concatenate([moves.extremes, at]))[moves.extremes.size :]

    if skip is not None:
        near = near[~skip[near + 1]]
    left, small, inserted = near.astype(float), SMALL * limits[3], NONE
    with within_silence():  # what is out of range was said of the samples
        if left.size:
            five = again((left[:, None] + QUARTERS).ravel()).reshape(-1, QUARTERS.size)
            wrong = left[_too_curved(five, 1.0, small, share)]
            inserted = _inserted(again, wrong, turns, small, share) if wrong.size else NONE
    return Curve(every[:nt], bulge, inserted)


def _too_curved(five: Array, width: Array | float, small: float, share: float) -> Mask:
    """(n,) whether a parabola misses too much of a factor in an interval of that width, a share of that of samples."""
    f0, q1, fm, q3, f1 = five.T
    low, high = (3 * f0 + 6 * fm - f1) / 8, (-f0 + 6 * fm + 3 * f1) / 8
    missed = np.asarray(np.maximum(np.abs(q1 - low), np.abs(q3 - high)) / np.maximum(np.abs(five).max(axis=1), small))
    return np.asarray((width * missed > share * CURVED) | (missed > share * MISSED))


def _inserted(factor: Callable[[Array], Array], samples: Array, turns: Array, small: float, share: float) -> Array:
    """Positions that cut the intervals after some samples at their corners, and then in halves as long as needed."""
    corners = turns[np.isin(np.floor(turns), samples)]
    ends = np.unique(np.concatenate([samples, samples + 1.0, corners]))
    sampled = np.isin(np.floor(ends[:-1]), samples)
    left, width, out = ends[:-1][sampled], np.diff(ends)[sampled], [corners]
    while left.size:
        at = left[:, None] + width[:, None] * QUARTERS
        cut = _too_curved(factor(at.ravel()).reshape(at.shape), width, small, share) & (width > FINEST)
        left, width = left[cut], 0.5 * width[cut]
        out.append(left + width)
        left, width = np.concatenate([left, left + width]), np.tile(width, 2)
    return np.concatenate(out)
