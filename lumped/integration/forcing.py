"""What drives a network over a record, from knot to knot: the samples, and where input factors turn between them."""

from collections.abc import Mapping, Sequence

import numpy as np

from geom.arrays import Array, Ints, Mask
from geom.errors import InputError
from lumped.integration.assembly import InputSize, Pattern
from lumped.integration.curve import NONE, ROUNDING, SMALL, Curve, between, straight
from lumped.integration.signals import Signals
from lumped.model.network import Network
from lumped.numerics.knots import needed, placed
from lumped.numerics.terms import Forcing

PARABOLA, PARABOLA_K = 2e-4, 1e-3  # of the largest of an interval, K: a few hundredths of what a step may be wrong by


def checked_time(time: Array) -> Array:
    """Finite, never falling times (s)."""
    out = np.ascontiguousarray(time, float)
    if out.ndim != 1 or out.size == 0 or not np.all(np.isfinite(out)) or np.any(np.diff(out) < 0):
        raise InputError("times are not finite and rising", "record", "seconds in rising order")
    return out


def boundary_table(network: Network, boundaries: Mapping[str, Array | float], nt: int) -> Array:
    """(nt, n_boundaries) degC in the network's order."""
    out = np.empty((nt, len(network.boundaries)))
    for k, name in enumerate(network.boundaries):
        if name not in boundaries:
            right = f"the network needs {', '.join(network.boundaries)}"
            raise InputError(f"boundary '{name}' is missing", "record", right)
        value = np.asarray(boundaries[name], float)
        if value.shape not in ((), (nt,)) or not np.all(np.isfinite(value)):
            what = f"boundary '{name}' is not finite or has shape {value.shape}"
            raise InputError(what, "record", f"a number or ({nt},)")
        out[:, k] = value
    return out


def forcing(
    time: Array,
    u: Array,
    signals: Signals,
    patterns: Sequence[Pattern | InputSize],
    curves: Sequence[Curve],
    acting: Mask,
    stiff: Mask,
    bends: bool,
    every_sample: bool = False,
    merged: float = 0.0,
) -> tuple[Forcing, Array]:
    """What drives a run, and the positions of its knots (index of a sample plus share).

    u (nt, nb) boundaries;  patterns, curves : the live terms and what they see; those `acting` set the knots

    stiff : which acting terms touch the matrix;  bends : whether one of these follows temperature
    every_sample : to have a knot at every sample, whether a run needs it or not;  merged : of the largest factor of an
        interval between two samples, what parabolas may miss there that keep all integrals (boundaries are linear)
    """
    at, sample = _knots(time, [c for c, acts in zip(curves, acting, strict=True) if acts])
    t, source = time, signals
    if at.size > time.size:
        source = signals.finer(at)
        curves = [source.curve(p.name, p.law) for p in patterns]
        t, u = between(time, at), _boundaries_between(u, at)
    ends = [straight(x) for x in u.T]
    indices, wholes = np.arange(t.size), [NONE] * (len(curves) + len(ends))
    if not every_sample:
        missed = signals.missed
        # also of terms that do not act: a tangent by a film that opens for a while turns where it opens, whatever its
        # size
        heats, inputs = [(c, missed * PARABOLA, 0.0) for c in curves], [straight(x) for x in source.values()]
        more = [*((c, 0.0, missed * PARABOLA_K) for c in ends), *((x, missed * PARABOLA, 0.0) for x in inputs)]
        indices, wholes = _needed(t, [*heats, *more], np.zeros(t.size, bool))
    elif merged and signals.source and t.size > time.size:
        heats = [(c, merged, 0.0 if acts else np.inf) for c, acts in zip(curves, acting, strict=True)]
        indices, wholes = _needed(t, heats, sample >= 0)
        wholes += [NONE] * len(ends)
    factor, bulge = _between(t, indices, curves, wholes[: len(curves)])
    u, arch = _between(t, indices, ends, wholes[len(curves) :])
    knots = t[indices]
    renew = np.full(indices.size, 2) if bends else _renewals(knots, factor[:, stiff], bulge[:, stiff])
    # first (nk + 1,) and share (nt,) of Forcing.  at (nt,) : which of all knots each sample is
    first, share = np.empty(knots.size + 1, np.int64), np.empty(time.size)
    placed(time, knots, indices, np.flatnonzero(sample >= 0), first, share)
    return Forcing(knots, u, factor, bulge, arch, renew, first, share), at[indices]


