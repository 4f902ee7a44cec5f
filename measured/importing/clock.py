"""The time of a recording, in seconds from its first row, whatever its clock looks like."""

import itertools
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import UTC, date, datetime, time, timedelta
from functools import cache
from typing import Any

import numpy as np

from geom.arrays import Array, Ints
from geom.errors import InputError
from measured.headers.cells import CLOCK, COMPACT, SPAN, is_clock, is_date, is_span, unit_of
from measured.headers.rows import MOST, NO_RECORD
from measured.headers.words import CLOCKS, RUNS, VOCABULARY, is_time, quantities_of, roles_of, tokens
from measured.importing.source import BINARY, UNNAMED, Source
from measured.recordings.formats import EPOCH, TIME, joined
from measured.recordings.units import QUANTITIES

INSTANT = re.compile(
    r"(?P<a>\d{1,2}|\d{4})(?P<sign>[-/.])\s?(?P<b>\d{1,2})[-/.]\s?(?P<c>\d{1,2}|\d{4})\.?"
    r"(?:(?:\s*[T ,;]\s*|\s*-\s+)(?P<hour>\d{1,2}):(?P<minute>\d{2}|\d(?=:))"
    r"(?::(?P<second>\d{1,2})(?:[.,:](?P<fraction>\d+))?)?)?"
    r"(?:\s*(?P<half>[AaPp])\.?[Mm]\.?)?"
    r"\s*(?P<zone>(?:UTC|GMT)?(?P<east>[-+])(?P<hours>\d{2}):?(?P<minutes>\d{2})?|Z|MES?Z|UTC|[A-Z]{2,3}T)?"
)
ISO = re.compile(r"\d{4}-\d\d-\d\d[ T]\d\d:\d\d(?::\d\d(?:\.\d{1,6})?)?")  # NumPy reads it
ZONES = {zone: float(hours) for zone, hours in re.findall(r"([A-Z]+)(\S+)", VOCABULARY["words"]["zones"])}  # else UTC
POINTED = re.compile(  # a time of day after a date: 10.05.00, and _10-05-00
    r"(?:(?<=[ T])(?=\d+\.)|(?<=\d[ T_]))(\d{1,2})[.-](\d{2})[.-](\d{2})"
)
NO_YEAR = "1972"  # a leap year that stands for none
YEARLESS = re.compile(r"(\d{1,2})[-/.]\s?(\d{1,2})\.?(?=\s+\d{1,2}:\d\d)")
BETWEEN = re.compile(r"(?<=\d),?\s+(?![apAP][mM])[a-zA-ZÀ-ÿ]{1,3}\.?\s+(?=\d{1,2}:\d\d)")  # klo, kl., um, at, à
IDEOGRAPHIC = str.maketrans({"年": "-", "月": "-", "日": " ", "时": ":", "時": ":", "分": ":", "秒": ""})
WEEKDAY = re.compile(  # before a whole date: mar. 04/06/2024 and mar. 4 juin 2024 are no March
    r"^[^\W\d_]{2,10}[.,]{0,2}\s+(?=\d{1,4}[-/.]\s?\d{1,2}[-/.]\s?\d{1,4}|\d{1,2}[-/. ]{1,2}[^\W\d_]{3})"
)
TIME_OF_DAY = re.compile(r"\d{1,2}:\d{2}")
MONTHS = {word: month for month, words in VOCABULARY["months"].items() for word in words.split()}
CLOCK_PARTS = {part: words.split(",") for part, words in VOCABULARY["clock_parts"].items()}
MILLISECONDS = ("ms", "msec", "millisecond", "milliseconds", "millisekunden")
DAY_FIRST = frozenset({"datum", "fecha", "data", "uhrzeit", "zeit", "heure", "zeitstempel", "horodatage"})
DAY_NAMES = frozenset({"uhrzeit", "heure", "hora", "ora", "day"})  # of a clock on the wall
DAY_S, HOUR_S = 86400.0, 3600.0
UNIX = {1e9: 1.0, 1e12: 1e-3, 1e15: 1e-6, 1e18: 1e-9}  # seconds since 1970 are 1e9 today; ms, us, ns
# Times by their size: days of spreadsheets and of mathematics programs; ticks of 100 ns since 1601 and since year 1.
COUNTS = (
    ((3e4, 7e4), DAY_S, "days of a spreadsheet"),
    ((7e5, 7.7e5), DAY_S, "days since year 0"),
    ((1.1e17, 1.5e17), 1e-7, "ticks of 100 ns"),
    ((5.5e17, 7e17), 1e-7, "ticks of 100 ns"),
)
TIME_UNITS = {**{u: f for u, (f, _) in QUANTITIES["time"].units.items()}, "us": 1e-6, "ns": 1e-9, "day": DAY_S}
ZONELESS = "without a zone"
SHARE = 0.9  # of the cells of a column that is a clock
SAMPLE = 200  # cells that tell what a column is
LEAST = 3  # rows with a time
OUT_OF_ORDER = 0.05  # of the rows, each between two that are not: slips of a clock chip
FEWEST = 20  # rows of a run that is a test
MACHINES = 24  # in one file
EVEN = 1.5  # the longest step over the usual one of a record without gaps
FROM_ZERO = 2  # "0:00" and "0:01" begin a span of minutes and seconds; a time of day begins anywhere
SHORT_STEP_S = 0.02  # between rows of a thermal test: nobody records faster
MANY = 100  # from one row to the next: more often ms than seconds, but for the steps of buildings
MANY_MS, MANY_US = 1e6, 1e9  # likewise: who writes ms, or us, reads more often than every quarter of an hour
USUAL_STEPS_S = frozenset({120.0, 180.0, 300.0, 600.0, 900.0, 1200.0, 1800.0, 3600.0, 7200.0, 10800.0, 21600.0, DAY_S})
SINCE_1904_S, LATEST_S = 2082844800.0, 3e9  # some programs count from 1904: what would be after 2065 is that


