"""When something held: all of a test, stretches of some, or as an input of 0 to 1 says. Its name says all of it."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from lumped.transfer.laws import CLOCK, RUNNING, Inputs

if TYPE_CHECKING:
    from measured.case import Test

Span = tuple[float, float]
NUMBER = r"\d+(?:\.\d+)?"
PIECE = re.compile(rf"(.+):({NUMBER}-{NUMBER}(?:,{NUMBER}-{NUMBER})*)s")
OTHERS = "all but "
ALIKE = 0.5  # of the time in either of two events is in both: such are one, its ends read otherwise
AND = " & "
IN = " in "  # between an effect or a boundary and the condition it holds in


@dataclass(frozen=True)
class Event:
    """Something that was different for a while.  spans : test -> when, from and to (s of the test), all in order"""

    spans: Mapping[str, tuple[Span, ...]]

    @classmethod
    def of(cls, spans: Mapping[str, Iterable[Span]]) -> "Event":
        return cls({t: tuple(sorted((float(a), float(b)) for a, b in spans[t])) for t in sorted(spans)})

    @property
    def name(self) -> str:
        """ "day:600-900,1300-1600s": what reads it back is `event`."""
        pieces = [f"{t}:{','.join(f'{a:.10g}-{b:.10g}' for a, b in pairs)}s" for t, pairs in self.spans.items()]
        return AND.join(pieces)

    @property
    def tests(self) -> tuple[str, ...]:
        return tuple(self.spans)

    @property
    def every(self) -> list[Span]:
        return [s for pairs in self.spans.values() for s in pairs]

    @property
    def words(self) -> str:
        """ "from 36 to 78 min of day"; of repeats how often and how long."""
        if len(self.every) == 1:
            (begin, end), (test,) = self.every[0], self.tests
            return f"from {begin / 60:.3g} to {end / 60:.3g} min of {test}"
        length = float(np.median([end - begin for begin, end in self.every])) / 60.0
        often = "twice" if len(self.every) == 2 else f"{len(self.every)} times"
        return f"{often} in {', '.join(self.tests)}, about {length:.2g} min each"

    def overlap(self, other: "Event") -> float:
        """Time in both over time in either."""
        pairs = (product(spans, other.spans.get(test, ())) for test, spans in self.spans.items())
        both = sum(max(0.0, min(b, d) - max(a, c)) for each in pairs for (a, b), (c, d) in each)
        every = sum(y - x for e in (self, other) for x, y in e.every)
        return both / max(every - both, 1e-12)

    def repeats_at(self, other: "Event") -> "Event":
        """Those of its stretches that some of another event's meet."""
        both = {t: self.spans[t] for t in self.spans if t in other.spans}
        meets = {t: [(a, b) for a, b in s if any(a < d and c < b for c, d in other.spans[t])] for t, s in both.items()}
        return Event.of({t: pairs for t, pairs in meets.items() if pairs})

    def document(self) -> dict:
        spans = [{"test": t, "begin_s": a, "end_s": b} for t, pairs in self.spans.items() for a, b in pairs]
        return {"event": self.name, "words": self.words, "spans": spans}


def event(name: str) -> Event | None:
    """The event that a name describes; None where it is a test's or an input's."""
    pieces = [PIECE.fullmatch(piece) for piece in name.split(AND)]
    spans = [(p[1], [tuple(map(float, s.split("-"))) for s in p[2].split(",")]) for p in pieces if p]
    return Event.of(dict(spans)) if len(spans) == len(pieces) else None  # type: ignore[arg-type]


def odd_tests(condition: str) -> tuple[str, ...]:
    """The tests that a condition leaves out where it is "all but a & b": it holds in every other, seen or not."""
    others = condition.removeprefix(OTHERS)
    return tuple(others.split(AND)) if others != condition else ()


def all_but(tests: Iterable[str]) -> str:
    """The condition that leaves some tests out; `odd_tests` reads it."""
    return f"{OTHERS}{AND.join(tests)}"


def checked(occurrence: Event, test: str, first: float, last: float, where: str) -> None:
    """Spans run forwards, lie inside the record and do not overlap."""
    for begin, end in occurrence.spans[test]:
        if not begin < end:
            what = f"an event ends at {end:g} s, not after it begins at {begin:g} s"
            raise InputError(what, where, "begin, then end")
        if begin < first or end > last:
            what = f"an event from {begin:g} to {end:g} s is outside the record"
            raise InputError(what, where, f"{first:g} to {last:g} s")
    for (a, b), (c, d) in pairwise(occurrence.spans[test]):
        if c < b:
            what = f"an event overlaps itself: {a:g} to {b:g} s and {c:g} to {d:g} s"
            raise InputError(what, where, "spans that follow one another, or two events")


def share(time: Array, spans: Sequence[Span]) -> Array:
    """Share of each sample's time (half a step to either side) that lies in a span."""
    middle = 0.5 * (time[1:] + time[:-1])
    low, high = np.append(time[0], middle), np.append(middle, time[-1])
    inside = sum(np.clip(np.minimum(high, b) - np.maximum(low, a), 0.0, None) for a, b in spans)
    return np.asarray((np.zeros_like(time) + inside) / np.maximum(high - low, 1e-12))


@dataclass(frozen=True)
class TimeWindow:
    """Share of each sample in which something holds, times a factor."""

    name: str
    factor: float = 1.0

    def __call__(self, inputs: Inputs) -> Array:
        time, occurrence = np.asarray(inputs[CLOCK], float), event(self.name)
        if self.name in inputs:
            return self.factor * np.asarray(inputs[self.name], float)
        if odd := odd_tests(self.name):
            return np.full_like(time, self.factor * (not any(f"{RUNNING}{test}" in inputs for test in odd)))
        if occurrence is None:
            return self.factor * np.asarray(inputs.get(f"{RUNNING}{self.name}", np.zeros_like(time)), float)
        here = [pairs for test, pairs in occurrence.spans.items() if f"{RUNNING}{test}" in inputs]
        return self.factor * share(time, here[0]) if here else np.zeros_like(time)


def lasts(condition: str, test: "Test") -> bool:
    """Is a condition this test, all but others, or an event from its first sample to its last?  An event's name rounds
    its times."""
    if odd := odd_tests(condition):
        return test.name not in odd
    occurrence, slack = event(condition), 0.5 * test.step_s
    spans = occurrence.spans.get(test.name, ()) if occurrence else ()
    first, last = float(test.time[0]) + slack, float(test.time[-1]) - slack
    return condition == test.name or any(a <= first and b >= last for a, b in spans)


def holds(name: str, test: "Test") -> Array:
    """The same as an input of a test."""
    return TimeWindow(name)(test.signals)
