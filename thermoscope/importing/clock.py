"""The time of a recording, in seconds from its first row, whatever its clock looks like."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, date, datetime, time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from thermoscope.importing.cells import is_clock, is_date, unit_of
from thermoscope.importing.source import BINARY, EPOCH, Source
from thermoscope.recordings.formats import TIME
from thermoscope.recordings.units import QUANTITIES

Array = NDArray[np.float64]
WORDS = frozenset({"time", "zeit", "timestamp", "date", "datum", "uhrzeit", "clock", "elapsed", "datetime",
                   "zeitstempel", "messzeit"})  # fmt: skip
INSTANT = re.compile(
    r"(?P<a>\d{1,2}|\d{4})(?P<sign>[-/.])(?P<b>\d{1,2})[-/.](?P<c>\d{1,2}|\d{4})"
    r"(?:[T ,]\s*(?P<hour>\d{1,2}):(?P<minute>\d{2})(?::(?P<second>\d{2})(?:[.,:](?P<fraction>\d+))?)?)?"
    r"(?:\s*(?P<half>[AaPp])\.?[Mm]\.?)?"
    r"\s*(?P<zone>Z|UTC|GMT|(?P<east>[-+])(?P<hours>\d{2}):?(?P<minutes>\d{2})?)?"
)
DAY_S = 86400.0
UNIX = {1e9: 1.0, 1e12: 1e-3, 1e15: 1e-6, 1e18: 1e-9}  # seconds since 1970 are 1e9 today; ms, us, ns
SHARE = 0.9  # of the cells of a column that is a clock
SAMPLE = 200  # cells that tell what a column is


@dataclass(frozen=True)
class Clock:
    """seconds : (rows,) from the first row;  start : s since 1970, None where only a duration is known

    columns : those it was read from;  words : how;  sure : False where the unit of the time is a guess
    """

    seconds: Array
    start: float | None
    columns: tuple[str, ...]
    words: str
    sure: bool = True

    @property
    def end_s(self) -> float:
        """The last instant; rows after it may have no time of their own."""
        return float(np.nanmax(self.seconds))


def clock_of(source: Source, period_s: float | None = None) -> Clock:
    """period_s : time between rows, where the file has no clock. InputError for times that run back."""
    clock = _guessed_clock(source)
    if clock is None or period_s is not None:
        step = 1.0 if period_s is None else period_s
        seconds = step * np.arange(source.rows, dtype=np.float64)
        return Clock(seconds, source.start, (), f"no time column: rows {step:g} s apart", period_s is not None)
    return checked(clock, source)


def checked(clock: Clock, source: Source) -> Clock:
    """A clock that never runs back; from zero."""
    t, where = clock.seconds, f"{source.file} column '{', '.join(clock.columns)}'"
    finite = np.isfinite(t)
    if finite.sum() < 3:
        raise InputError("fewer than three rows have a time", where, "a time in every row")
    back = np.flatnonzero(np.diff(t[finite]) < 0)
    if back.size:
        step = float(np.diff(t[finite])[back[0]])
        summer = abs(step + 3600) < 120
        right = "a clock in UTC, or with its zone" if summer else "rows in the order of time"
        raise InputError(f"the clock runs back by {-step:g} s in row {int(back[0]) + 2} of the readings"
                         + (": summer time ended?" if summer else ""), where, right)  # fmt: skip
    first = float(t[finite][0])
    start = None if clock.start is None else clock.start + first
    return Clock(t - first, start, clock.columns, clock.words, clock.sure)


def _guessed_clock(source: Source) -> Clock | None:
    """A date with a time of day beside it, an instant, a clock, or numbers under a name for time."""
    dates = [c for c in source.cells if _mostly(source.cells[c], is_date)]
    clocks = [c for c in source.cells if _mostly(source.cells[c], is_clock)]
    if dates and clocks and not _has_time(source.cells[dates[0]]):
        texts = [f"{_day(d)} {t}" for d, t in zip(source.cells[dates[0]], source.cells[clocks[0]], strict=True)]
        return _instants(texts, (dates[0], clocks[0]))
    if dates and _has_time(source.cells[dates[0]]):
        return _instants(source.cells[dates[0]], (dates[0],))
    if clocks:
        return _of_day(source.cells[clocks[0]], clocks[0])
    return _numeric(source)


def _mostly(cells: Sequence[Any], test: Callable[[Any], bool]) -> bool:
    if isinstance(cells, np.ndarray) and cells.dtype.kind == "M":
        return bool(test is is_date)
    nonempty = [c for c in cells[:SAMPLE] if c is not None and str(c).strip()]
    return bool(nonempty) and sum(test(c) for c in nonempty) >= SHARE * len(nonempty)


def _has_time(cells: Sequence[Any]) -> bool:
    if isinstance(cells, np.ndarray) and cells.dtype.kind == "M":
        return True
    return any(":" in str(c) or (isinstance(c, datetime) and c.time() != time(0)) for c in cells[:SAMPLE])


def _day(cell: Any) -> str:
    return cell.strftime("%Y-%m-%d") if isinstance(cell, datetime | date) else str(cell).strip()


def _instants(cells: Sequence[Any], columns: tuple[str, ...]) -> Clock:
    """Dates with times, in any zone; a day before the month where points divide them or a first number is over 12."""
    if isinstance(cells, np.ndarray) and cells.dtype.kind == "M":
        return _since_first((cells - EPOCH) / np.timedelta64(1, "s"), columns, "dates")
    parts = [INSTANT.fullmatch(str(c).strip()) for c in cells]
    read = [m for m in parts if m]
    points = bool(read) and all(m["sign"] == "." and len(m["a"]) < 4 for m in read)
    day_first = points or any(len(m["a"]) < 4 and int(m["a"]) > 12 for m in read)
    zone = sum(m["zone"] is not None for m in read) > SHARE * len(read)
    seconds = np.array([np.nan if m is None else _unix(m, day_first) for m in parts])
    clear = day_first or any(len(m["a"]) < 4 for m in read)
    order = "day before month, " if day_first else "month before day, " if clear else ""
    return _since_first(seconds, columns, f"dates, {order}{'with' if zone else 'without'} a zone")


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
        whole = datetime(year, month, day, hour, int(m["minute"] or 0), int(m["second"] or 0), tzinfo=UTC)
    except ValueError:
        return float("nan")
    offset = 3600 * int(m["hours"] or 0) + 60 * int(m["minutes"] or 0)
    return whole.timestamp() + float(f"0.{m['fraction'] or 0}") - (-offset if m["east"] == "-" else offset)


def _since_first(seconds: Array, columns: tuple[str, ...], words: str) -> Clock:
    """A clock of seconds since 1970."""
    first = seconds[np.isfinite(seconds)]
    start = float(first[0]) if first.size else 0.0
    return Clock(seconds - start, start, columns, words)


def _of_day(cells: Sequence[Any], column: str) -> Clock:
    """h:mm:ss or m:ss, with fractions; past midnight it goes on."""
    parsed = [_parts(c) for c in cells]
    two = all(len(p) == 2 for p in parsed if p)
    seconds = np.array([_total(p, two) for p in parsed])
    finite = np.flatnonzero(np.isfinite(seconds))
    turns = np.zeros(seconds.size)
    turns[finite[1:]] = np.cumsum(np.diff(seconds[finite]) < -DAY_S / 2)
    words = "minutes:seconds" if two else "hours:minutes:seconds"
    return Clock(seconds + DAY_S * turns, None, (column,), words, not two or any("." in str(c) for c in cells[:9]))


def _parts(cell: Any) -> list[float]:
    text = str(cell).strip().lower().replace(",", ".") if cell is not None else ""
    late = 12.0 if text.endswith("pm") else 0.0
    digits = re.sub(r"\s?[ap]m$", "", text)
    try:
        parts = [float(x) for x in digits.split(":")] if ":" in digits else []
    except ValueError:
        return []
    if parts and text.endswith(("am", "pm")):
        parts[0] = parts[0] % 12 + late
    return parts


def _total(parts: list[float], two: bool) -> float:
    if not parts:
        return float("nan")
    return 60 * parts[0] + parts[1] if two else 3600 * parts[0] + 60 * parts[1] + sum(parts[2:3])


def _numeric(source: Source) -> Clock | None:
    """Numbers under a name for time, or that never fall and have a unit of time; of a file without names the first."""
    numeric = [c for c in source.cells if source.is_numeric(c)]
    by_name = [c for c in numeric if is_time(source.labels[c])]
    by_unit = [c for c in numeric if _unit_of_time(source, c) and rises(source, c)]
    candidates = [c for c in (*by_name, *by_unit) if c != TIME]
    is_count = source.file.suffix.lower() == ".tdms" and TIME in by_name and _counts(source.numbers(TIME))
    if TIME in by_name and source.file.suffix.lower() in BINARY and not (candidates and is_count):
        return Clock(source.numbers(TIME), source.start, (TIME,), "the format's own time")
    if candidates or TIME in by_name:
        return _scaled(source, candidates[0] if candidates else TIME)
    return _scaled(source, numeric[0]) if source.unnamed and rises(source, numeric[0]) else None


def is_time(label: str) -> bool:
    """Is it a name for time?  A small t is one, a large T a temperature."""
    words = re.split(r"[^a-zäöü]+", label.lower())
    return label == "t" or bool(WORDS & set(words[:2]))


def rises(source: Source, column: str) -> bool:
    """Numbers that never fall."""
    if not source.is_numeric(column):
        return False
    values = source.numbers(column)
    finite = values[np.isfinite(values)]
    return finite.size > 2 and bool((np.diff(finite) >= 0).all()) and bool(finite[-1] > finite[0])


def _unit_of_time(source: Source, column: str) -> str:
    """Of the header's unit, or of a header that is nothing else: "Minutes"; "" where it is none."""
    for text in (source.units[column], source.labels[column]):
        if (unit := unit_of(text)) in QUANTITIES["time"].units:
            return unit
    return ""


def _counts(values: Array) -> bool:
    return bool(np.array_equal(values, np.arange(values.size)))


def _scaled(source: Source, column: str) -> Clock:
    """Seconds by the unit of the file; without one by size: seconds since 1970, days of a spreadsheet, else seconds."""
    values, unit = source.numbers(column), _unit_of_time(source, column)
    if unit:
        return Clock(values * QUANTITIES["time"].units[unit][0], None, (column,), f"numbers in {unit}")
    first = float(values[np.isfinite(values)][0])
    for size, factor in UNIX.items():
        if size <= first < 5 * size:
            start = first * factor
            return Clock((values - first) * factor, start, (column,), "seconds since 1970")
    step = float(np.nanmedian(np.diff(values)))
    if 3e4 < first < 7e4 and step < 0.5:
        return Clock((values - first) * DAY_S, None, (column,), "days of a spreadsheet")
    return Clock(values, None, (column,), "numbers, taken as seconds", False)