@dataclass(frozen=True)
class Clock:
    """seconds : (rows,) from the first row;  start : s since 1970, None where only a duration is known

    columns : those it was read from;  words : how;  doubt : what is not sure of it, "" for nothing
    invented : nothing in the file says how far its rows are apart;  at_s : what it shows in the first row
    """

    seconds: Array
    start: float | None
    columns: tuple[str, ...]
    words: str
    doubt: str = ""
    invented: bool = False
    at_s: float = 0.0

    @property
    def end_s(self) -> float:
        """The last instant; rows after it may have no time of their own."""
        return float(np.nanmax(self.seconds))

    def check(self, where: object) -> None:
        """InputError where the clock is invented."""
        if self.invented:
            raise InputError(self.doubt.partition(":")[0], str(where), f"a column {TIME}, or one of instants")


def clock_of(source: Source, period_s: float | None = None) -> Clock:
    """period_s : time between rows, where the file has no clock. InputError for times that run back."""
    clock = None if period_s is not None else _guessed_clock(source)
    finite = clock.seconds[np.isfinite(clock.seconds)] if clock else np.empty(0)
    if clock is None or (finite.size >= LEAST and np.ptp(finite) == 0):
        if period_s is None and source.rows <= MOST:  # of a longer text each cell would take a quarter of a millisecond
            _check_parts(source)
        step = period_s or source.period_s or 1.0
        seconds = step * np.arange(source.rows, dtype=np.float64)
        still = "no time column" if clock is None else f"the clock '{', '.join(clock.columns)}' stands still"
        how = "as the lines before its header say" if source.period_s else "are assumed (--period SECONDS)"
        doubt = "" if period_s is not None else f"{still}: rows {step:g} s apart {how}"
        columns = () if clock is None else clock.columns
        start = source.start if clock is None else clock.start
        return Clock(seconds, start, columns, f"{still}: rows {step:g} s apart", doubt, bool(doubt))
    return checked(clock, source)


def on_one_clock(source: Source) -> Source:
    """With every reading at its own instant where each signal stands behind a clock of its own, and a note; to the end
    of the one that ends first.

    As it is where the clocks are one, or begin apart: those are two clocks of one row.  InputError where signals that
    share no rows share no time either.
    """
    groups, clocks = _groups(source)
    if not groups or any(len(group) < 2 for group in groups):
        return source
    seconds = [c.seconds + (c.start or 0.0) for c in clocks if c is not None]
    begins = [s[np.isfinite(s)][:2] for s in seconds]
    if len(begins) < len(groups) or any(b.size < 2 for b in begins):
        return source
    step = max(float(b[1] - b[0]) for b in begins)
    one = all(np.allclose(s, seconds[0], rtol=0.0, atol=0.5 * step, equal_nan=True) for s in seconds)
    if one or (not source.clock_of_each and any(abs(b[0] - begins[0][0]) > 2 * step for b in begins)):
        return source
    end = min(float(np.nanmax(s)) for s in seconds)
    if end <= max(b[0] for b in begins):
        raise InputError("its signals never run at one time", str(source.file), "a workbook of one test")
    signals = [
        (name, t[(good := t <= end)], source.numbers(name)[good])
        for group, t in zip(groups, seconds, strict=True)
        for name in group[1:]
        if source.is_numeric(name)
    ]
    note = f"{source.file.name}: each of {len(groups)} signals has a clock of its own; it ends with the first of them"
    units, labels = {**source.units, TIME: "s"}, {**source.labels, TIME: TIME}
    cells = {str(name): readings for name, readings in joined(signals)}
    return replace(source, cells=cells, units=units, labels=labels, notes=(*source.notes, note), values={})


def _groups(source: Source) -> tuple[list[list[str]], list[Clock | None]]:
    """Columns from each of several clocks on, and those clocks; none where another column stands before them."""
    names = list(source.cells)
    at = [i for i, name in enumerate(names) if is_second_clock(source, name)]
    if at[:1] != [0] or len(at) < 2:
        return [], []
    groups = [names[a:b] for a, b in itertools.pairwise([*at, len(names)])]
    return groups, [_guessed_clock(replace(source, cells={n: source.cells[n] for n in group})) for group in groups]


