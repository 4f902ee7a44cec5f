"""Rows of a recording as they come, under the sheet of one of the case's tests: a file, or a pipe that still grows."""

from __future__ import annotations

import csv
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TextIO

import numpy as np

from thermoscope import InputError, Network
from thermoscope.plugin import Array, Column, Sheet, as_number, converted, suggestion

TOGETHER = 500  # rows of a file that are read at once
PIPE = "-"


@dataclass(frozen=True)
class Rows:
    """time (n,) s;  inputs, boundaries : name -> (n,);  readings : sensor -> (n,) degC, NaN where nothing was read"""

    time: Array
    inputs: dict[str, Array]
    boundaries: dict[str, Array]
    readings: dict[str, Array]


@contextmanager
def open_stream(name: str) -> Iterator[TextIO]:
    """A file, or stdin for "-"."""
    if name == PIPE:
        yield sys.stdin
        return
    path = Path(name)
    if not path.is_file():
        raise InputError("no such file", name, "a CSV file, or - for rows from a pipe")
    with path.open("rb") as raw:
        packed = raw.read(2) == b"\x1f\x8b"
    import gzip

    with gzip.open(path, "rt", encoding="utf-8-sig") if packed else path.open(encoding="utf-8-sig") as stream:
        yield stream


@dataclass
class LiveTable:
    """The columns of a stream.  sheet : what they are;  network : what must be given;  header : names in the stream"""

    sheet: Sheet
    network: Network
    header: Sequence[str]
    where: str
    line: int = 1
    last: dict[str, float] = field(default_factory=dict)
    time: float = -np.inf

    def missing(self) -> list[str]:
        """Columns without which nothing runs."""
        needed = [self.sheet.time] if self.sheet.time else []
        needed += [c.header for c in self.sheet.columns if self._drives(c)]
        return [name for name in needed if name not in self.header]

    def _drives(self, c: Column) -> bool:
        laws = [*(x.law for x in self.network.links), *(x.law for x in self.network.sources)]
        read = {name for law in laws for name in law.reads}
        read |= {feeds for name, of in self.sheet.squares.items() if name in read for feeds in self._feeds(of)}
        return c.place in self.network.boundaries if c.is_temperature else c.feeds in read

    def _feeds(self, columns: Sequence[str]) -> list[str]:
        return [c.feeds for c in self.sheet.columns if c.name in columns]

    def sensors(self) -> list[str]:
        """Sensors of the machine that the stream has."""
        names = [c.name for c in self._columns() if c.is_temperature and c.place not in self.network.boundaries]
        inside = {name for mean in self.sheet.means for name in mean.of}
        means = [m.name for m in self.sheet.means if set(m.of) <= set(names)]
        return [*(name for name in names if name not in inside), *means]

    def _columns(self) -> list[Column]:
        return [c for c in self.sheet.columns if c.header in self.header]

    def rows(self, lines: Sequence[Sequence[str]]) -> Rows:
        """Some lines, checked and converted; inputs and boundaries hold where nothing was read."""
        columns, first = self._columns(), self.line + 1
        self.line += len(lines)
        values = {c.name: self._values(c, lines, first) for c in columns}
        values |= {c.name: self._forward_fill(c.name, values[c.name], first) for c in columns if self._outside(c)}
        time = self._times(lines, first)
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

    def _outside(self, c: Column) -> bool:
        """Is it an input or a boundary?"""
        return c.place in self.network.boundaries if c.is_temperature else True

    def _values(self, c: Column, lines: Sequence[Sequence[str]], first: int) -> Array:
        at = self.header.index(c.header)
        raw = np.array([self._number(line, at, c.header, first + i) for i, line in enumerate(lines)])
        read = c.in_memory(raw)
        return np.asarray(read if c.electrical is None else c.electrical.temperature(read), float)

    def _number(self, line: Sequence[str], at: int, name: str, number: int) -> float:
        value = as_number(line[at]) if at < len(line) else np.nan
        if value is None:
            where = f"{self.where} line {number}, column '{name}'"
            raise InputError(f"'{line[at].strip()[:40]}' is no number", where, "a number, or nothing")
        return value

    def _forward_fill(self, name: str, values: Array, first: int) -> Array:
        if not np.isfinite(values[0]):
            if name not in self.last:
                raise InputError(
                    f"column '{name}' begins with no number",
                    f"{self.where} line {first}",
                    "what drives the machine from the first row on",
                )
            values[0] = self.last[name]
        at = np.maximum.accumulate(np.where(np.isfinite(values), np.arange(values.size), 0))
        self.last[name] = float(values[at[-1]])
        return np.asarray(values[at], float)

    def _times(self, lines: Sequence[Sequence[str]], first: int) -> Array:
        if not self.sheet.time:
            return np.asarray((first - 2.0 + np.arange(len(lines))) * self.sheet.period_s, float)
        at = self.header.index(self.sheet.time)
        raw = np.array([self._number(line, at, self.sheet.time, first + i) for i, line in enumerate(lines)])
        time = np.asarray(converted(raw, "time", self.sheet.time_unit), float)
        wrong = np.flatnonzero(~(np.diff(time, prepend=self.time) > 0.0))
        if wrong.size:
            raise InputError(
                f"time {raw[wrong[0]]:g} does not come after the one before",
                f"{self.where} line {first + wrong[0]}",
                "times that rise from row to row",
            )
        self.time = float(time[-1])
        return time


def table_of(
    stream: TextIO, where: str, sheets: Mapping[str, Sheet], network: Network, like: str | None
) -> tuple[str, LiveTable, Iterator[list[str]]]:
    """The test whose sheet fits a stream, the stream's columns under it, and the lines that follow."""
    lines = csv.reader(stream, skipinitialspace=True)
    try:
        header = [cell.strip() for cell in next(lines, [])]
    except (csv.Error, UnicodeError) as fault:
        raise InputError(f"not readable as CSV: {fault}", where, "commas between columns, one header line") from None
    if not header:
        raise InputError("holds no row", where, "a header line and rows of numbers")
    if like is not None and like not in sheets:
        raise InputError(f"no test '{like}'", "--like", suggestion(like, sheets))
    tables = {n: LiveTable(s, network, header, where) for n, s in sheets.items() if like in (None, n)}
    for name, one in tables.items():
        if not one.missing():
            return name, one, lines
    name = next(iter(tables))
    lacks = tables[name].missing()[0]
    raise InputError(
        f"column '{lacks}' is not in the header", f"{where} (read as test '{name}')", suggestion(lacks, header)
    )


def together(lines: Iterator[list[str]], most: int) -> Iterator[list[list[str]]]:
    """Lines some at a time; empty ones are left out."""
    part: list[list[str]] = []
    for line in lines:
        if line:
            part.append(line)
        if len(part) >= most:
            yield part
            part = []
    if part:
        yield part
