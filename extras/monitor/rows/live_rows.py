"""Rows of a recording as they come, under the sheet of one of the case's tests: a file, or a pipe that still grows."""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import chain
from pathlib import Path

import numpy as np

from thermoscope import InputError, Network, plugin as th

TOGETHER = 500  # rows of a file that are read at once
PIPE = "-"


@dataclass(frozen=True)
class Rows:
    """time (n,) s;  inputs, boundaries : name -> (n,);  readings : sensor -> (n,) degC, NaN where nothing was read"""

    time: th.Array
    inputs: dict[str, th.Array]
    boundaries: dict[str, th.Array]
    readings: dict[str, th.Array]


@dataclass
class LiveTable:
    """The columns of a stream.  sheet : what they are;  network : what must be given;  header : names in the stream

    first_line : of the rows
    """

    sheet: th.Sheet
    network: Network
    header: Sequence[str]
    where: str
    last: dict[str, float] = field(default_factory=dict)
    time: float = -np.inf
    first_line: int = 0

    def missing(self) -> list[str]:
        """Columns without which nothing runs."""
        needed = [self.sheet.time] if self.sheet.time else []
        needed += [c.header for c in self.sheet.columns if self._drives(c)]
        return [name for name in needed if name not in self.header]

    def _drives(self, c: th.Column) -> bool:
        read = self.network.inputs
        squared = {feeds for name, of in self.sheet.squares.items() if name in read for feeds in self._feeds(of)}
        return c.place in self.network.boundaries if c.is_temperature else c.feeds in read | squared

    def _feeds(self, columns: Sequence[str]) -> list[str]:
        return [c.feeds for c in self.sheet.columns if c.name in columns]

    def sensors(self) -> list[str]:
        """Sensors of the machine that the stream has."""
        names = [c.name for c in self._columns() if c.is_temperature and c.place not in self.network.boundaries]
        inside = {name for mean in self.sheet.means for name in mean.of}
        means = [m.name for m in self.sheet.means if set(m.of) <= set(names)]
        return [*(name for name in names if name not in inside), *means]

    def _columns(self) -> list[th.Column]:
        return [c for c in self.sheet.columns if c.header in self.header]

    def rows(self, table: th.DataTable) -> Rows:
        """Some rows, checked and converted; inputs and boundaries hold where nothing was read."""
        columns, file = self._columns(), Path(self.where)
        outside = [c for c in columns if not c.is_temperature or c.place in self.network.boundaries]
        values = {c.name: _values(c, table, file) for c in columns}
        values |= {c.name: self._forward_fill(c.name, values[c.name], table.line) for c in outside}
        time = self._times(table, file)
        inputs = {n: np.full(time.size, v) for n, v in self.sheet.inputs.items()}
        inputs |= {n: events.mean(time, 0.0) for n, events in self.sheet.events.items()}
        inputs |= {c.feeds: values[c.name] for c in columns if not c.is_temperature}
        for name, of in self.sheet.squares.items():
            parts = [inputs[feeds] for feeds in self._feeds(of) if feeds in inputs]
            if len(parts) == len(of):
                inputs[name] = np.sqrt(np.sum(np.square(parts), axis=0))
        air = {n: np.full(time.size, v) for n, v in self.sheet.boundaries.items()}
        air |= {c.place: values[c.name] for c in columns if c.is_temperature and c.place in self.network.boundaries}
        readings = {n: values[n] for n in self.sensors() if n in values}
        means = [m for m in self.sheet.means if m.name in self.sensors()]
        readings |= {m.name: np.mean([values[n] for n in m.of], axis=0) for m in means}
        return Rows(time, inputs, air, readings)

    def _forward_fill(self, name: str, values: th.Array, first: int) -> th.Array:
        if not np.isfinite(values[0]):
            if name not in self.last:
                what, right = f"column '{name}' begins with no number", "what drives the machine from the first row on"
                raise InputError(what, f"{self.where} line {first}", right)
            values[0] = self.last[name]
        at = np.maximum.accumulate(np.where(np.isfinite(values), np.arange(values.size), 0))
        self.last[name] = float(values[at[-1]])
        return np.asarray(values[at], float)

    def _times(self, table: th.DataTable, file: Path) -> th.Array:
        if not self.sheet.time:
            self.first_line = self.first_line or table.line
            return np.asarray((table.line - self.first_line + np.arange(table.rows)) * self.sheet.period_s, float)
        time = th.seconds_of(table, self.sheet, file)
        wrong = np.flatnonzero(~(np.diff(time, prepend=self.time) > 0.0))
        if wrong.size:
            what = f"time {table[self.sheet.time][wrong[0]]:g} does not come after the one before"
            where = f"{self.where} line {table.line + wrong[0]}"
            raise InputError(what, where, "times that rise from row to row")
        self.time = float(time[-1])
        return time


def _values(c: th.Column, table: th.DataTable, file: Path) -> th.Array:
    read = c.in_memory(th.numbers(table, c.header, file))
    return np.asarray(read if c.electrical is None else c.electrical.temperature(read), float)


def table_of(
    follow: str, most: int, sheets: Mapping[str, th.Sheet], network: Network, like: str | None
) -> tuple[str, LiveTable, Iterator[th.DataTable]]:
    """The test whose sheet fits a recording, its columns under it, and its rows, at most so many at once."""
    if like is not None and like not in sheets:
        raise InputError(f"no test '{like}'", "--like", th.suggestion(like, sheets))
    sheets = sheets if like is None else {like: sheets[like]}
    plain, imported = _readers(follow, most, next(iter(sheets.values())).worksheet)
    with th.each_book_once():
        try:
            return _fitting(follow, plain(), sheets, network)
        except InputError as fault:
            try:  # as a recorder writes it, which `new` has read too
                return _fitting(follow, imported(), sheets, network)
            except InputError:
                raise fault from None


def _readers(follow: str, most: int, worksheet: str) -> tuple[Callable[[], Iterator[th.DataTable]], ...]:
    """The rows of a recording under its own header, and as the tests of a case have them."""
    if follow == PIPE:
        stream = th.Stream(sys.stdin.buffer, PIPE)
        return stream.tables, stream.imported
    file = Path(follow)
    if not file.is_file():
        raise InputError("no such file", follow, "a recording, or - for rows from a pipe")
    if file.suffix.lower() in th.BINARY:  # read once for both
        whole = th.read_recording(file, worksheet, 0)
        return partial(whole.cut, most), lambda: th.imported_table(file, whole).cut(most)
    return partial(th.recording_pieces, file, most, worksheet), lambda: th.imported_table(file).cut(most)


def _fitting(
    follow: str, parts: Iterator[th.DataTable], sheets: Mapping[str, th.Sheet], network: Network
) -> tuple[str, LiveTable, Iterator[th.DataTable]]:
    """The first sheet that has what drives the machine."""
    first = next(parts, th.DataTable({}))
    if not first.columns:
        raise InputError("holds no row", follow, "a header line and rows of numbers")
    tables = {n: LiveTable(s, network, first.columns, follow) for n, s in sheets.items()}
    for fitting, one in tables.items():
        if not one.missing():
            th.notes(first.notes)
            return fitting, one, (part for part in chain([first], parts) if part.rows)
    name = next(iter(sheets))
    lacks, where = tables[name].missing()[0], f"{follow} (read as test '{name}')"
    raise InputError(f"column '{lacks}' is not in the header", where, th.suggestion(lacks, first.columns))