def tests_of(source: Source) -> list[Source]:
    """The source, or with a note a test of each of its groups of columns that say the same behind a clock, where those
    clocks have no time in common, or of the rows of each machine that a word in every row names."""
    groups, clocks = _groups(source)
    names = [_without_head([source.labels[n].removesuffix(f" {k}") for n in of]) for k, of in enumerate(groups, 1)]
    times = [(c.start or 0.0) + c.seconds[np.isfinite(c.seconds)] for c in clocks if c is not None]
    spans = sorted((t[0], t[-1]) for t in times if t.size and t[0] > 0.0)  # those from zero may be of any day
    disjoint = None not in clocks and all(a[1] < b[0] for a, b in itertools.pairwise(spans))
    if groups and disjoint and len(names[0]) > 2 and names.count(names[0]) == len(names):
        new, note = names[0], f"a test from each of {len(groups)} groups of columns that say the same"
        parts = [dict(zip(new, (source.cells[n] for n in group), strict=True)) for group in groups]
        units = dict(zip(new, (source.units[n] for n in groups[0]), strict=True))
        whole = replace(source, labels=dict(zip(new, new, strict=True)), units=units)
        rows = [np.flatnonzero(np.isfinite(clock.seconds)) for clock in clocks if clock]
        return [_part(replace(whole, cells=cells), some, note) for cells, some in zip(parts, rows, strict=True)]
    kinds = [q for label in source.labels.values() for q in quantities_of(label)[:1]]
    ids = [n for n in source.cells if not source.is_numeric(n) or {"id", "index"} & {*tokens(n)}]
    read = [n for n in source.cells if n not in ids and not is_time(source.labels[n])]
    each = "temperature" in kinds and len(read) > 1  # no sensor's alone
    words = {n: np.array([*map(str, source.cells[n])]) for n in ids if each}
    words = {n: w for n, w in words.items() if 1 < len({*w.tolist()}) <= MACHINES}
    clock = _guessed_clock(source) if words else None
    if clock is not None and (np.diff(clock.seconds) > 0).all():  # only of what takes turns: sensor_id
        words = {n: w for n, w in words.items() if "id" in tokens(n) and 2 * np.sum(w[1:] != w[:-1]) > w.size}
    for name, of in words.items() if clock is not None else ():
        rows = [np.flatnonzero(of == word) for word in dict.fromkeys(of.tolist())]
        times = [clock.seconds[r] for r in rows] if clock else []
        enough = all(t.size >= FEWEST for t in times) or all(np.array_equal(t, times[0]) for t in times)
        if enough and all((np.diff(t) > 0).all() for t in times):
            return [_part(source, some, f"a test from the rows of each of {len(rows)} '{name}'") for some in rows]
    return [source]


def _without_head(labels: Sequence[str]) -> list[str]:
    """Without the words that all of them begin with."""
    words = [label.split() for label in labels]
    same = sum(1 for _ in itertools.takewhile(lambda level: len({*level}) == 1, zip(*words, strict=False)))
    return [" ".join(one[same:] or one) for one in words]


def _part(source: Source, rows: Sequence[int] | Ints, note: str) -> Source:
    """Some of its rows, and a note."""
    cells = {n: c[rows] if isinstance(c, np.ndarray) else [c[i] for i in rows] for n, c in source.cells.items()}
    return replace(source, cells=cells, notes=(*source.notes, f"{source.file.name}: {note}"), values={})


def _check_parts(source: Source) -> None:
    """Refuses a table with another part in each row, as a report lists what each of them reached."""
    for column in [c for c in source.cells if not source.is_numeric(c)]:
        parts = [*map(str, source.cells[column])]
        if len({*parts}) == len(parts) and 2 * sum(map(bool, map(roles_of, parts))) > len(parts):
            what, where = f"each row is another part: {NO_RECORD}", f"{source.file} column '{column}'"
            raise InputError(what, where, "a column for each part, a row for each instant")


def runs_of(source: Source, period_s: float | None = None) -> list[Source]:
    """The source, or a part from each row on in which its clock, or where it has none its number of the run, says that
    it starts anew; with a note.

    A clock that turns over after a minute, an hour or a day is none that does.
    """
    clock = None if period_s is not None else _guessed_clock(source)
    runs = [c for c in source.cells if RUNS & {*tokens(source.labels[c])} and source.is_numeric(c)]
    number = source.numbers(runs[0]) if runs else np.zeros(source.rows)
    at = np.flatnonzero(np.diff(number)) + 1
    anew = np.isfinite(number).all() and np.unique(number).size == at.size + 1
    steps = np.diff(clock.seconds) if clock else np.empty(0)
    if clock is not None and not (anew and at.size and bool((steps[at - 1] > 2 * np.nanmedian(steps)).all())):
        rows = np.flatnonzero(np.isfinite(clock.seconds))  # not a header that comes again
        t = np.interp(np.arange(source.rows), rows, clock.seconds[rows]) if rows.size else clock.seconds
        at = rows[1:][np.diff(clock.seconds[rows]) < 0]
        usual = float(np.nanmedian(np.abs(np.diff(t)))) if t.size > 1 else 0.0
        anew = clock.start is None and bool((np.abs(t[at] - t[:1]) <= usual).all())
        anew &= not any(abs(t[k - 1] + usual - turn) <= usual for k in at[:1] for turn in (60.0, HOUR_S, DAY_S))
    edges = [0, *at.tolist(), source.rows]
    if not (anew and at.size) or min(np.diff(edges)) < FEWEST or in_time_order(source) is not source:
        return [source]
    note = f"starts anew in row {edges[1] + 1}: {len(edges) - 1} tests, one from each start on"
    return [_part(source, range(a, b), note) for a, b in itertools.pairwise(edges)]


