"""A table that still grows, such as a pipe: found by its first rows as in a file, then read row by row."""

from collections.abc import Iterator
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import IO, cast

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from geom.limits import BYTES, COLUMNS
from measured.headers.cells import number
from measured.headers.layout import Layout
from measured.headers.rows import first_row_layout, layout
from measured.importing.clock import LEAST, Clock, clock_of
from measured.importing.source import Source, source_of_table
from measured.importing.text import decoded, delimiter, split_cells
from measured.recordings.csv_file import check_row
from measured.recordings.data_table import DataTable
from measured.recordings.formats import TIME

FIRST = 200  # lines that are waited for until there is a table in them


class Stream:
    """The lines of a stream, and the table in them.  where : its name"""

    def __init__(self, source: IO[bytes], where: str) -> None:
        lines = iter(partial(source.readline, BYTES.most + 1), b"")
        self.where, self.lines, self.head = where, (self._text(line) for line in lines), list[str]()
        self.sign, self.plan = ",", cast("Layout | None", None)
        for line in islice(self.lines, FIRST):
            self.head.append(line)
            self.sign = delimiter(self.head)
            try:
                self.plan = layout(split_cells(self.head, self.sign), where)
                break
            except InputError:  # there may be a table once more rows are there
                continue
        if self.plan is None and any(map(str.strip, self.head)):
            self.plan = first_row_layout(split_cells(self.head, self.sign), where)
        COLUMNS.check(self.plan.width if self.plan else 0, where, "holds")

    def _text(self, line: bytes) -> str:
        BYTES.check(len(line), self.where, "has a line of")
        return decoded(line, Path(self.where))

    def _rows(self) -> Iterator[tuple[int, list[str]]]:
        """Line and cells of every row of readings."""
        if self.plan is None:
            return
        least = max((i for i, name in enumerate(self.plan.names, 1) if name.strip()), default=0)
        for line, text in enumerate(chain(self.head[self.plan.first :], self.lines), self.plan.first + 1):
            (cells,) = split_cells([text], self.sign) or [[]]
            if any(cells) and not text.startswith("#"):
                check_row(cells, least, self.plan.width, f"{self.where} line {line}")
                yield line, [*cells, *[""] * self.plan.width][: self.plan.width]

    def tables(self) -> Iterator[DataTable]:
        """Rows under the names of the stream: none at first, then one by one; decimal commas are points."""
        if self.plan is None:
            return
        names = [name or f"column {j + 1}" for j, name in enumerate(self.plan.names)]
        units = self.plan.units_by_name
        yield DataTable.of(((name, ()) for name in names), Path(self.where), units=units)
        for line, cells in self._rows():
            if self.sign != ",":
                cells = [cell if number(cell) != number(cell) else f"{number(cell)!r}" for cell in cells]
            pairs = zip(names, ([cell] for cell in cells), strict=True)
            yield DataTable.of(pairs, Path(self.where), line=line, units=units)

    def imported(self) -> Iterator[DataTable]:
        """Rows as the tests of a case have them: time_s by the clock of the stream, and numbers under their headers.

        How its clock is read, its first rows tell; the others follow one by one, each so long after the row before as
        the clock says. InputError where there is none, and where it reads otherwise from some row on.
        """
        rows = self._rows()
        window = [*islice(rows, LEAST)]
        source, first = self._timed(window)
        time = float(first.seconds[-1])
        yield self._numbers(source, first, first.seconds, window[0][0])
        for line, cells in rows:
            window = [*window[-LEAST:], (line, cells)]
            source, clock = self._timed(window)
            if clock.words != first.words:
                raise InputError(f"a clock of {clock.words}", f"{self.where} line {line}", f"{first.words}, as before")
            time += float(clock.seconds[-1] - clock.seconds[-2])
            yield self._numbers(source, first, np.array([time]), line)

    def _timed(self, rows: list[tuple[int, list[str]]]) -> tuple[Source, Clock]:
        if self.plan is None or len(rows) < LEAST:
            raise InputError("fewer than three rows", self.where, "a header line and rows of numbers")
        columns = [list(column) for column in zip(*(cells for _, cells in rows), strict=True)]
        source = source_of_table(Path(self.where), self.plan, columns, ())
        clock = clock_of(source)
        clock.check(self.where)
        return source, clock

    def _numbers(self, source: Source, clock: Clock, seconds: Array, line: int) -> DataTable:
        """The last rows of a window."""
        names = [c for c in source.columns if c not in (TIME, *clock.columns)]
        columns = {name: source.numbers(name)[-seconds.size :] for name in names}
        doubt = (f"{self.where}: {clock.doubt}",) if clock.doubt else ()
        return DataTable.of({TIME: seconds, **columns}.items(), Path(self.where), line=line, notes=doubt)
