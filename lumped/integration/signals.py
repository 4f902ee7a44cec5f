"""The inputs of a record, checked, and what the laws make of them, worked out once."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import cached_property
from math import isfinite
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary, ref

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from lumped.integration.curve import FAR, NONE, Between, Curve, Moves, between, curve, parabolas, straight
from lumped.integration.projection import Grid, projected
from lumped.numerics.knots import moved
from lumped.numerics.terms import Forcing
from lumped.transfer.laws import Fixed, Law

MOST_FINER = 8  # finer ones of one record: every event that is tried needs others, and each holds a factor of every law
LAST_DRIVES = 4  # of one record: a fit's runs, with tangents and without, of two fits side by side
DRIVE_NUMBERS = 2**15  # of the factors of one that is kept: 0.8 MB with its bulges and arches
LONG = 200_000  # samples: of longer records only the factors are kept of which every stretch asks for the whole


class Source(NamedTuple):
    """Of signals that are looked at on other instants: the samples as recorded, their times and ours (s)."""

    signals: Signals
    time: Array
    at: Array

    def between(self, at: Array) -> Between:
        """The recorded inputs at positions of ours (index plus share)."""
        positions = np.interp(between(self.at, at), self.time, np.arange(self.time.size))
        return Between(self.signals, lambda x: between(x, positions))

    def part(self, at: Array) -> Source:
        """The recorded samples from before the first to after the last of some times, with these as ours."""
        first, last = np.searchsorted(self.time, [at[0], at[-1]], "right") - 1
        some = slice(max(int(first), 0), min(int(last) + 2, self.time.size))
        return Source(self.signals.part(some), self.time[some], at)


class Reading(NamedTuple):
    """Inputs that laws read: where they move between samples, at moves.positions, and where they pass through zero."""

    moves: Moves
    halfway: Mapping[str, Array]
    turns: Array


class Signals(dict[str, Array]):
    """Input -> finite array (nt,); a factor that is not of a LONG record stays known as long as its law.

    Laws and signals never change, so the runs of a fit, which differ in multipliers alone, share them. On instants
    wider apart than the samples were recorded, factors are still made of these and keep their integrals.

    source : the samples as recorded, of signals that are looked at on other instants
    missed : of what parabolas may miss between samples, what they may here;  made_of : what has to live as long
    """

    missed = 1.0

    def __init__(self, inputs: Mapping[str, Any], nt: int) -> None:
        super().__init__({name: _checked(name, value, nt) for name, value in inputs.items()})
        self.nt = nt
        self._around: tuple[Signals, Array] | None = None
        self.source: Source | None = None
        self.made_of: Any = None
        self._is_stretch = False
        self._are_cut = False  # what lies between two of them need not be cut again
        self._known: dict[int, tuple[ref[Law], Curve]] = {}
        self._equal: WeakKeyDictionary[Law, Curve] = WeakKeyDictionary()
        self._readings: dict[tuple[str, ...], Reading] = {}
        self._finer: dict[bytes, Signals] = {}
        self._drives: deque[tuple[Hashable, Sequence[Curve], tuple[Forcing, Array]]] = deque(maxlen=LAST_DRIVES)

    @classmethod
    def recorded(cls, inputs: Mapping[str, Any], time: Array, at: Array) -> Signals:
        """Inputs (n,) recorded at some times (s), to be looked at on instants `at` (nt,) within these."""
        source = Source(cls(inputs, time.size), time, at)
        out = cls(dict(source.between(np.arange(at.size, dtype=float))), at.size)
        out.source = source
        return out

    def part(self, some: slice) -> Signals:
        """The signals of a stretch of the record; all of it is itself."""
        if (some.start, some.stop) == (0, self.nt):
            return self
        out = Signals({name: value[some] for name, value in self.items()}, some.stop - some.start)
        out._around, out._is_stretch = (self, np.arange(some.start, some.stop, dtype=float)), True
        out.source = self.source and self.source.part(self.source.at[some])
        return out

    def exact(self, missed: float) -> Signals:
        """The same, whose parabolas may miss a share of what is usual."""
        out = Signals(self, self.nt)
        out._around, out._are_cut, out.missed = self._around, self._are_cut, missed
        out.source = self.source and self.source._replace(signals=self.source.signals.exact(missed))
        return out

    def finer(self, at: Array) -> Signals:
        """The signals at positions (index of a sample plus share); those asked for last are kept for the next time."""
        key = at.tobytes()
        before = self._finer.pop(key, None)
        self._finer[key] = out = self._at(at) if before is None else before
        for oldest in list(self._finer)[:-MOST_FINER]:
            self._finer.pop(oldest, None)
        return out

    def _at(self, at: Array) -> Signals:
        source = self.source
        out = Signals(dict(self._between(at)), at.size)
        out._are_cut, out._around, out.source = True, (self, at), source and source._replace(at=between(source.at, at))
        return out

    def __reduce__(self) -> Any:
        if self.source:
            return Signals.recorded, (dict(self.source.signals), self.source.time, self.source.at)
        return Signals, (dict(self), self.nt)

    def factor(self, name: str, law: Law) -> Array:
        """The input factor of the law of a link or source: a number (), or (nt,) where it varies."""
        return self.curve(name, law).value

    def curve(self, name: str, law: Law) -> Curve:
        """The same, and how it runs between the samples."""
        if type(law) is Fixed and isfinite(law.value):
            return straight(np.asarray(law.value))
        curve = self._known.get(id(law))
        if curve is not None and curve[0]() is law:
            return curve[1]
        new: Curve | None = None
        with suppress(TypeError):  # that of an equal law, as fits make them anew; one that holds arrays has no hash
            new = self._equal.get(law)
        new = new or self._curve_of(name, law)
        if self.nt <= LONG or (law.looks_at_all and not law.by_instant):
            self._known[id(law)] = ref(law, _forgetting(self, id(law))), new
            with suppress(TypeError):
                self._equal.setdefault(law, new)
        return new

    def driven(
        self, how: Hashable, curves: Sequence[Curve], work: Callable[[], tuple[Forcing, Array]]
    ) -> tuple[Forcing, Array]:
        """What drives a run by some curves, as of `forcing`: a fit's runs differ in multipliers alone, and share it."""
        for key, before, drive in tuple(self._drives):
            if key == how and len(before) == len(curves) and all(map(is_same, before, curves)):
                return drive
        drive = work()
        if drive[0].factor.size <= DRIVE_NUMBERS:
            self._drives.append((how, curves, drive))
        return drive

    def forget(self, key: int) -> None:
        """The factor of a law that is gone."""
        self._known.pop(key, None)

    def along(self, name: str, law: Law, at: Array) -> Array:
        """A factor at positions: its law there, or parabolas that keep its integral where more is known."""
        if self.source is None:
            return self.finer(at).factor(name, law)
        knots = np.union1d(np.arange(self.nt, dtype=float), self.curve(name, law).inserted)
        c = self.finer(knots).curve(name, law)
        return c.value if c.value.ndim == 0 else parabolas(c, knots, at)

    def _curve_of(self, name: str, law: Law) -> Curve:
        missing = [x for x in law.reads if x not in self]
        if missing:
            raise InputError(
                f"input '{missing[0]}' is missing", f"'{name}'", f"given: {', '.join(sorted(self)) or 'none'}"
            )
        source = self.source
        if not law.looks_at_all:
            full = np.ones(self.nt, bool) if self._are_cut else self._grid.full if source else None
            read = self._reading(law.reads)
            every = self._factor(name, law, read.halfway, self.nt + read.moves.left.size)

            def factor(at: Array) -> Array:
                return self._factor(name, law, self._between(at), at.size)

            near = curve(every, factor, read.moves, read.turns, full, self.missed)
            return projected(near, source.signals.curve(name, law), self._grid) if source else near
        if self._around and not (law.by_instant and self._is_stretch):
            whole, at = self._around
            value = whole.factor(name, law)
            return straight(value if value.ndim == 0 else between(value, at))
        if source:
            value = source.signals.factor(name, law)
            return straight(value if value.ndim == 0 else np.interp(source.at, source.time, value))
        value = self._factor(name, law, self, self.nt)
        constant = value.ndim == 1 and bool(np.all(value == value[0]))
        return straight(np.asarray(value[0]) if constant else value)

    @cached_property
    def _grid(self) -> Grid:
        """Of signals that are looked at on other instants: these over the samples as recorded."""
        assert self.source is not None
        return Grid.of(self.source.at, self.source.time)

    def _reading(self, names: tuple[str, ...]) -> Reading:
        """How some inputs run between the samples, worked out once for all laws that read the same."""
        reading = self._readings.get(names)
        if reading is None:
            moves = self._moves(names)
            halfway = self._between(moves.positions) if self.source else Between(self, moves.at_positions)
            out = [NONE]
            for x in (self[name] for name in names):
                left = np.flatnonzero(x[:-1] * x[1:] < 0.0)
                out.append(left + x[left] / (x[left] - x[left + 1]))
            reading = Reading(moves, halfway, np.concatenate(out))
            if self.nt <= LONG:
                self._readings[names] = reading
        return reading

    def _between(self, at: Array) -> Between:
        return self.source.between(at) if self.source else Between(self, lambda x: between(x, at))

    def _moves(self, names: Iterable[str]) -> Moves:
        if self.source:
            return Moves(np.arange(self.nt - 1), np.ones(self.nt - 1, bool), np.arange(self.nt, dtype=float))
        at_all, far, ends = np.zeros(self.nt - 1, bool), np.zeros(self.nt - 1, bool), []
        for x in [self[name] for name in names]:
            moved(np.array(x), FAR, at_all, far)  # a copy: another layout, or one that is read-only, compiles anew
            ends += [float(x.argmin()), float(x.argmax())]
        return Moves(np.flatnonzero(at_all), far, np.unique(ends))

    def _factor(self, name: str, law: Law, inputs: Mapping[str, Array], size: int) -> Array:
        """The factor where the inputs are."""
        with np.errstate(all="ignore"):  # what comes of it is looked at
            value = np.asarray(law.factor(inputs), float)
        if value.shape not in ((), (size,)):
            raise InputError(f"the input factor has shape {value.shape}", f"'{name}'", f"() or ({size},)")
        if not np.all(np.isfinite(value)):
            right = f"check {', '.join(law.reads) or 'its numbers'}: no negative exponent of 0"
            raise InputError("is not finite at the inputs of this run", f"'{name}'", right)
        return value


def is_same(a: Curve, b: Curve) -> bool:
    """Are two curves one, or one number?"""
    return a is b or (a.value.ndim == b.value.ndim == 0 and float(a.value) == float(b.value))


def _forgetting(signals: Signals, law: int) -> Callable[[Any], None]:
    """Called when the law is gone. It must not hold the signals: they would wait for the collector of cycles."""
    reference = ref(signals)

    def forget(_: Any) -> None:
        if (alive := reference()) is not None:
            alive.forget(law)

    return forget


def _checked(name: str, value: Any, nt: int) -> Array:
    array = np.asarray(value, float)
    if array.shape not in ((), (nt,)):
        raise InputError(f"input '{name}' has shape {array.shape}", "record", f"a number or ({nt},)")
    if not np.all(np.isfinite(array)):
        raise InputError(f"input '{name}' is not finite everywhere", "record", "fill its gaps first")
    return np.broadcast_to(array, (nt,))
