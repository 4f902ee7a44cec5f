"""A case folder from drafts: case.toml, tests/NAME.csv with tests/NAME.toml, all of it or nothing."""

import os
import re
import shutil
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any
from uuid import uuid4

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from geom.escapes import toml_key, toml_value
from geom.storage import abandoned, cache_folder, locked, write_whole
from geom.text import visible
from measured.headers.cells import unit_of
from measured.headers.rows import NO_RECORD
from measured.headers.words import COMES_OUT, CONVERTED, GOES_IN, LOSS, quantities_of, roles_of, tokens
from measured.importing.clock import Clock, clock_of, in_time_order, on_one_clock, runs_of, tests_of
from measured.importing.draft import Draft, sample_of
from measured.importing.guess import Guess
from measured.importing.relations import is_equal
from measured.importing.source import (
    Source,
    explained,
    over_room,
    read_source,
    read_sources,
    source_of_recording,
    with_ends,
)
from measured.input_folders import within_inputs
from measured.recordings.data_table import DataTable, csv_text
from measured.recordings.grid import LONGEST_S
from measured.recordings.sheet import MAX_GAP_S

TIME = "time_s"
FEW = 12  # rows that show no relation
TOGETHER, ALWAYS = 0.95, 0.98  # correlation of two powers that pass through one machine; share of rows
EFFICIENCY = 0.5  # of a machine, at least
IDLE = 0.02  # of the largest
LEARNT_EXPONENT = '"input exponent" = 0.3'  # films follow speed and flow to the 0.5 to 0.8, iron to the 1 to 2
ROLES = ("calibrate", "validate", "hold-out")


def check_new_folder(folder: Path) -> None:
    """InputError where a case cannot be written."""
    if within_inputs(folder):
        raise InputError("a case keeps its inputs there", str(folder), "--out with a folder beside that case")
    if folder.exists():
        raise InputError("is there already", str(folder), "--out with the name of a new folder")
    if not folder.parent.is_dir():
        raise InputError("no such folder", str(folder.parent), "--out in a folder that is there")


@contextmanager
def folder_whole(folder: Path) -> Iterator[Path]:
    """A folder to fill that takes its place only when it is complete; gone if anything fails, or the process is told
    to end. Until then it is in the cache, where that is on the same disk, else hidden beside its place.

    What a killed process left of it counts for nothing, and goes with the next one.
    """
    check_new_folder(folder)
    start = _start_of(folder)
    for left in abandoned(start.parent, re.compile(rf"{re.escape(start.name)}\.[0-9a-f]{{32}}")):
        shutil.rmtree(left, ignore_errors=True)
    partial = start.with_name(f"{start.name}.{uuid4().hex}")
    with _unwound_by_termination():
        try:
            partial.mkdir()
            with locked(partial):
                yield partial
                os.rename(partial, folder)
        finally:
            shutil.rmtree(partial, ignore_errors=True)


def _start_of(folder: Path) -> Path:
    """Where a folder is begun: from there it can be renamed to its place."""
    cache = cache_folder()
    with suppress(OSError):
        cache.mkdir(parents=True, exist_ok=True)
        if os.access(cache, os.W_OK) and cache.stat().st_dev == folder.absolute().parent.stat().st_dev:
            return cache / "new"
    return folder.with_name(f".{folder.name}")


