"""The band around predicted temperatures: parameters, model error and inputs, all from the one table of doubt."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lumped.multipliers import values_of
from lumped.network import Network, Row
from lumped.quantities import AIR, LIQUID
from validation.bands.belief import Belief, acting
from validation.case import Channel, Test
from validation.doubt import Doubt
from validation.operators import head
from validation.predict import Watch, predict
from validation.sheet import stretch

Array = NDArray[np.float64]
NORMAL_95 = 1.96
FLOWS = {AIR: "flow of air", LIQUID: "flow of liquid"}


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


def bands(of: Belief, test: Test, places: Sequence[Place]) -> Bands:
    """Temperatures of places along a record, and how sure they are.

    test : the record: time, inputs, boundaries, start; its channels do not matter
    """
    asked = replace(test, channels=tuple(_asked(p, test) for p in places))
    network, free, size = acting(of, asked)
    now = {**values_of(network, None), **of.values}
    plain = predict(network, asked, now).y
    moved = {name: predict(network, other, now).y - plain for name, other in moved_inputs(network, asked, of.doubt)}
    known = {p.targets[0][0] for p in free if head(p) == "boundary"}
    for name, other in moved_boundaries(asked, of.doubt):
        if name not in known:
            moved[name] = predict(network, other, now).y - plain
    sd = np.array([p.prior_sd for p in free]) / size
    Sigma = of.of([*(p.name for p in free), *moved], np.concatenate([sd, np.ones(len(moved))]))
    beside = np.stack([*moved.values()], axis=2) if moved else np.zeros((*plain.shape, 0))
    variance = _variance(Watch(network, asked, now, free), size, beside, _root(Sigma))
    slow = of.doubt["slow"] * np.abs(plain - plain[0])
    return Bands(test.time, tuple(p.name for p in places), plain, np.sqrt(variance + slow**2))


def _root(Sigma: Array) -> Array:
    """R with R R' = Sigma; rounding may have left it a little indefinite."""
    values, vectors = np.linalg.eigh(Sigma)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _variance(watch: Watch, size: Array, beside: Array, root: Array) -> Array:
    """K2, stretch by stretch: tangents are never in memory as a whole."""
    n, channels, k = beside.shape
    length, out = stretch(channels, size.size + k), []
    for first in range(0, n, length):
        some = slice(first, min(first + length, n))
        columns = np.concatenate([watch.until(some.stop).J * size, beside[some]], axis=2)
        out.append(np.sum((columns @ root) ** 2, axis=2))
    return np.concatenate(out)


def _asked(place: Place, test: Test) -> Channel:
    return Channel(f"at {place.name}", place.name, place.row, np.zeros(test.time.size))


def moved_inputs(network: Network, test: Test, doubt: Doubt) -> Iterator[tuple[str, Test]]:
    """The record with one input at a time off by its standard uncertainty; flows of one kind are off together."""
    groups: dict[str, list[str]] = {}
    for name, u in test.inputs.items():
        if np.any(u):
            groups.setdefault(FLOWS.get(network.measures(name), f"input {name}"), []).append(name)
    for group, names in groups.items():
        share = doubt["flow" if group in FLOWS.values() else "input"]
        yield group, test.scaled(dict.fromkeys(names, 1.0 + share))


def moved_boundaries(test: Test, doubt: Doubt) -> Iterator[tuple[str, Test]]:
    """The record with one boundary at a time off by what its thermometer may be."""
    for name, T in test.boundaries.items():
        off = np.asarray(T, float) + doubt["boundary"]
        yield f"boundary:{name}", replace(test, boundaries={**test.boundaries, name: off})
