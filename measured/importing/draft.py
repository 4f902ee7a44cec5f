"""A case before it is written: its tests, what was guessed, what is still missing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from geom.description.names import cut_short
from geom.errors import InputError
from measured.headers.words import axis_of
from measured.importing.aligned import Recording
from measured.importing.guess import AXES, Guess, in_memory
from measured.importing.target import Target

INSTANTS = 2000  # of a test on the analysis grid; more cost time and tell little
SHORTEST_STEP_S, LONGEST_STEP_S = 1e-3, 86400.0  # of an analysis
NICE = (1, 2, 5)  # what people read off a clock: 1, 2, 5, 10 s
ASSUMED_ROOM = "is assumed, the coldest sensor at the start"
STILL = 5  # readings whose median a column starts from


@dataclass(frozen=True)
class Draft:
    """One test.  records : the first gives the clock;  constants, boundaries : what was not recorded

    squares : input -> columns of which it is the root of the sum of squares;  notes : what was assumed
    window_s : from and to, from the first row
    """

    name: str
    records: tuple[Recording, ...]
    constants: Mapping[str, float] = field(default_factory=dict)
    boundaries: Mapping[str, float] = field(default_factory=dict)
    squares: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    window_s: tuple[float, float | None] = (0.0, None)

    @property
    def guesses(self) -> list[Guess]:
        return [g for r in self.records for g in r.guesses]

    @property
    def span_s(self) -> float:
        start, end = self.window_s
        last = self.records[0].clock.end_s
        return (last if end is None else min(end, last)) - start

    @property
    def step_s(self) -> float:
        return self.records[0].step_s


def squares_of(guesses: Sequence[Guess], target: Target) -> dict[str, tuple[str, ...]]:
    """A current that the model reads and nobody recorded, from the two components that were."""
    names = {g.feeds for g in guesses}
    out = {}
    for name in (n for n, q in target.inputs.items() if q == "current" and n not in names):
        for axes in AXES:
            parts = {axis: g.column for g in reversed(guesses) if g.feeds and (axis := axis_of(g.column)) in axes}
            if set(parts) == axes:
                out[name] = tuple(parts[a] for a in sorted(axes))
    return out


def missing_inputs(draft: Draft, target: Target) -> list[str]:
    """Inputs that the model reads and nothing gives."""
    available = {g.feeds for g in draft.guesses} | set(draft.constants) | set(draft.squares)
    return [name for name in target.inputs if name not in available]


def missing_boundaries(draft: Draft, target: Target) -> list[str]:
    available = {g.place for g in draft.guesses} | set(draft.boundaries)
    return [name for name in target.boundaries if name not in available]


def coldest_start(draft: Draft) -> float:
    """The lowest of the first readings (degC): what the room has where nobody measured it."""
    starts = []
    for r in draft.records:
        for g in (g for g in r.guesses if g.place):
            values = in_memory(r.source, g)
            starts.append(float(np.median(values[np.isfinite(values)][:STILL])))
    return round(min(starts), 2)


def sample_of(drafts: Sequence[Draft]) -> float:
    """Step of the analysis (s): the recorder's own, or a round number that leaves INSTANTS of the longest test."""
    step_s = max(d.step_s for d in drafts)
    if step_s > LONGEST_STEP_S:
        what = f"its rows are {step_s:g} s apart, too far to see a machine warm"
        raise InputError(what, drafts[0].records[0].name, f"rows at most {LONGEST_STEP_S:g} s apart")
    needed = max(SHORTEST_STEP_S, step_s, max(d.span_s for d in drafts) / INSTANTS)
    if (shortest := min(drafts, key=lambda d: d.span_s)).span_s < needed:
        what = f"lasts {shortest.span_s:g} s, too short to see a machine warm"
        raise InputError(what, shortest.name, f"a test of {needed:g} s or more")
    scale = 10.0 ** np.floor(np.log10(needed))
    steps = [n * scale for n in (*NICE, 10)]
    return min(float(f"{next(s for s in steps if s >= needed * (1 - 1e-6)):.6g}"), LONGEST_STEP_S)


def test_name(file: Path, names: Sequence[str]) -> str:
    """The file's name without endings and odd characters, numbered where it is taken."""
    stem = file.name.partition(".")[0] or "test"
    name = "".join(c if c.isalnum() or c in "-_" else "-" for c in stem).strip("-")
    name = cut_short(name) or "test"
    return name if name not in names else next(f"{name}-{i}" for i in range(2, 10**6) if f"{name}-{i}" not in names)


test_name.__test__ = False  # type: ignore[attr-defined]