def in_time_order(source: Source) -> Source:
    """With rows that stand out of order where they belong, or without those that stand in the file again, and a note.

    As it is where that makes no even clock: one that starts anew, or is set back, is another matter; numbers that fall
    throughout may count down.
    """
    clock = _guessed_clock(source)
    if clock is None or not np.isfinite(clock.seconds).all():
        return source
    once = dict[tuple[str, ...], int]()
    for i, row in enumerate(zip(*(map(str, cells) for cells in source.cells.values()), strict=True)):
        once.setdefault(row, i)
    rows = [*once.values()]
    if len(rows) < source.rows and bool((np.diff(clock.seconds[rows]) > 0).all()):
        return _part(source, rows, f"{source.rows - len(rows)} rows that stand in it again are left out")
    order = np.argsort(clock.seconds, kind="stable")
    step = np.diff(clock.seconds[order])
    back = int((np.diff(clock.seconds) < 0).sum())
    counts_down = clock.start is None and back > step.size / 2
    if not 0 < step.max() / EVEN <= np.median(step) <= step.min() * EVEN or counts_down:
        return source
    return _part(
        source, order, f"the clock runs back {back} times; sorted by time its rows are {np.median(step):g} s apart"
    )


def checked(clock: Clock, source: Source) -> Clock:
    """A clock that never runs back; from zero."""
    t, where = clock.seconds, f"{source.file} column '{', '.join(clock.columns)}'"
    finite = np.isfinite(t)
    if finite.sum() < LEAST:
        raise InputError("fewer than three rows have a time", where, "a time in every row")
    t, doubts = t.copy(), [clock.doubt] if clock.doubt else []
    step = np.diff(t[finite])
    usual = float(np.median(np.abs(step)))
    late = np.flatnonzero(t[finite] < np.maximum.accumulate(t[finite]))
    back, hour = np.flatnonzero(step < 0), np.flatnonzero(np.abs(step - HOUR_S - usual) < usual)
    by_hour = back.size == 1 and abs(step[back[0]] + HOUR_S - usual) <= max(usual, 1.0) < HOUR_S / 2
    if clock.start is not None and by_hour:
        at = np.flatnonzero(finite)[back[0] + 1]
        t[at:] += HOUR_S
        doubts.append(f"the clock runs back by an hour in row {at + 1}: taken as the end of summer time")
    elif back.size == 1 and back[0] < LEAST and step.size > FEWEST:
        t[: (at := int(np.flatnonzero(finite)[back[0] + 1]))] = np.nan
        finite = np.isfinite(t)
        doubts.append(f"{at} rows over the clock's start are left out: means, or limits")
    elif clock.start is not None and 0 < late.size < OUT_OF_ORDER * t.size and not (np.diff(late) == 1).any():
        t[np.flatnonzero(finite)[late]] = np.nan
        finite = np.isfinite(t)
        doubts.append(f"{late.size} rows whose clock runs back for one row are left out")
    elif back.size:
        what = f"the clock runs back by {-step[back[0]]:g} s in row {int(back[0]) + 2} of the readings"
        raise InputError(what, where, "rows in the order of time")
    elif clock.start is not None and hour.size == 1 and usual < HOUR_S / 4 and "without" in clock.words:
        doubts.append(f"the clock leaps an hour in row {int(hour[0]) + 2}: does summer time begin?")
    first = float(t[finite][0])
    start = None if clock.start is None else clock.start + first
    t, equal = _spread(t - first)
    return Clock(t, start, clock.columns, clock.words, "; ".join([*doubts, *equal]), at_s=first)


def _spread(t: Array) -> tuple[Array, list[str]]:
    """With rows of one stamp spread evenly up to the next one, and the doubt, where most stamps stand in several rows.

    A clock of minutes beside rows of seconds writes such.
    """
    finite = np.flatnonzero(np.isfinite(t))
    stamps, first, counts = np.unique(t[finite], return_index=True, return_counts=True)
    repeated = int(finite.size - stamps.size)
    if not repeated:
        return t, []
    if stamps.size < LEAST or np.median(counts) < 2:
        return t, [f"{repeated} rows have the time of the row before and are left out"]
    whole = float(np.median(counts[1:-1])) if stamps.size > 3 else float(counts.max())
    usual, out = float(np.median(np.diff(stamps))), t.copy()
    for k, (stamp, at, count) in enumerate(zip(stamps, first, counts, strict=True)):
        late = max(whole - count, 0.0) if k == 0 else 0.0  # the first stamp began before the record
        out[finite[at : at + count]] = stamp + usual * (late + np.arange(count)) / max(whole, count)
    out = out - out[finite[0]]
    return out, [f"{whole:g} rows share each time: taken as evenly spread, {usual / whole:g} s apart"]


def _guessed_clock(source: Source) -> Clock | None:
    """A date with a time of day beside it, an instant, a clock, or numbers under a name for time."""
    if (clock := _in_columns(source)) is not None:
        return clock
    dates = [c for c in source.cells if _mostly(source.cells[c], is_date)]
    clocks = [c for c in source.cells if _mostly(source.cells[c], is_clock) and c not in dates]
    with_time = [c for c in dates if _has_time(source.cells[c])]
    for c in with_time:
        result = _instants(source.cells[c], (c,), source.labels[c])
        if np.isfinite(result.seconds).sum() >= LEAST or c == with_time[-1]:
            return _with_ms(source, result)
    if dates and clocks:
        texts = [f"{_day(d)} {t}" for d, t in zip(source.cells[dates[0]], source.cells[clocks[0]], strict=True)]
        result = _instants(texts, (dates[0], clocks[0]), source.labels[dates[0]])
        return _with_ms(source, result) if np.isfinite(result.seconds).sum() >= LEAST else _of_day(source, clocks[0])
    if clocks:
        by_name = [c for c in clocks if is_time(source.labels[c])]
        return _of_day(source, (by_name or clocks)[0])
    days = _instants(source.cells[dates[0]], (dates[0],), source.labels[dates[0]]) if dates else None
    return days if days is not None and _rising(days.seconds) else _numeric(source)