@contextmanager
def _unwound_by_termination() -> Iterator[None]:
    """A process that is told to end (SIGTERM) unwinds in here, as one that is interrupted does."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def write_case(
    folder: Path,
    name: str,
    model: Callable[[Path], str],
    drafts: Sequence[Draft],
    doubts: str = "",
    learnt: bool = False,
) -> None:
    """model : puts the machine or network into the folder and returns its line of case.toml;  doubts : to be repeated
    until the user takes them out;  learnt : from the readings of all tests but the one held out."""
    lines = [
        "# Written by thermoscope test new. Every line may be changed.",
        "[case]",
        f"name = {toml_value(name)}",
        model(folder),
        f"sample_s = {sample_of(drafts):g}",
        *[f"guesses = {toml_value(doubts)}   # compare repeats it: take out what you have checked"] * bool(doubts),
        "",
        *["[doubt]   # the exponents of a learnt network are 1 or 2, of no correlation", LEARNT_EXPONENT, ""] * learnt,
    ]
    for draft, role, names in zip(drafts, roles(len(drafts), learnt), sensor_names(drafts), strict=True):
        lines += [f"[tests.{toml_key(draft.name)}]", f'role = "{role}"', ""]
        for i, record in enumerate(draft.records):
            write_whole(folder / "tests" / _file(draft, i), csv_text(readings(record.source, record.clock)))
        write_whole(folder / f"tests/{draft.name}.toml", "\n".join(map(visible, _sheet(draft, names))) + "\n")
    write_whole(folder / "case.toml", "\n".join(map(visible, lines)))


def set_aside(folder: Path, odd: Sequence[str]) -> None:
    """Tests that taught no network are not fitted: effects are chosen with them."""
    import tomlkit

    document: Any = tomlkit.parse((folder / "case.toml").read_text(encoding="utf-8"))
    for name in odd:
        document["tests"][name]["role"] = "validate"
    write_whole(folder / "case.toml", tomlkit.dumps(document))


def roles(count: int, learnt: bool) -> list[str]:
    """The first test to fit, the last of three or more to hold out, the others to choose with.

    learnt : the network is learnt from the readings of them all, so they are fitted together as well
    """
    if count < 3:
        return list(ROLES[:count])
    return ["calibrate", *["calibrate" if learnt else "validate"] * (count - 2), "hold-out"]


def _file(draft: Draft, i: int) -> str:
    return f"{draft.name}.csv" if i == 0 else f"{draft.name}.recorder-{i + 1}.csv"


def read_runs(
    *files: Path, period_s: float | None = None, tell: Callable[[str], object] = str
) -> list[tuple[Source, Clock]]:
    """Recordings and their clocks, rows in order of time; one of each sheet, one from each row where it starts anew.

    A file of words beside others says what their columns are, or nothing.  period_s : between rows without a clock
    """
    sources, legends = list[Source](), list[Path]()
    for file in dict.fromkeys(files):
        tell(f"reading {file.name}")
        try:
            sources += read_sources(file)
        except InputError as fault:
            if NO_RECORD not in fault.what or len({*files}) == 1:
                raise
            legends.append(file)
    if not sources:
        read_sources(legends[0])
    for legend in legends:
        sources = explained(sources, legend)
    tests = [test for source in sources for test in tests_of(source)]
    runs = [run for test in tests for run in runs_of(with_loss(with_ends(over_room(test))), period_s)]
    return [with_clock(run, period_s) for run in runs]


def with_loss(source: Source) -> Source:
    """With what goes in less what comes out as a loss, and a note, where no loss and no current was recorded.

    Of two powers that go together and say no side, and of a converter's, whatever its currents, the larger goes in.
    """
    units, words = source.units, {c: {*tokens(label)} for c, label in source.labels.items() if source.is_numeric(c)}
    every = [c for c in words if unit_of(units[c]) in ("W", "kW")]
    ends, converted = ([c for side in of for c in every if words[c] & side] for of in ((GOES_IN, COMES_OUT), CONVERTED))
    beside_current = len(converted) != 2 and any("current" in quantities_of(source.labels[c]) for c in words)
    powers = [c for c in every if not roles_of(source.labels[c])]
    if len(converted) == 2:
        ends = sorted(converted, key=lambda c: -np.nansum(source.numbers(c)))
    elif len(ends) != 2 and len(powers) == 2 and not beside_current:
        ends = _sides(source, powers)
    lost = any(of & LOSS for of in words.values())
    if lost or beside_current or len(ends) != 2 or len({*ends}) != 2 or units[ends[0]] != units[ends[1]]:
        return source
    loss = source.numbers(ends[0]) - source.numbers(ends[1])
    equal = [c for c in words if c not in ends and is_equal(source.numbers(c), loss)]
    name = equal[0] if equal else "loss {} - {}".format(*ends)
    note = f"{source.file.name}: '{name}' is of all between them; what each part loses is not recorded"
    cells, notes = {**source.cells, name: source.cells[name] if equal else loss}, (*source.notes, note)
    labels = {**source.labels, name: f"loss {name}" if equal else name}
    return replace(source, cells=cells, labels=labels, units={**units, name: units[ends[0]]}, notes=notes, values={})


def _sides(source: Source, powers: list[str]) -> list[str]:
    """The two powers in the order in which they pass through a machine; none where they do not go together."""
    a, b = (source.numbers(c) for c in powers)
    good = np.isfinite(a) & np.isfinite(b)
    if good.sum() < FEW or np.ptp(a[good]) == 0.0 or np.ptp(b[good]) == 0.0:
        return []
    if not np.corrcoef(a[good], b[good])[0, 1] > TOGETHER:
        return []
    a, b = a[good], b[good]
    on = np.abs(a) > IDLE * np.abs(a).max()
    more, ratio = float(np.mean((a >= b)[on])), float(np.abs(b[on]).sum() / np.abs(a[on]).sum())
    if more > ALWAYS and ratio > EFFICIENCY:
        return powers
    return powers[::-1] if more < 1.0 - ALWAYS and ratio < 1.0 / EFFICIENCY else []


def with_clock(source: Source, period_s: float | None = None) -> tuple[Source, Clock]:
    """With its clock, rows in the order of time.  InputError for times that run back, and for more than a year."""
    source = on_one_clock(source)
    try:
        clock = clock_of(source, period_s)
    except InputError:
        source = in_time_order(source)
        clock = clock_of(source, period_s)
    span = float(np.nanmax(clock.seconds) - np.nanmin(clock.seconds))
    if span > LONGEST_S:
        what = f"its rows span {span:.3g} s"
        raise InputError(what, str(source.file), "at most a year: the clock in seconds, or --period")
    return source, clock


def readings(source: Source, clock: Clock) -> dict[str, NDArray[np.float64]]:
    """Time (s) and all columns of numbers as the file has them; rows without a time of their own are left out."""
    t = clock.seconds
    keep = np.flatnonzero(np.isfinite(t))
    keep = keep[np.concatenate([[True], np.diff(t[keep]) > 0])]
    rows = slice(None) if keep.size == t.size else keep  # which needs no memory
    columns = [c for c in source.columns if c not in (TIME, *clock.columns) and source.is_numeric(c)]
    body = {c: source.numbers(c)[rows] for c in columns}
    return {TIME: t[rows], **{c: np.where(np.isinf(v), np.nan, v) if np.isinf(v).any() else v for c, v in body.items()}}


def imported_table(file: Path, whole: DataTable | None = None) -> DataTable:
    """A recorder's own file as the tests of a case have it: time_s, and columns of numbers under their names.

    whole : what read_recording gave of it, where it has been read.  InputError where nothing in it says how far its
    rows are apart.
    """
    source, clock = with_clock(source_of_recording(file, whole) if whole else read_source(file))
    clock.check(file)
    doubt = (f"{file.name}: {clock.doubt}",) if clock.doubt else ()
    return DataTable.of(readings(source, clock).items(), file, notes=doubt)


def sensor_names(drafts: Sequence[Draft]) -> list[dict[str, str]]:
    """Of every test, column -> the name that it has in the first of the tests: "T1 (degC)" is "T1" of another file.

    A sensor that a file writes otherwise is still the same, for its offset, its limit and the tests that are held out.
    """
    out, first = [], dict[tuple[str, str], str]()
    for draft in drafts:
        names = {g.column: g.column for g in draft.guesses}
        for record in draft.records:
            for g in (g for g in record.guesses if g.place):
                name = first.setdefault((record.source.labels[g.column].strip().lower(), g.place), g.column)
                if name not in (*names, *names.values()):  # two columns are never one sensor
                    names[g.column] = name
        out.append(names)
    return out


def _sheet(draft: Draft, names: Mapping[str, str]) -> Iterator[str]:
    first = draft.records[0]
    yield f"# Guessed by thermoscope test new from {', '.join(r.name for r in draft.records)}; all may be changed."
    yield from (f"# {note}" for note in draft.notes)
    description = visible(f"{first.name}, {first.clock.words}")
    yield from (
        "",
        "[test]",
        f'time = "{TIME}"',
        f"description = {toml_value(description)}",
        'initial = "first-readings"',
    )
    for name, value in zip(("from_s", "to_s"), draft.window_s, strict=True):
        if value:
            yield f"{name} = {value:g}"
    if first.gap_s > MAX_GAP_S:
        yield f"max_gap_s = {first.gap_s:g}   # rows are uneven or missing, or written where something changes"
    yield from _constants("inputs", draft.constants)
    yield from _constants("boundaries", draft.boundaries)
    if draft.squares:
        yield from ("", "[root_sum_square]")
        yield from (f"{toml_key(n)} = {toml_value(list(of))}" for n, of in draft.squares.items())
    for i, record in enumerate(draft.records[1:], 1):
        yield from (
            "",
            f"[recorders.recorder-{i + 1}]   # {record.name}",
            f"file = {toml_value(_file(draft, i))}",
            f'time = "{TIME}"',
            f"shift_s = {record.shift_s:.6g}   # {record.how}",
        )
    for guess in draft.guesses:
        yield from _column(guess, names[guess.column])


def _constants(table: str, values: object) -> Iterator[str]:
    if isinstance(values, dict) and values:
        yield from ("", f"[{table}]   # constant: not recorded")
        yield from (f"{toml_key(name)} = {value:g}" for name, value in values.items())


def _column(g: Guess, name: str) -> Iterator[str]:
    """A column's table under a name; of one that is left out a line that says why."""
    yield ""
    if not g.used:
        yield f"# {toml_value(g.column)} is left out: {g.doubt}"
        return
    yield f"[columns.{toml_key(name)}]" + (f"   # {g.doubt}" if g.doubt else "")
    if name != g.column:
        yield f"column = {toml_value(g.column)}"
    yield f'quantity = "{g.quantity}"'
    yield f'unit = "{g.unit}"'
    yield f"place = {toml_value(g.place)}" if g.place else f"input = {toml_value(g.feeds)}"
