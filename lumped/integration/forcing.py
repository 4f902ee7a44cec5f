"""What drives a network over a record, from knot to knot: the samples, and where input factors turn between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped.integration.assembly import Pattern
from lumped.integration.curve import Curve, between
from lumped.integration.signals import Signals
from lumped.model.network import Network
from lumped.numerics.terms import Forcing

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


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
            raise InputError(
                f"boundary '{name}' is missing", "record", f"the network needs {', '.join(network.boundaries)}"
            )
        value = np.asarray(boundaries[name], float)
        if value.shape not in ((), (nt,)) or not np.all(np.isfinite(value)):
            raise InputError(
                f"boundary '{name}' is not finite or has shape {value.shape}", "record", f"a number or ({nt},)"
            )
        out[:, k] = value
    return out


def forcing(
    time: Array, u: Array, signals: Signals, patterns: Sequence[Pattern], acting: Mask, stiff: Mask, bends: bool
) -> Forcing:
    """u (nt, nb) boundaries;  patterns : the live terms, of which those `acting` set the knots

    stiff : which acting terms touch the matrix;  bends : whether one of these follows temperature
    """
    curves = [signals.curve(p.name, p.law) for p in patterns]
    at, sample = _knots(time, [c for c, acts in zip(curves, acting, strict=True) if acts])
    if at.size > time.size:
        finer = signals.finer(at)
        curves = [finer.curve(p.name, p.law) for p in patterns]
        time, u = between(time, at), np.stack([between(x, at) for x in u.T], axis=1).reshape(at.size, -1)
    factor, bulge = np.empty((time.size, len(curves))), np.zeros((time.size, len(curves)))
    for e, c in enumerate(curves):
        factor[:, e], bulge[:, e] = c.value, c.bulge
    renew = np.full(time.size, 2) if bends else _renewals(time, factor[:, stiff], bulge[:, stiff])
    return Forcing(time, np.ascontiguousarray(u), factor, bulge, renew, sample)


def _knots(time: Array, curves: Sequence[Curve]) -> tuple[Array, NDArray[np.int64]]:
    """Positions of the knots, and which sample each of them is (-1: none)."""
    samples = np.arange(time.size)
    more = [c.inserted for c in curves if c.inserted.size]
    if not more:
        return samples.astype(float), samples
    between_ = np.unique(np.concatenate(more))
    left = between_.astype(np.int64)
    at = np.union1d(samples, between_[time[left + 1] > time[left]])
    whole = at == np.floor(at)
    return at, np.where(whole, at, -1.0).astype(np.int64)


def _renewals(time: Array, factor: Array, bulge: Array) -> NDArray[np.int64]:
    """How the matrix of every interval differs from the one before: see Forcing."""
    out, ends = np.zeros(time.size, np.int64), np.flatnonzero(np.diff(time) > 0.0) + 1
    varies = np.any((factor[ends] != factor[ends - 1]) | (bulge[ends] != 0.0), axis=1)
    other = np.ones(ends.size, bool)
    other[1:] = np.any(factor[ends[1:] - 1] != factor[ends[:-1] - 1], axis=1) | varies[:-1]
    out[ends] = np.where(varies, 2, np.where(other, 1, 0))
    return out
