"""The band around predicted temperatures: parameters, model error and inputs, all from the one table of doubt."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from geom.arrays import Array
from geom.constants import NORMAL_95
from lumped.model.multipliers import values_of
from lumped.model.network import Row
from measured.case import Channel, Test
from measured.sensors.operators import head
from validation.bands.posterior import ParameterPosterior, acting
from validation.comparison.linearisation import stretch
from validation.comparison.predict import Watch
from validation.comparison.uncertainty import moved_boundaries, moved_inputs
from validation.threads import side_by_side

NONE = np.empty(0)
RECORDED = 2**15  # samples as recorded, of which a stretch has a factor for every law; some copies, once a variant
FEWEST = 32  # instants of a stretch
NUMBERS = 2**20  # of a stretch: 8 MB, and some copies, stay near the processor; a longer one waits for its memory


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
    """What moves predicted temperatures, by one deviation each, looked at from the beginning on, stretch by stretch.

    watch : the model as it stands, with tangents of what is uncertain, times `size`;  beside : with one input moved
    root : R, so that columns @ R are independent, the offset of the fit among them
    """

    watch: Watch
    size: Array
    beside: tuple[Watch, ...]
    root: Array

    def stretches(self) -> Iterator[tuple[Array, Array]]:
        """Temperatures (m, n) and what moves them (m, n, k): never in memory as a whole, whatever the test's length."""
        test = self.watch.test
        recorded = test.recorded.time.size if test.recorded else test.time.size
        length = stretch(len(test.channels), self.size.size + len(self.beside), NUMBERS)
        length = max(min(length, RECORDED * test.time.size // recorded), FEWEST)
        for stop in range(length, test.time.size + length, length):
            look = partial(Watch.until, stop=min(stop, test.time.size))
            plain, *variants = side_by_side(look, (self.watch, *self.beside))
            yield (
                plain.y,
                np.concatenate([plain.J * self.size, *((m.y - plain.y)[:, :, None] for m in variants)], axis=2),
            )


def deviations(of: ParameterPosterior, test: Test, places: Sequence[Place]) -> Deviations:
    """test : the record: time, inputs, boundaries, start; its channels do not matter"""
    unread = np.zeros(test.time.size)
    virtual = replace(test, channels=tuple(Channel(f"at {p.name}", p.name, p.row, unread) for p in places))
    network, free, size = acting(of, virtual)
    now = {**values_of(network, None), **of.values}
    boundary_names = {p.targets[0][0] for p in free if head(p) == "boundary"}
    variants = dict(moved_inputs(network, virtual, of.doubt))
    variants |= {name: other for name, other in moved_boundaries(virtual, of.doubt) if name not in boundary_names}
    sd = np.array([p.prior_sd for p in free]) / size
    names = [*(p.name for p in free), *variants]
    Sigma, offset = of.of(names, np.concatenate([sd, np.ones(len(variants))])), of.offsets(names)
    beside = tuple(Watch(network, other, now) for other in variants.values())
    return Deviations(Watch(network, virtual, now, free), size, beside, np.column_stack([_root(Sigma), offset]))


def bands(of: ParameterPosterior, test: Test, places: Sequence[Place]) -> Bands:
    """Temperatures of places along a record, and how sure they are."""
    parts = list(band_stretches(of, test, places))
    y, sd = np.concatenate([part.y for part in parts]), np.concatenate([part.sd for part in parts])
    return Bands(test.time, parts[0].names, y, sd)


def band_stretches(of: ParameterPosterior, test: Test, places: Sequence[Place]) -> Iterator[Bands]:
    """The same stretch by stretch: what a long test needs of memory does not grow with it."""
    by, names, start, first = deviations(of, test, places), tuple(p.name for p in places), 0, NONE
    share = np.array([of.slow(p.row) for p in places])
    for y, columns in by.stretches():
        first = first if start else y[0].copy()
        # (m, n) K2 of columns (m, n, k)
        m, n, k = columns.shape
        independent = columns.reshape(m * n, k) @ by.root
        sd = np.sqrt(np.einsum("ij,ij->i", independent, independent).reshape(m, n) + (share * np.abs(y - first)) ** 2)
        yield Bands(test.time[start : start + len(y)], names, y, sd)
        start += len(y)


def at_end(of: ParameterPosterior, test: Test) -> tuple[Array, Array, Array]:
    """All states of the network at the first and the last instant, x0 and x (n,) degC, and R (n, k) K at the last.

    R R' is the covariance of the states, so that of a field over them is V R R' V'; what a good model is off by
    (ParameterPosterior.slow) is not in it.
    """
    names = of.network.states
    by = deviations(of, test, [Place(n, Row(np.array([i]), np.ones(1))) for i, n in enumerate(names)])
    ends = [(y[0], y[-1], columns[-1]) for y, columns in by.stretches()]
    return ends[0][0], ends[-1][1], ends[-1][2] @ by.root


def _root(Sigma: Array) -> Array:
    """R with R R' = Sigma; rounding may have left it a little indefinite."""
    values, vectors = np.linalg.eigh(Sigma)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))
