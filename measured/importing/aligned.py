"""Recorders without a common clock: how far one has to be moved so that the test begins at the same instant in both."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geom.errors import InputError
from measured.headers.words import RUNS, tokens
from measured.importing.clock import EVEN, HOUR_S, ZONELESS, Clock
from measured.importing.guess import Guess
from measured.importing.long_table import HOLD
from measured.importing.source import Source, signature
from measured.recordings.alignment import column_onset
from measured.recordings.sheet import MAX_GAP_S
from measured.recordings.tables import GAP, USUAL

ALIKE = 0.5  # of the columns of the narrower of two files are those of the other: one recorder's
LEAST = 0.5  # of a recording, that has to be left where a column has gaps
LOST = 6.0  # steps over five rows that are missing, as where a logger was asked in vain
WHOLE_S = 10.0  # from where on a test is cut at whole seconds


@dataclass(frozen=True)
class Recording:
    """One file: what it holds, its clock, and what its columns are.

    shift_s : to add to its clock so that it agrees with the first file of its test;  how : what that was told by
    """

    source: Source
    clock: Clock
    guesses: list[Guess]
    shift_s: float = 0.0
    how: str = ""

    @property
    def name(self) -> str:
        return self.source.file.name

    @property
    def step_s(self) -> float:
        return float(np.nanmedian(np.diff(self.clock.seconds)))

    @property
    def gap_s(self) -> float:
        """The longest step between readings that is no gap: any, of a log of what changes; of uneven steps, as people
        write them down, and of what is read less often than the rest, a few of the long ones."""
        t, columns = self.clock.seconds, [self.source.numbers(g.column) for g in self.guesses if g.used]
        rows = [np.append(np.isfinite(t[:-1] + readings[:-1]), True) for readings in columns]
        steps = [step for some in rows if (step := np.diff(t[some])).size]
        if not any(HOLD in note for note in self.source.notes):
            usual = [float(np.nanpercentile(step, USUAL, method="lower")) for step in steps]
            few = LOST * self.step_s * any(float(np.nanmax(step)) > EVEN * self.step_s for step in steps)
            return max([MAX_GAP_S, few, *(GAP * one for one in usual if one > EVEN * self.step_s)])
        longest = max((float(np.nanmax(step)) for step in steps), default=0.0)
        return max(MAX_GAP_S, longest + 2.0 * self.step_s)  # the test is compared at instants of its own


def shift(first: Recording, other: Recording) -> tuple[float, str]:
    """Seconds to add to the other's clock, and by what. InputError for clocks that never overlap or show no onset."""
    if first.clock.start is not None and other.clock.start is not None:
        shift_s, how = other.clock.start - first.clock.start, "both clocks show dates"
        if (ZONELESS in first.clock.words) != (ZONELESS in other.clock.words):
            hours = [shift_s + HOUR_S * n for n in range(-14, 15)]
            end, theirs = first.clock.end_s, other.clock.end_s
            spans = {s: min(end, s + theirs) - max(0.0, s) for s in (shift_s, *hours)}  # for how long both run
            shift_s = max(spans, key=lambda s: (spans[s], -abs(s)))
            how += ", of which one has no zone: the whole hours are guessed"
        _overlapping(first, other, shift_s)
        return shift_s, how
    near, shift_s = 2 * max(first.step_s, other.step_s), other.clock.at_s - first.clock.at_s
    runs = any(RUNS & {*tokens(name)} for name in signature(first.source) & signature(other.source))
    if abs(shift_s) <= near and (runs or first.clock.at_s > 10 * near):  # of one board, or of rows that tell the runs
        return shift_s, "both clocks count alike"
    (a, by), (b, of) = onset(first), onset(other)
    shift_s = a - b
    _overlapping(first, other, shift_s)
    return shift_s, f"onset of '{by}' and '{of}', +- {first.step_s + other.step_s:.2g} s"


