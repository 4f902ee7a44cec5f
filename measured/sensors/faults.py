"""Faults of the measurement that need no model: frozen, clipped and impossible channels."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Mask
from measured.case import Channel, Test
from measured.doubt import FORM

FEW = 8  # readings below which nothing is said of a channel
SAME_K = 1e-9  # K


@dataclass(frozen=True)
class Fault:
    """What is plainly wrong with a channel in a test.  kind : "frozen", "clipped" or "unit"
    bad : (n_time,) the readings that mean nothing;  words : for people
    """

    kind: str
    test: str
    channel: str
    bad: Mask
    words: str

    @property
    def name(self) -> str:
        """Like an effect's."""
        return f"{self.kind}@{self.channel}"


@dataclass(frozen=True)
class PlainFaults:
    """What is wrong with the measurement for sure.  channels : broken ones;  bases : tests on another than said"""

    channels: tuple[Fault, ...] = ()
    bases: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.channels or self.bases)

    @property
    def words(self) -> str:
        return "; ".join([*(f.words for f in self.channels), *self.bases])

    @property
    def names(self) -> tuple[str, ...]:
        """Of the broken channels, each once."""
        return tuple(dict.fromkeys(f.name for f in self.channels))


def longest_run(y: NDArray[np.float64]) -> tuple[int, int]:
    """First and last index of the longest stretch of equal readings."""
    edges = np.concatenate([[-1], np.flatnonzero(~equal(np.diff(y))), [y.size - 1]])
    longest = int(np.argmax(np.diff(edges)))
    return int(edges[longest]) + 1, int(edges[longest + 1])


def equal(difference: NDArray[np.float64]) -> Mask:
    """Readings that differ by no more than averaging equal ones rounds."""
    return np.abs(difference) < SAME_K


def fault(test: Test, channel: Channel) -> Fault | None:
    """What is plainly wrong with a channel, or None."""
    read = np.flatnonzero(np.isfinite(channel.y))
    y = channel.y[read]
    if y.size < FEW:
        return None
    here = f"{channel.name} in {test.name}"
    if y.min() < -60.0 or y.max() > 400.0:
        words = f"{here} reads {y.min():.0f} to {y.max():.0f} degC: a wrong unit?"
        return Fault("unit", test.name, channel.name, np.isfinite(channel.y), words)
    first, last = longest_run(y)
    run = last - first + 1
    long = run > FORM["frozen"] * y.size and others_move(test, channel, slice(None))
    if not long and not (
        jumps_after(y, first, last) and others_move(test, channel, slice(read[first], read[last] + 1))
    ):
        return None
    limit = equal(y[first] - y.max()) and np.ptp(y) > FORM["moving"]
    bad = np.zeros(channel.y.size, bool)
    bad[read[equal(y - y[first])] if limit else read[first : last + 2]] = True  # the next reading is half of it
    words = f"{here} is {'at its limit' if limit else 'frozen'} for {100 * run / y.size:.0f} % of the test"
    return Fault("clipped" if limit else "frozen", test.name, channel.name, bad, words)


def others_move(test: Test, channel: Channel, when: slice) -> bool:
    """Does every second of the other channels move by more than noise can?"""
    others = [c.y[when] for c in test.channels if c is not channel and np.isfinite(c.y[when]).any()]
    return bool(others) and float(np.median([np.nanmax(y) - np.nanmin(y) for y in others])) > FORM["moving"]


def jumps_after(y: NDArray[np.float64], first: int, last: int) -> bool:
    """Does a stretch of equal readings end with the largest step of the record: to where the channel should be?"""
    step = np.abs(np.diff(y))
    if last - first + 1 < FEW or last >= step.size:
        return False
    return bool(step[last] >= step.max() and step[last] > FORM["jump"] * np.delete(step, last).max(initial=SAME_K))


def broken_channels(tests: Iterable[Test]) -> list[Fault]:
    """All plain faults."""
    faults = [fault(test, channel) for test in tests for channel in test.channels]
    return [f for f in faults if f]


def without(tests: Sequence[Test], faults: Sequence[Fault]) -> tuple[Test, ...]:
    """The tests without the readings that mean nothing; one that has none of them is as it was."""
    bad = {(f.test, f.channel): f.bad for f in faults}
    dirty = {f.test for f in faults}

    def cleaned(t: Test, c: Channel) -> Channel:
        return replace(c, y=np.where(bad[t.name, c.name], np.nan, c.y)) if (t.name, c.name) in bad else c

    return tuple(replace(t, channels=tuple(cleaned(t, c) for c in t.channels)) if t.name in dirty else t for t in tests)
