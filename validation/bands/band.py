"""The band around predicted temperatures: parameters, model error and inputs, all from the one table of doubt."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geom.constants import NORMAL_95
from lumped.model.multipliers import values_of
from lumped.model.network import Row
from validation.bands.posterior import ParameterPosterior, acting
from validation.case import Channel, Test
from validation.comparison.linearisation import stretch
from validation.comparison.moved_inputs import moved_boundaries, moved_inputs
from validation.comparison.predict import Watch, predict
from validation.measurement.operators import head

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Place:
    """A temperature that is asked for: a row over z = [x; u]."""

    name: str
    row: Row


@dataclass(frozen=True)
class Bands:
    """time (nt,) s;  y (nt, n) degC;  sd (nt, n) K one standard deviation;  names (n,) of the places"""

    time: Array
    names: tuple[str, ...]
    y: Array
    sd: Array

    @property
    def half95(self) -> Array:
        """(nt, n) half the width of the 95 % band (K)."""
        return NORMAL_95 * self.sd


@dataclass(frozen=True)
class Deviations:
    """What moves predicted temperatures, by one deviation each.

    plain (nt, n) : as the model stands;  watch : tangents of what is uncertain, times `size`;  beside (nt, n, k) : of
    inputs;  root : R, so that columns @ R are independent, the offset of the fit among them
    """

    plain: Array
    watch: Watch
    size: Array
    beside: Array
    root: Array


def deviations(of: ParameterPosterior, test: Test, places: Sequence[Place]) -> Deviations:
    """test : the record: time, inputs, boundaries, start; its channels do not matter"""
    virtual = replace(test, channels=tuple(_virtual_channel(p, test) for p in places))
    network, free, size = acting(of, virtual)
    now = {**values_of(network, None), **of.values}
    plain = predict(network, virtual, now).y
    responses = {
        name: predict(network, other, now).y - plain for name, other in moved_inputs(network, virtual, of.doubt)
    }
    boundary_names = {p.targets[0][0] for p in free if head(p) == "boundary"}
    for name, other in moved_boundaries(virtual, of.doubt):
        if name not in boundary_names:
            responses[name] = predict(network, other, now).y - plain
    sd = np.array([p.prior_sd for p in free]) / size
    names = [*(p.name for p in free), *responses]
    Sigma, offset = of.of(names, np.concatenate([sd, np.ones(len(responses))])), of.offsets(names)
    beside = np.stack([*responses.values()], axis=2) if responses else np.zeros((*plain.shape, 0))
    return Deviations(plain, Watch(network, virtual, now, free), size, beside, np.column_stack([_root(Sigma), offset]))


def bands(of: ParameterPosterior, test: Test, places: Sequence[Place]) -> Bands:
    """Temperatures of places along a record, and how sure they are."""
    by = deviations(of, test, places)
    slow = np.array([of.slow(p.row) for p in places]) * np.abs(by.plain - by.plain[0])
    return Bands(test.time, tuple(p.name for p in places), by.plain, np.sqrt(_variance(by) + slow**2))


def at_end(of: ParameterPosterior, test: Test) -> tuple[Array, Array, Array]:
    """All states of the network at the first and the last instant, x0 and x (n,) degC, and R (n, k) K at the last.

    R R' is the covariance of the states, so that of a field over them is V R R' V'; what a good model is off by
    (ParameterPosterior.slow) is not in it.
    """
    names = of.network.states
    by = deviations(of, test, [Place(n, Row(np.array([i]), np.ones(1))) for i, n in enumerate(names)])
    last = [columns[-1] for columns in _columns(by)][-1]
    return by.plain[0], by.plain[-1], last @ by.root


def _root(Sigma: Array) -> Array:
    """R with R R' = Sigma; rounding may have left it a little indefinite."""
    values, vectors = np.linalg.eigh(Sigma)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _columns(by: Deviations) -> Iterator[Array]:
    """(nt, n, k) stretch by stretch: tangents are never in memory as a whole."""
    nt, n, k = by.beside.shape
    length = stretch(n, by.size.size + k)
    for first in range(0, nt, length):
        some = slice(first, min(first + length, nt))
        yield np.concatenate([by.watch.until(some.stop).J * by.size, by.beside[some]], axis=2)


def _variance(by: Deviations) -> Array:
    """(nt, n) K2."""
    return np.concatenate([np.sum((columns @ by.root) ** 2, axis=2) for columns in _columns(by)])


def _virtual_channel(place: Place, test: Test) -> Channel:
    return Channel(f"at {place.name}", place.name, place.row, np.zeros(test.time.size))