def common(
    records: Sequence[Recording], window_s: tuple[float, float | None]
) -> tuple[tuple[float, float | None], tuple[str, ...]]:
    """From and to (s from the first row) where all recorders ran and a part was read, within the window; a note if
    that is less of it."""
    first, start, end = records[0], *window_s
    last = first.clock.end_s
    ends = [r.clock.end_s + r.shift_s for r in records[1:]]
    parts = [(r.clock.seconds + r.shift_s, r.source.numbers(g.column)) for r in records for g in r.guesses if g.place]
    reads = [float(t[good][0]) for t, values in parts if (good := np.isfinite(t + values)).any()]
    begins = max([start, min(reads, default=start), *(float(r.clock.seconds[0]) + r.shift_s for r in records[1:])])
    stops = min([last if end is None else min(end, last), *ends])
    if begins >= stops:
        raise InputError(
            "the recorders never all run in the part asked for",
            ", ".join(r.name for r in records),
            "--from and --to within all of them",
        )
    cut = begins > start or stops < (last if end is None else min(end, last))
    if not cut:
        return window_s, ()
    if stops - begins > WHOLE_S:
        begins, stops = float(np.ceil(begins)), float(np.floor(stops))
    return (begins, stops), (f"the test is where all recorders ran: {begins:.6g} to {stops:.6g} s of {first.name}",)


def longest_part(
    first: Recording, limit_s: float, columns: Sequence[str] = ()
) -> tuple[tuple[float, float | None], tuple[str, ...]]:
    """Of a recording with gaps beyond a limit (s) that are not steps of its own, the longest part; a note.

    columns : that have to be known throughout
    """
    t, gaps = first.clock.seconds, list[tuple[float, float, str]]()
    rows = np.isfinite(t)
    for column in ("", *columns):
        at = t[rows & np.isfinite(first.source.numbers(column))] if column else t[rows]
        usual = float(np.median(np.diff(at))) if at.size > 1 else 0.0
        at = np.concatenate([t[rows][:1], at, t[rows][-1:]])  # it may begin late
        gaps += [
            (float(at[k]), float(at[k + 1]), column) for k in np.flatnonzero(np.diff(at) > max(limit_s, 2 * usual))
        ]
    if not gaps:
        return (0.0, None), ()
    gaps.sort()
    begins = np.maximum.accumulate([t[rows][0], *(end for _, end, _ in gaps)])
    ends = np.array([*(start for start, *_ in gaps), t[rows][-1]])
    k = int(np.argmax(ends - begins))
    begin, end = float(begins[k]), float(ends[k])
    if columns and end - begin < LEAST * (ends[-1] - begins[0]):
        return longest_part(first, limit_s)  # readings so far apart are not gaps: what reads them says what is lacking
    start, stop, column = gaps[0]
    what = f"no {f'{column!r} in' if column else 'rows of'} {first.name} from {start:.6g} s to {stop:.6g} s"
    return (begin, end), (f"{what}: the test is its longest part without a gap, {begin:.6g} to {end:.6g} s",)


def _overlapping(first: Recording, other: Recording, shift_s: float) -> None:
    end, theirs = first.clock.end_s, other.clock.end_s
    if shift_s > end or shift_s + theirs < 0.0:
        late = "after the end" if shift_s > 0 else "before the start"
        raise InputError(
            f"its clock never overlaps with that of {first.name}: it runs {abs(shift_s):.6g} s {late} of it",
            str(other.source.file),
            "two recordings of one test, or one command each",
        )


def onset(record: Recording) -> tuple[float, str]:
    """The instant (s) at which the first of its columns begins to change, and which."""
    onsets = {
        g.column: at
        for g in record.guesses
        if g.quantity and (at := column_onset(record.clock.seconds, record.source.numbers(g.column))) is not None
    }
    if not onsets:
        raise InputError(
            "nothing in it begins to change, so it cannot be set beside the other recording",
            str(record.source.file),
            "a clock with dates in both, or a rise that both saw",
        )
    column = min(onsets, key=lambda c: onsets[c])
    return onsets[column], column


def grouped(records: Sequence[Recording], kinds: Sequence[frozenset[str]]) -> list[list[Recording]]:
    """Files with the same columns are tests; files with different ones are recorders of one test.

    Two recorders for each of several tests are paired in the order they are given.
    """
    groups: list[list[int]] = []
    for i, kind in enumerate(kinds):
        home = next((g for g in groups if len(kinds[g[0]] & kind) > ALIKE * min(len(kinds[g[0]]), len(kind))), None)
        if home is None:
            groups.append([i])
        else:
            home.append(i)
    counts = {len(g) for g in groups}
    if len(counts) != 1:
        words = "; ".join(", ".join(records[i].name for i in g) for g in groups)
        raise InputError(
            f"files of {len(groups)} recorders, not the same number of each",
            words,
            "one file of each recorder for every test",
        )
    return [[records[g[k]] for g in groups] for k in range(counts.pop())]