def _in_columns(source: Source) -> Clock | None:
    """Year, day, hour and the like in a column of whole numbers each; None where there are no hours of a day, or hours
    with minutes, such."""
    read: dict[str, tuple[str, Array]] = {}
    for c in source.cells:
        label = source.labels[c].strip().partition(".")[0]  # ss.fff
        part = next((name for name, words in CLOCK_PARTS.items() if label.lower() in words), "")
        part = "month" if label == "MM" and "mm" in source.labels.values() else part  # beside minutes
        if part and part not in read and source.is_numeric(c):
            n = source.numbers(c)
            if np.isfinite(n).all() and (n >= 0).all() and ((n == np.round(n)).all() or part == "second"):
                read[part] = (c, n)
    parts = {part: n for part, (_, n) in read.items()}
    if "hhmm" in parts:
        parts |= {"hour": parts["hhmm"] // 100, "minute": parts["hhmm"] % 100}
    days = "day of year" in parts or {"month", "day"} <= parts.keys()
    if "hour" not in parts or not (days or "minute" in parts) or np.max([*parts.get("minute", [0])]) > 59:
        return None
    none = np.zeros(source.rows)
    year = parts.get("year", none + 1970).astype(int)
    month = none + 1 if "day of year" in parts else parts.get("month", none + 1)
    day = parts.get("day of year", parts.get("day", none + 1)).astype(int) - 1
    date = (12 * (year - 1970) + month.astype(int) - 1).astype("M8[M]").astype("M8[D]") + day
    of_day = HOUR_S * parts["hour"] + 60 * parts.get("minute", none) + parts.get("second", none)
    seconds = (date - EPOCH) / np.timedelta64(1, "s") + of_day
    clock = _since_first(seconds, tuple(c for c, _ in read.values()), f"{', '.join(read)} in columns of their own")
    return clock if days and "year" in parts else replace(clock, start=None)


def _rising(seconds: Array) -> bool:
    finite = seconds[np.isfinite(seconds)]
    return finite.size >= LEAST and bool((np.diff(finite) > 0).all())


def _with_ms(source: Source, clock: Clock) -> Clock:
    """With the milliseconds that some loggers write in a column of their own."""
    for c in source.cells:
        if source.labels[c].strip().lower() in MILLISECONDS and source.is_numeric(c):
            ms = source.numbers(c)
            if np.nanmin(ms) >= 0 and np.nanmax(ms) < 1000 and not rises(source, c):
                return replace(clock, seconds=clock.seconds + np.nan_to_num(ms) / 1e3, columns=(*clock.columns, c))
    return clock


def _mostly(cells: Sequence[Any], test: Callable[[Any], bool]) -> bool:
    if isinstance(cells, np.ndarray):
        if cells.dtype.kind in "mM":
            return bool(test(cells[0].astype("datetime64[us]" if cells.dtype.kind == "M" else "m8[us]").item()))
        if cells.dtype.kind in "fiub":
            finite = cells[np.isfinite(cells)][:SAMPLE]
            return bool(finite.size > 2 and test is is_date and _compact(finite))
    nonempty = [c for c in cells[:SAMPLE] if c is not None and str(c).strip()]
    if not isinstance(cells, np.ndarray) and all(isinstance(c, int | float) for c in nonempty):
        return bool(test is is_date and len(nonempty) > 2 and _compact(np.array(nonempty, float)))
    return bool(nonempty) and sum(test(c) for c in nonempty) >= SHARE * len(nonempty)


def _compact(numbers: Array) -> bool:
    """20260328120010: instants without signs, which look like numbers; a day alone may be any number."""
    return all(COMPACT.fullmatch(f"{n:.0f}") for n in numbers)


def _has_time(cells: Sequence[Any]) -> bool:
    if isinstance(cells, np.ndarray):
        return True
    return any(
        c.time() != time(0)
        if isinstance(c, datetime)
        else ":" in str(c) or POINTED.search(str(c)) or COMPACT.fullmatch(_digits(c))
        for c in cells[:SAMPLE]
        if c is not None
    )


def _digits(cell: Any) -> str:
    """Its digits, of an instant without signs but a T or a blank."""
    text = f"{cell:.0f}" if isinstance(cell, float) and np.isfinite(cell) else str(cell).strip()
    return text[:8] + text[9:] if text[8:9] in tuple("T _:") else text


def _day(cell: Any) -> str:
    if isinstance(cell, datetime | date):
        return cell.strftime("%Y-%m-%d")
    text = str(cell).strip()
    return f"{text[:4]}-{text[4:6]}-{text[6:8]}" if len(text) == 8 and text.isdigit() else text


def _instants(cells: Sequence[Any], columns: tuple[str, ...], label: str) -> Clock:
    """Dates with times, in any zone; a day before the month where points divide them or a first number is over 12."""
    if isinstance(cells, np.ndarray) and cells.dtype.kind == "M":
        return _since_first((cells - EPOCH) / np.timedelta64(1, "s"), columns, "dates")
    if all(isinstance(c, str) and ISO.fullmatch(c) for c in cells):
        with suppress(ValueError):  # no such day
            seconds = (np.array(cells, "M8[us]") - EPOCH) / np.timedelta64(1, "s")
            return _since_first(seconds, columns, f"dates, {ZONELESS}")
    cells = [WEEKDAY.sub("", c.strip()) if isinstance(c, str) else c for c in cells]
    parts = [INSTANT.fullmatch(str(c).strip()) or INSTANT.fullmatch(_spelled_out(c)) for c in cells]
    read = [m for m in parts if m]
    short = [m for m in read if len(m["a"]) < 4]
    points = bool(short) and all(m["sign"] == "." for m in short)
    label_order = re.search(r"(?i)\bd{1,2}[-/. ]?m", label) or set(tokens(label)) & DAY_FIRST
    day_first = (
        points
        or bool(label_order)
        or any(int(m["a"]) > 12 for m in short)
        or (
            not any(int(m["b"]) > 12 for m in short)
            and bool(short)
            and _fewer_leaps(short[:: len(short) // SAMPLE + 1])
        )
    )
    zone = sum(m["zone"] is not None for m in read) > SHARE * len(read)
    seconds = np.array([np.nan if m is None else _unix(m, day_first) for m in parts])
    order = ("day before month, " if day_first else "month before day, ") if short else ""
    unclear = short and not points and not label_order and all(int(m["a"]) <= 12 and int(m["b"]) <= 12 for m in short)
    several = len({m[0][: m.start("hour")] if m["hour"] else m[0] for m in short}) > 1
    doubt = f"is it {order.rstrip(', ')}?" if unclear and several else ""
    lost = len([c for c in cells if str(c or "").strip()]) - len(read)
    doubt = doubt or (f"{lost} of {len(cells)} times could not be read" if lost > (1 - SHARE) * len(cells) else "")
    clock = _since_first(seconds, columns, f"dates, {order}{'with a zone' if zone else ZONELESS}")
    whole = any(m["c"] != NO_YEAR for m in read)
    return replace(clock, doubt=doubt, start=clock.start if whole else None)


def _fewer_leaps(short: Sequence[re.Match[str]]) -> bool:
    """Do the days follow each other more closely with the day before the month?"""
    spans = [
        np.ptp(t[np.isfinite(t)]) if np.isfinite(t).all() else np.inf
        for first in (True, False)
        for t in [np.array([_unix(m, first) for m in short])]
    ]
    return bool(spans[0] < spans[1])


def _spelled_out(cell: Any) -> str:
    """An instant with its month in digits: "Sat 28-Mar-2026 10:00", "28. März 2026", "20260328T120010"."""
    text = _digits(cell)
    if COMPACT.match(text) or re.match(r"(?:19|20)\d{10}(?!\d)", text):
        clock = ":".join(re.findall("..", re.split(r"\D", text[8:14])[0]))
        return f"{text[:4]}-{text[4:6]}-{text[6:8]}T{clock}{text[14:]}"
    text = re.sub(r"(?i)\b([ap])\.\s?m\.?", r"\1m", str(cell).strip().translate(IDEOGRAPHIC))
    text = re.sub(r"(?<=\d{4}):(?=\d\d:\d\d)", " ", text)  # 28/Mar/2026:12:00:10 of a web server
    if day := YEARLESS.match(text):
        return f"{day[1]}/{day[2]}/{NO_YEAR}{text[day.end() :]}"
    text = BETWEEN.sub(" ", re.sub(r"(\d{4}-\d\d-\d\d)_", r"\1 ", POINTED.sub(r"\1:\2:\3", text)))
    return _month_in_digits(text) if re.search(r"[^\W\d_]{3}", text) else re.sub(r"([-/.])\s", r"\1", text)


def _month_in_digits(text: str) -> str:
    """By dateutil, for the day alone: it is kept for the rows of that day."""
    match = TIME_OF_DAY.search(text)
    day = text[: match.start()] if match else text
    rest = text[match.start() :] if match else ""
    if match and (year := re.search(r"\s((?:19|20)\d\d)$", rest)):  # Sat Mar 28 12:00:10 2026
        day, rest = f"{day} {year[1]}", rest[: year.start()]
    result = _date_in_words(day.strip(" ,T"))
    return f"{result} {rest}".strip() if result else text


@cache
def _date_in_words(text: str) -> str:
    from dateutil.parser import ParserError, parse

    words = [
        MONTHS.get(w.strip(".").lower()[:4], MONTHS.get(w.strip(".").lower()[:3], "")) if w[:1].isalpha() else w
        for w in re.findall(r"[^\W\d_]+\.?|\d+", text)
    ]
    if sum(w.isalpha() for w in words) != 1:
        return ""
    try:
        return parse(" ".join(filter(None, words)), dayfirst=True).strftime("%Y-%m-%d")
    except (ParserError, OverflowError):
        return ""


def _unix(m: re.Match[str], day_first: bool) -> float:
    """Seconds since 1970, NaN where there is no such day or time."""
    a, b, c = int(m["a"]), int(m["b"]), int(m["c"])
    if len(m["a"]) == 4:
        year, month, day = a, b, c
    else:
        year, (month, day) = c, (b, a) if (day_first and b <= 12) or a > 12 else (a, b)
    if len(m["c"]) == 2 and len(m["a"]) < 4:
        year += 2000 if year < 69 else 1900  # as POSIX has it
    hour, late = int(m["hour"] or 0), (m["half"] or "").lower()
    hour = hour % 12 + 12 * (late == "p") if late else hour
    try:
        whole = datetime(year, month, day, hour % 24, int(m["minute"] or 0), int(m["second"] or 0), tzinfo=UTC)
    except ValueError:
        return float("nan")
    offset = 3600 * int(m["hours"] or ZONES.get(m["zone"] or "", 0)) + 60 * int(m["minutes"] or 0)
    next_day = DAY_S if hour == 24 else 0.0
    return whole.timestamp() + next_day + float(f"0.{m['fraction'] or 0}") - (-offset if m["east"] == "-" else offset)


def _since_first(seconds: Array, columns: tuple[str, ...], words: str) -> Clock:
    """A clock of seconds since 1970."""
    first = seconds[np.isfinite(seconds)]
    start = float(first[0]) if first.size else 0.0
    return Clock(seconds - start, start, columns, words)


def _of_day(source: Source, column: str) -> Clock:
    """h:mm:ss or m:ss, with fractions; past midnight it goes on. Two numbers alone may be hours or minutes."""
    cells, label = source.cells[column], column.lower() + source.units[column].lower()
    parsed = [_parts(c) for c in cells]
    read = [p for p in parsed if p]
    two = all(len(p) == 2 for p in read)
    texts = [str(c).strip() for c, p in zip(cells[:SAMPLE], parsed) if p]  # not remarks under the readings
    halves = any(text.lower().endswith("m") for text in texts)
    hours_in_label, minutes_in_label = (
        "hh" in label or "h:m" in label or halves or bool(DAY_NAMES & set(tokens(label))),
        "mm:ss" in label and "hh" not in label,
    )
    fraction = any("." in t or "," in t for t in texts)
    from_zero = two and bool(read) and read[0][0] == 0 and read[0][1] < FROM_ZERO
    of_day = two and not fraction and all(p[0] < 24 for p in read) and not from_zero
    hours = two and not minutes_in_label and (hours_in_label or of_day)
    seconds = np.array([_total(p, two and not hours) for p in parsed])
    finite = np.flatnonzero(np.isfinite(seconds))
    turns, step = np.zeros(seconds.size), np.diff(seconds[finite])
    usual = float(np.median(np.abs(step))) if step.size else 0.0
    early = HOUR_S + step[step < 0] - usual
    no_hours = two and not hours and early.size and bool((np.abs(early) <= usual / 2).all())
    turn = HOUR_S if no_hours else DAY_S
    turns[finite[1:]] = np.cumsum(step < -turn / 2)
    words = "minutes:seconds" if two and not hours else "hours:minutes" if two else "hours:minutes:seconds"
    words += ", on from hour to hour" * no_hours
    unsure = two and not (hours_in_label or minutes_in_label or fraction or any(p[0] > 23 for p in read))
    doubt = (
        f"taken as {words}; the other of hours:minutes and minutes:seconds: write the unit (mm:ss)" if unsure else ""
    )
    return Clock(seconds + turn * turns, None, (column,), words, doubt)


def _parts(cell: Any) -> list[float]:
    if isinstance(cell, timedelta | np.timedelta64):
        return [0.0, 0.0, float(np.timedelta64(cell) / np.timedelta64(1, "s"))]
    text = str(cell).strip() if cell is not None else ""
    if m := CLOCK.fullmatch(text):
        second, third = (
            float(x.replace(",", ".").replace(":", ".")) if x else None for x in m.group("second", "third")
        )
        first = float(m["first"])
        if m["half"]:
            first = first % 12 + 12.0 * (m["half"].lower() == "p")
        first += 24.0 * int(m["days"] or 0)
        return [x for x in (first, second, third) if x is not None]
    if is_span(text) and (m := SPAN.fullmatch(text)):
        days, hours, minutes, seconds = (float((x or "0").replace(",", ".")) for x in m.groups())
        return [24 * days + hours, minutes, seconds]
    return []


def _total(parts: list[float], two: bool) -> float:
    if not parts:
        return float("nan")
    return 60 * parts[0] + parts[1] if two else 3600 * parts[0] + 60 * parts[1] + sum(parts[2:3])


def _numeric(source: Source) -> Clock | None:
    """Numbers under a name for time, or that never fall and have a unit of time; of a file without names the first."""
    numeric = [c for c in source.cells if source.is_numeric(c)]
    by_name = [c for c in numeric if _is_named(source, c)]
    by_unit = [c for c in numeric if rises(source, c) and (_unit_of_time(source, c) or _since_1970(source, c))]
    candidates = sorted(dict.fromkeys(c for c in (*by_name, *by_unit) if c != TIME), key=lambda c: not rises(source, c))
    is_count = source.file.suffix.lower() == ".tdms" and TIME in by_name
    is_count = is_count and np.array_equal(source.numbers(TIME), np.arange(source.rows))
    if TIME in by_name and source.file.suffix.lower() in BINARY and not (candidates and is_count):
        return Clock(source.numbers(TIME), source.start, (TIME,), "the format's own time")
    if candidates or TIME in by_name:
        return _scaled(source, candidates[0] if candidates else TIME)
    first = numeric[0] if source.unnamed and numeric else ""
    if first and (rises(source, first) or _since_1970(source, first) or _starts_anew(source.numbers(first))):
        return _scaled(source, first)
    plain = [c for c in numeric if rises(source, c) and unit_of(source.units[c]) in ("", *TIME_UNITS)]
    cells = {c: source.numbers(c).tobytes() for c in plain}
    repeated = [c for c in cells if [*cells.values()].count(cells[c]) > 1]  # one clock beside every signal
    repeated += [c for c in cells if UNNAMED.fullmatch(c)]  # an index
    return _scaled(source, repeated[0]) if repeated and source.period_s is None else None


def rises(source: Source, column: str) -> bool:
    """Numbers that never fall."""
    if not source.is_numeric(column):
        return False
    finite = source.finite(column)
    return finite.size > 2 and bool((np.diff(finite) >= 0).all()) and bool(finite[-1] > finite[0])


def _starts_anew(values: Array) -> bool:
    """Does it rise in even steps but for a few falls to where it began, as a count since the start?"""
    step = np.diff(values)
    usual, back = float(np.median(step)), step < 0
    near = np.abs(values[1:][back] - values[0]) < usual
    even = np.abs(step[~back] - usual) < usual / 2
    return bool(0 < FEWEST * back.sum() <= values.size and near.all() and even.all())


def _unit_of_time(source: Source, column: str) -> str:
    """Of the header's unit, or of a header that is nothing else: "Minutes"; "" where it is none."""
    for text in (source.units[column], source.labels[column]):
        if (unit := unit_of(text)) in TIME_UNITS:
            return unit
    label = source.labels[column]
    return "ms" if {*tokens(label)} & {*MILLISECONDS} else "s" if label == "X_Value" else ""  # ms_today; of LabVIEW


def is_second_clock(source: Source, column: str) -> bool:
    """Is it a time beside the clock: by its name, its unit, its size (seconds since 1970 in any unit) or its cells?"""
    instants = _mostly(source.cells[column], lambda cell: is_date(cell) or is_clock(cell))
    if _is_named(source, column) or unit_of(source.units[column]) in TIME_UNITS or instants:
        return True
    has_name = bool(set(tokens(column)) & CLOCKS) or bool(_unit_of_time(source, column))
    has_name &= unit_of(source.units[column]) in ("", *TIME_UNITS)
    return rises(source, column) and (has_name or _since_1970(source, column))


def _is_named(source: Source, column: str) -> bool:
    """Has it a name for time, and no unit of something else: "Data [°C]" is not a date?"""
    return is_time(source.labels[column]) and unit_of(source.units[column]) in ("", *TIME_UNITS)


def _since_1970(source: Source, column: str) -> bool:
    """Are its numbers seconds since 1970, or parts of them, as they are now?"""
    first = float(source.finite(column)[0])
    return any(size <= first < 2 * size for size in UNIX)


def _in_digits(values: Array) -> Array | None:
    """Seconds of a day of whole numbers such as 113110, where that is a more even clock than the numbers themselves."""
    hours, minutes, seconds = values // 10000, values // 100 % 100, values % 100
    if not (np.isfinite(values).all() and (values % 1 == 0).all() and max(*minutes, *seconds) < 60 and max(hours) < 24):
        return None
    of_day = np.unwrap(HOUR_S * hours + 60 * minutes + seconds, period=DAY_S)
    return of_day if np.ptp(np.diff(of_day)) < np.ptp(np.diff(values)) and np.diff(of_day).min() > 0 else None


def _scaled(source: Source, column: str) -> Clock:
    """Seconds by the unit of the file; without one by size and step: what is likely is taken and doubted aloud."""
    values, unit = source.numbers(column), _unit_of_time(source, column)
    finite = values[np.isfinite(values)]
    read = max(
        (np.isfinite(source.numbers(c)) for c in source.cells if c != column), key=np.sum, default=np.isfinite(values)
    )
    finite = at if (at := values[read & np.isfinite(values)]).size > 1 else finite  # rows may hold a signal each
    first, step = float(finite[0]), float(np.median(np.diff(finite))) if finite.size > 1 else 0.0
    for size, factor in UNIX.items():
        if size <= first < 5 * size and (not unit or TIME_UNITS[unit] == factor):
            start = first * factor - (SINCE_1904_S if first * factor > LATEST_S else 0.0)
            return Clock((values - first) * factor, start, (column,), "seconds since 1970")
    if unit:
        return Clock(values * TIME_UNITS[unit], None, (column,), f"numbers in {unit}")
    for (low, high), factor, words in COUNTS:
        if low < first < high and (factor < 1 or step < 0.5):
            doubt = "" if factor == DAY_S else f"'{column}' is taken as {words}"
            return Clock((values - first) * factor, None, (column,), words, doubt)
    if (digits := _in_digits(values)) is not None:
        return Clock(digits, None, (column,), "hours, minutes and seconds in one number")
    of_day = step * DAY_S
    if 0 <= first < 1 and 0.05 < of_day < SHORT_STEP_S * DAY_S and abs(of_day - round(of_day, 1)) < 0.02 * of_day:
        return Clock(values * DAY_S, None, (column,), "parts of a day", f"'{column}' is taken as parts of a day")
    if bool((finite == np.round(finite)).all()) and step >= MANY and step not in USUAL_STEPS_S:
        odd = step > 6e4 and step / 1e3 not in USUAL_STEPS_S  # 100 s between rows: 0.1 s, rather
        unit = "us" if (odd or step >= MANY_MS) and step < MANY_US else "ms"
        doubt = f"no unit of '{column}': {unit} are assumed"
        return Clock(values * TIME_UNITS[unit], None, (column,), f"numbers, taken as {unit}", doubt)
    doubt = f"no unit of '{column}': seconds are assumed, {step:g} s from row to row"
    return Clock(values, None, (column,), "numbers, taken as seconds", doubt)
