"""A factor that is known in finer steps than the knots of a run: parabolas that keep its integral over every interval.

Heat is kept, so that a node whose time constant is long against an interval feels no difference. Where the factor is
far from a parabola (a switch), the interval is cut at the record's own samples.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array, Mask
from lumped.integration.curve import SMALL, Curve

SWITCH = 0.1  # of the largest factor of an interval: more than measuring noise moves a current or a speed


def crowded(time: Array, fine_time: Array) -> NDArray[np.bool_]:
    """(nt,) of the interval that ends at a knot: does a finer sample lie inside?"""
    first, last = np.searchsorted(fine_time, time, "right"), np.searchsorted(fine_time, time, "left")
    return np.append(False, last[1:] > first[:-1])


def projected(near: Curve, time: Array, fine: Curve, fine_time: Array) -> Curve:
    """near : the curve at the knots `time`, right where no finer sample lies between two of them

    fine : the curve at the samples fine_time, which reach from the first knot to the last
    """
    if fine.value.ndim == 0:
        return Curve(fine.value, np.zeros(()), np.empty(0))
    full = crowded(time, fine_time)
    if not full.any():
        return near
    cell = np.searchsorted(time, fine_time, "right") - 1
    inner = (cell >= 0) & (cell < time.size - 1)
    inner[inner] = (fine_time[inner] > time[cell[inner]]) & full[cell[inner] + 1]
    value, bulge = _equal_integrals(near, time, full, full, fine, fine_time)
    largest, off = _deviation_from_parabola(value, bulge, time, cell[inner], fine_time[inner], fine.value[inner])
    cut = off > SWITCH * largest
    value, bulge = _equal_integrals(near, time, full, full & ~cut, fine, fine_time)
    # Of all fine samples those at which to cut: at both ends of a switch; all where an interval has none
    to = np.minimum(cell + 1, cut.size - 1)
    mine = inner & cut[to]
    jump = np.abs(np.diff(fine.value)) > SWITCH * np.maximum(largest[to[1:]], largest[to[:-1]])
    ends = np.append(jump, False) | np.append(False, jump)
    stepping = np.zeros(cut.size, bool)
    stepping[to[mine & ends]] = True
    edges = mine & (ends | ~stepping[to])
    return Curve(value, bulge, _positions(near, time, full, cut, fine_time[edges], fine, fine_time))


def _equal_integrals(
    near: Curve, time: Array, full: Mask, smooth: Mask, fine: Curve, fine_time: Array
) -> tuple[Array, Array]:
    """Values and bulges that keep the integral of every interval that is full of finer samples.

    smooth (nt,) : intervals between two of which the value is a mean over half of both
    """
    inside, middle = smooth[1:-1] & smooth[2:], 0.5 * (time[1:] + time[:-1])
    whole = integral(fine, fine_time, np.concatenate([time, middle]))
    at, half = whole[: time.size], whole[time.size :]
    value, bulge = np.broadcast_to(near.value, time.shape).copy(), np.broadcast_to(near.bulge, time.shape).copy()
    value[1:-1][inside] = (np.diff(half)[inside]) / np.diff(middle)[inside]
    mean = np.diff(at)[full[1:]] / np.diff(time)[full[1:]]
    bulge[full] = 1.5 * (mean - 0.5 * (value[1:] + value[:-1])[full[1:]])
    return value, bulge


def integral(fine: Curve, fine_time: Array, at: Array) -> Array:
    """(n,) integral from the first fine sample to some times, exact for its parabolas."""
    h = np.diff(fine_time)
    f0, f1, bulge = fine.value[:-1], fine.value[1:], np.broadcast_to(fine.bulge, fine_time.shape)[1:]
    upto = np.concatenate([[0.0], np.cumsum(h * (0.5 * (f0 + f1) + bulge / 1.5))])
    k = np.clip(np.searchsorted(fine_time, at, "right") - 1, 0, h.size - 1)
    s = (at - fine_time[k]) / h[k]
    part = s * f0[k] + 0.5 * s**2 * (f1 - f0)[k] + bulge[k] * (2.0 * s**2 - s**3 / 0.75)
    return np.asarray(upto[k] + h[k] * part)


def _deviation_from_parabola(
    value: Array, bulge: Array, time: Array, cell: NDArray[np.int64], t: Array, f: Array
) -> tuple[Array, Array]:
    """(nt,) of the interval that ends at a knot: its largest factor, and how far its samples are from its parabola."""
    s = (t - time[cell]) / (time[cell + 1] - time[cell])
    line = value[cell] + s * (value[cell + 1] - value[cell]) + 4.0 * s * (1.0 - s) * bulge[cell + 1]
    largest, off = np.abs(value), np.zeros(value.size)
    largest[1:] = np.maximum(largest[1:], largest[:-1])
    np.maximum.at(largest, cell + 1, np.abs(f))
    np.maximum.at(off, cell + 1, np.abs(f - line))
    return np.maximum(largest, SMALL * np.abs(f).max(initial=0.0)), off


def _positions(near: Curve, time: Array, full: Mask, cut: Mask, edges: Array, fine: Curve, fine_time: Array) -> Array:
    """Where to cut: at some samples and, in the intervals that are cut, where the factor turns between samples;
    elsewhere as the near curve says."""
    knots = near.inserted[~full[near.inserted.astype(np.int64) + 1]]
    t = np.concatenate([edges, np.interp(fine.inserted, np.arange(fine_time.size), fine_time)])
    t = t[(t > time[0]) & (t < time[-1])]
    k = np.searchsorted(time, t, "right") - 1
    mine = full[k + 1] & cut[k + 1] & (t > time[k])
    t, k = t[mine], k[mine]
    return np.concatenate([knots, k + (t - time[k]) / (time[k + 1] - time[k])])