def with_boundaries(drive: Forcing, at: Array, u: Array) -> Forcing:
    """The same with other boundaries (nt, nb), linear between the samples, where its knots are at some positions."""
    there = _boundaries_between(u, at)
    return drive._replace(u=there, arch=np.zeros_like(there))


def _boundaries_between(u: Array, at: Array) -> Array:
    return np.stack([between(x, at) for x in u.T], axis=1).reshape(at.size, -1)


def _needed(time: Array, curves: Sequence[tuple[Curve, float, float]], fixed: Mask) -> tuple[Ints, list[Array]]:
    """Which knots a run needs: those fixed, and between them whatever drives it is a parabola.

    And the integrals (nk,) of all curves from the first knot; those of what never varies are empty.

    curves : each with what parabolas may miss of it, as a share of the largest of an interval, and at all
    """
    varying = {i: k for k, i in enumerate(i for i, x in enumerate(curves) if _varies(x[0]))}
    value, bulge, whole = np.empty((3, len(varying), time.size))
    tolerance = np.empty((len(varying), 2))
    for i, k in varying.items():
        c, share, most = curves[i]
        value[k], bulge[k] = c.value, c.bulge
        tolerance[k] = max(most, share * SMALL * _largest(c.value)), share
    out = np.empty(time.size, np.int64)
    count = needed(time, value, bulge, tolerance, fixed, whole, np.empty(4), out)
    return out[:count], [whole[varying[i]] if i in varying else NONE for i in range(len(curves))]


def _varies(c: Curve) -> bool:
    return c.value.ndim > 0 and (bool((c.value != c.value[0]).any()) or bool(c.bulge.any()))


def _largest(x: Array) -> float:
    return max(float(x.max()), -float(x.min()))


def _between(time: Array, indices: Ints, curves: Sequence[Curve], wholes: Sequence[Array]) -> tuple[Array, Array]:
    """(nk, n) values at some of the knots, and how far between them parabolas bulge that keep every integral.

    wholes : the integrals of the curves from the first knot
    """
    value, bulge = np.zeros((2, indices.size, len(curves)))
    value[:] = [c.value if c.value.ndim == 0 else 0.0 for c in curves]
    starts = 1 + np.flatnonzero(np.diff(indices) > 1)
    left, right = indices[starts - 1], indices[starts]
    for e, c in enumerate(curves):
        if c.value.ndim == 0:
            continue
        value[:, e], bulge[:, e] = c.value[indices], c.bulge if c.bulge.ndim == 0 else c.bulge[indices]
        if starts.size and wholes[e].size:
            mean = (wholes[e][right] - wholes[e][left]) / (time[right] - time[left])
            off = 1.5 * (mean - 0.5 * (c.value[left] + c.value[right]))
            off[np.abs(off) <= ROUNDING * _largest(c.value)] = 0.0
            bulge[starts, e] = off
    return value, bulge


def _knots(time: Array, curves: Sequence[Curve]) -> tuple[Array, Ints]:
    """Positions of the knots, and which sample each of them is (-1: none)."""
    samples = np.arange(time.size)
    more = {c.inserted.tobytes(): c.inserted for c in curves if c.inserted.size}  # laws of one input cut alike
    if not more:
        return samples.astype(float), samples
    between_ = np.unique(np.concatenate(list(more.values())))
    left = between_.astype(np.int64)
    at = np.union1d(samples, between_[time[left + 1] > time[left]])
    whole = at == np.floor(at)
    return at, np.where(whole, at, -1.0).astype(np.int64)


def _renewals(time: Array, factor: Array, bulge: Array) -> Ints:
    """How the matrix of every interval differs from the one before: see Forcing."""
    out, ends = np.zeros(time.size, np.int64), np.flatnonzero(np.diff(time) > 0.0) + 1
    varies = np.any((factor[ends] != factor[ends - 1]) | (bulge[ends] != 0.0), axis=1)
    other = np.ones(ends.size, bool)
    other[1:] = np.any(factor[ends[1:] - 1] != factor[ends[:-1] - 1], axis=1) | varies[:-1]
    out[ends] = np.where(varies, 2, np.where(other, 1, 0))
    return out
