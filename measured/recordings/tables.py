"""Recordings into clean arrays: every fault is one message with file, column and line; every doubt is a note."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array, Ints
from geom.constants import ZERO_C
from geom.errors import InputError
from lumped.schemas.bounds import COLDEST, HOTTEST
from measured.headers.cells import unit_of
from measured.recordings.alignment import clock_shift, merged
from measured.recordings.data_table import HEADER, DataTable, cell, is_switch, numbers
from measured.recordings.formats import EPOCH, TIME, read_recording, recording
from measured.recordings.invalid_readings import FAR, LARGEST_THERMOCOUPLE, code_note, coded
from measured.recordings.sheet import Column, Recorder, Sheet
from measured.recordings.units import LARGEST, QUANTITIES, SWITCHED, converted
from measured.sensors.faults import longest_run

GAP, USUAL = 3.5, 95  # times the usual step; percentile of all: rows of up to twenty signals may come in bursts
FROZEN_SHARE, FROZEN_MOVE_K = 0.2, 2.0  # of the test without a change, while the others move by more
LEAST = 3  # rows of a test
IN_GAPS = "inputs are drawn straight across, nothing is compared there"


@dataclass(frozen=True)
class Samples:
    """time (n,) s from 0;  values : column -> (n,), NaN where nothing was read;  gaps : (from, to) s

    sigma_K : channel -> 1-sigma that follows from its readings, for sensors whose sheet gives none
    start_s, line : where the test begins in its recording, which may have been cropped, and in its file
    """

    file: Path
    time: Array
    values: Mapping[str, Array]
    gaps: tuple[tuple[float, float], ...] = ()
    notes: tuple[str, ...] = field(default=())
    sigma_K: Mapping[str, float] = field(default_factory=dict)
    start_s: float = 0.0
    line: int = HEADER


def load_table(path: Path, sheet: Sheet) -> Samples:
    """The columns the sheet uses, checked and converted."""
    file = recording(path)
    table = _merged(file, sheet)
    table.require(
        [*([sheet.time] if sheet.time else []), *(c.header for c in sheet.columns)],
        f"{file} (asked for by {sheet.where})",
    )
    time = _times(table, replace(sheet, time_unit="s") if sheet.recorders else sheet, file)
    rows = _window(time, sheet, file)
    time = time[rows]
    start, time, line = float(time[0]), time - time[0], table.line + rows.start
    gaps = _gaps(time)
    read = {c.name: numbers(table, c.header, file) for c in sheet.columns}
    filled = recorder_rows(read, bool(sheet.recorders))
    missing: dict[str, Ints] = {}
    values, sigma, notes = {}, {}, [f"{file.name}: no rows from {a:g} s to {b:g} s; {IN_GAPS}" for a, b in gaps]
    for column in sheet.columns:
        raw = read[column.name][rows]
        hot = column.is_temperature
        codes = coded(raw, 0.0 if hot else FAR) & (hot | (np.abs(raw) > LARGEST_THERMOCOUPLE))
        if not hot and codes.any():
            what = f"{int(codes.sum())} readings of {raw[codes][0]:g} are kept: a logger's code, or a reading?"
            notes.append(f"{file.name} column '{column.header}': {what}")
        elif column.electrical is None and codes.any():
            notes.append(code_note(f"{file.name} column '{column.header}'", raw, codes, line))
            raw = np.where(codes, np.nan, raw)
        if is_switch(table[column.header]) and column.quantity not in SWITCHED:
            raise InputError(
                f"holds true and false, no {column.quantity}",
                f"{file} column '{column.header}'",
                "numbers, or another column",
            )
        values[column.name], sensor_sigma = _in_memory(column, raw, file)
        if sensor_sigma is not None:
            sigma[column.name] = sensor_sigma
        notes += _other_unit(column, table.units.get(column.header, ""), file)
        missing[column.name] = _missing(column, values[column.name], file, line, filled[column.name][rows])
    notes += _missing_words(file, {name: rows for name, rows in missing.items() if rows.size}, line)
    return Samples(file, time, values, gaps, tuple(notes), sigma, start, line)


def _in_memory(column: Column, raw: Array, file: Path) -> tuple[Array, float | None]:
    """Values as memory holds them, and the 1-sigma (K) that follows from the readings where the sheet gives none."""
    read = column.in_memory(raw)
    if column.electrical is None:
        return read, column.deviation_K(raw) if column.sigma else None
    try:
        return column.electrical.temperature(read), None if column.sigma_K else column.electrical.sigma(read)
    except InputError as fault:
        raise InputError(fault.what, f"{file} column '{column.header}'", fault.right) from None


def _merged(file: Path, sheet: Sheet) -> DataTable:
    """The recording, and those of other recorders moved to its clock."""
    main = read_recording(file, sheet.worksheet)
    if not sheet.recorders:
        return main
    time = sheet.time or TIME
    main = main.with_columns(**{time: _times(main, sheet, file)})
    return merged(main, time, {name: _beside(main, time, r) for name, r in sheet.recorders.items()}, sheet.where)


def _beside(main: DataTable, time: str, recorder: Recorder) -> tuple[DataTable, str, float]:
    """Table, time column and shift (s) of a second recorder."""
    file = recording(recorder.file)
    table, shift = read_recording(file, recorder.worksheet), recorder.shift_s
    table.require([recorder.time, *recorder.align[1:]], recorder.where)
    main.require(recorder.align[:1], recorder.where)
    seconds = converted(numbers(table, recorder.time, file), "time", recorder.time_unit)
    _rising(seconds, table, recorder.time, file)
    if recorder.align:
        here, there = recorder.align
        shift = clock_shift(
            main[time],
            numbers(main, here, file),
            seconds,
            numbers(table, there, file),
            recorder.limit_s,
            recorder.where,
        )
        if there == here:
            table = DataTable({name: column for name, column in table.cells.items() if name != there})
    return table.with_columns(**{recorder.time: seconds}), recorder.time, shift


def _times(table: DataTable, sheet: Sheet, file: Path) -> Array:
    if not sheet.time:
        return np.arange(table.rows, dtype=np.float64) * sheet.period_s
    t = seconds_of(table, sheet, file)
    _rising(t, table, sheet.time, file)
    return np.asarray(t - t[0], float)


def _rising(t: Array, table: DataTable, name: str, file: Path) -> None:
    """InputError where a time (s) of the column of this name is missing or no later than the one before."""
    column = table[name]
    missing = np.flatnonzero(np.isnan(t))
    if missing.size:
        raise InputError("a time is missing", cell(file, name, int(missing[0]), table.line), "a time in every row")
    wrong = np.flatnonzero(np.diff(t) <= 0)
    if wrong.size:
        row = int(wrong[0]) + 1
        what = "is given twice" if t[row] == t[row - 1] else f"comes after {_text(column[row - 1])}"
        count = f" ({wrong.size} such rows)" if wrong.size > 1 else ""
        raise InputError(
            f"time {_text(column[row])} {what}{count}",
            cell(file, name, row, table.line),
            "times that rise from row to row: sort the file by time and delete repeated rows",
        )


def _text(time: Any) -> str:
    """A number of seconds, an instant, or a word."""
    if isinstance(time, np.datetime64 | np.timedelta64):
        return str(time.astype(f"{time.dtype.kind}8[us]").item())
    return f"{time:.15g}" if isinstance(time, float) else str(time)


def seconds_of(table: DataTable, sheet: Sheet, file: Path) -> Array:
    """Of the column of times: numbers in its unit, or instants (since 1970) where the format has such."""
    column = table[sheet.time]
    if column.dtype.kind == "M":
        column = column - EPOCH
    if column.dtype.kind == "m":
        return np.asarray(column / np.timedelta64(1, "s"))
    try:
        return np.asarray(converted(numbers(table, sheet.time, file), "time", sheet.time_unit))
    except InputError as fault:
        right = f"{fault.right}; instants in words are read by thermoscope test new {file}"
        raise InputError(fault.what, fault.where, right) from None


def _gaps(time: Array) -> tuple[tuple[float, float], ...]:
    step = np.diff(time)
    long = np.flatnonzero(step > GAP * np.percentile(step, USUAL, method="lower"))
    return tuple((float(time[i]), float(time[i + 1])) for i in long)


def _window(time: Array, sheet: Sheet, file: Path) -> slice:
    """The rows from from_s to to_s."""
    inside = np.flatnonzero((time >= sheet.from_s) & (time <= sheet.to_s))
    if inside.size < LEAST:
        raise InputError(
            f"{inside.size} rows lie from {sheet.from_s:g} to {sheet.to_s:g} s",
            f"{sheet.where} [test]",
            f"from_s and to_s within the recording, 0 to {time[-1]:g} s",
        )
    return slice(int(inside[0]), int(inside[-1]) + 1)


def _other_unit(column: Column, text: str, file: Path) -> list[str]:
    """A note where the unit that the file gives, under its header or with its channels, is not that of the sheet."""
    unit, of, both = unit_of(text), column.quantity, np.array([0.0, 1.0])
    if unit not in QUANTITIES[of].units or np.allclose(converted(both, of, unit), converted(both, of, column.unit)):
        return []
    what = f"its file says {unit}; {column.unit} is taken, as the sheet says"
    return [f"{file.name} column '{column.header}': {what}"]


def recorder_rows(read: Mapping[str, Array], several: bool) -> dict[str, NDArray[np.bool_]]:
    """Column -> rows in which its recorder read anything: those of another recorder's clock lack nothing.

    read : column -> (rows,) readings;  several : are there other recorders?
    """
    if not several:
        return {name: np.ones(values.size, bool) for name, values in read.items()}
    filled = {name: ~np.isnan(values) for name, values in read.items()}
    return {
        name: np.logical_or.reduce([other for other in filled.values() if (other & rows).any()] or [rows])
        for name, rows in filled.items()
    }


def _missing_words(file: Path, missing: Mapping[str, Ints], first: int) -> list[str]:
    """A note on the rows without a reading of some columns, one for all of them."""
    if not missing:
        return []
    most = max(missing, key=lambda name: missing[name].size)
    where = f"column '{most}': {missing[most].size} missing readings, first in line {missing[most][0] + first}"
    more = f"; {sum(map(np.size, missing.values()))} in {len(missing)} columns" if len(missing) > 1 else ""
    return [f"{file.name} {where}{more}"]


def _missing(column: Column, values: Array, file: Path, first: int, awake: NDArray[np.bool_]) -> Ints:
    """Rows without a reading of one column; InputError for impossible temperatures.

    first : line at which the test begins;  awake : rows in which its recorder read anything
    """
    missing = np.flatnonzero(np.isnan(values) & awake)
    if np.isnan(values).all():
        raise InputError(
            "the column holds no number", f"{file} column '{column.name}'", "readings, or use = false in the sheet"
        )
    low, high = (COLDEST, HOTTEST) if column.is_temperature else (-LARGEST, LARGEST)
    out = np.flatnonzero(~((values >= low) & (values <= high)) & ~np.isnan(values))
    if out.size:
        what, row = "is below absolute zero" if values[out[0]] < -ZERO_C else "cannot be", int(out[0])
        unit = " degC" if column.is_temperature else ""
        raise InputError(
            f"{values[row]:g}{unit} {what if column.is_temperature else 'cannot be'}",
            cell(file, column.name, row, first),
            f"{low:g} to {high:g}{unit}: check the unit in the sheet, or leave the cell empty where nothing was read",
        )
    rows = np.diff(np.flatnonzero(~np.isnan(values)))
    # A column that is recorded less often lacks nothing
    slower = rows.size > LEAST and 1 < rows.min() >= rows.max() - 1
    return missing[:0] if column.electrical or slower else missing


def standing_still(columns: Iterable[Column], samples: Samples) -> dict[str, str]:
    """Doubts of temperatures that stand still for long while the others of `columns` move, by column."""
    hot = [c.name for c in columns if c.is_temperature]
    doubts, time, values = {}, samples.time, samples.values
    for name in hot:
        a, last = longest_run(values[name])
        b = last + 1
        others = [
            np.nanmax(v[a:b]) - np.nanmin(v[a:b]) for o in hot if o != name and np.isfinite(v := values[o])[a:b].any()
        ]
        if others and time[b - 1] - time[a] > FROZEN_SHARE * time[-1] and np.median(others) > FROZEN_MOVE_K:
            stands = f"stands at {values[name][a]:g} degC from {time[a]:g} s to {time[b - 1]:g} s"
            where = f"{samples.file.name} column '{name}'"
            doubts[name] = f"{where}: {stands} while the others move; is the sensor frozen?"
    return doubts
