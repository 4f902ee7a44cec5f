"""A recording as columns of equal length: numbers, instants, true and false, or words."""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta
from decimal import Decimal
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array
from geom.errors import InputError
from lumped.schemas.reader import suggestion
from measured.headers.layout import MISSING

Column = NDArray[Any]
HEADER = 2  # line of the first row of numbers
PIECE = 50_000  # rows that are turned into Python's numbers at once, which take ten times as much memory
NUMBER = re.compile(r"[-+]?(?:(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|inf(?:inity)?)", re.ASCII | re.IGNORECASE)
SWITCH = {"true": True, "false": False}


@dataclass(frozen=True)
class DataTable:
    """cells : name -> (rows,) float with NaN where nothing was read; datetime64 and timedelta64; bool; or objects of
    any kind with None where nothing was read

    units : column -> unit as the file keeps it, apart from the name;  start : of its clock (s since 1970), if known
    notes : what is doubtful in the file;  line : of its first row;  remarks : column -> what the file says it is
    """

    cells: Mapping[str, Any]
    units: Mapping[str, str] = field(default_factory=dict)
    start: float | None = None
    notes: tuple[str, ...] = ()
    line: int = HEADER
    remarks: Mapping[str, str] = field(default_factory=dict)

    @classmethod
    def of(cls, columns: Iterable[tuple[object, Any]], file: Path, **about: Any) -> DataTable:
        """Of pairs (name, values) in the order of the file. InputError for a name that comes twice."""
        pairs = [(str(name).strip(), values) for name, values in columns]
        for repeated in twice(name for name, _ in pairs):
            raise InputError(f"column '{repeated}' stands twice in the header", str(file), "a name of its own for each")
        cells = {name: _typed(values) for name, values in pairs}
        if len(rows := {column.size for column in cells.values()}) > 1:
            raise InputError(f"columns have from {min(rows)} to {max(rows)} rows", str(file), "columns of equal length")
        return cls(cells, **about)

    @property
    def columns(self) -> list[str]:
        return list(self.cells)

    @property
    def rows(self) -> int:
        return len(next(iter(self.cells.values()), ()))

    def __getitem__(self, name: str) -> Column:
        return self.cells[name]

    def require(self, names: Iterable[str], where: str) -> None:
        """InputError for a column that is not there."""
        for name in names:
            if name not in self.cells:
                raise InputError(f"column '{name}' is not in the file", where, suggestion(name, self.columns))

    def cut(self, most: int) -> Iterator[DataTable]:
        """Parts of so many rows."""
        for i in range(0, self.rows, most):
            part = {name: column[i : i + most] for name, column in self.cells.items()}
            yield replace(self, cells=part, line=self.line + i)

    def with_columns(self, **columns: Column) -> DataTable:
        """With these columns, in place of those of the same name."""
        return replace(self, cells={**self.cells, **columns})


def _typed(values: Any) -> Column:
    """Values as the narrowest kind of column that holds them all."""
    if hasattr(values, "dtype") and np.ndim(values) == 1:
        column = np.asarray(values)
        if column.dtype.kind in "iuf":
            return np.asarray(column, float)
        if column.dtype.kind in "bmM":
            return column
        values = column.tolist()
    if set(map(type, values)) == {str}:
        return _of_words(values)
    cells = [None if is_missing(cell) else cell for cell in values]
    kinds = {type(cell) for cell in cells if cell is not None}
    if kinds <= {int, float}:
        return np.array(cells, float)  # None is NaN
    if kinds == {datetime}:
        return np.array([c and (c.astimezone(UTC).replace(tzinfo=None) if c.tzinfo else c) for c in cells], "M8[us]")
    if kinds == {timedelta}:
        return np.array(cells, "timedelta64[us]")
    return np.array(cells, bool) if kinds == {bool} and None not in cells else np.fromiter(cells, object, len(cells))


def _of_words(words: Sequence[str]) -> Column:
    """True and false where there is nothing else."""
    meaning: dict[str, Any] = {word: None if is_missing(word) else word for word in set(words)}
    if all(word is None or word.strip().lower() in SWITCH for word in meaning.values()):
        meaning = {word: value and SWITCH[value.strip().lower()] for word, value in meaning.items()}
    cells = np.fromiter(map(meaning.__getitem__, words), object, len(words))
    return cells.astype(bool) if set(meaning.values()) <= {True, False} else cells


def twice(names: Iterable[str]) -> list[str]:
    """The names that come more than once."""
    return [name for name, count in Counter(names).items() if count > 1]


def is_missing(cell: object) -> bool:
    """Does a cell say that nothing was read?"""
    if isinstance(cell, str):
        return cell.strip().lower() in MISSING
    return cell is None or (isinstance(cell, float | np.datetime64) and cell != cell)


def as_number(cell: object) -> float | None:
    """The number in a cell, NaN where nothing was read, None where it is not a number."""
    if isinstance(cell, str):
        text = cell.strip()
        return float(text) if NUMBER.fullmatch(text) else float("nan") if is_missing(text) else None
    if isinstance(cell, Real | Decimal):
        return float(cell)
    return float("nan") if is_missing(cell) else None


def numbers(table: DataTable, name: str, file: Path) -> Array:
    """A column as numbers, NaN where nothing was read; InputError with the line of what is no finite number."""
    column = table[name]
    values = np.asarray(column, float) if column.dtype.kind in "fb" else _numbers(table, name, file)
    endless = np.flatnonzero(np.isinf(values))
    if endless.size:
        raise InputError("the value is infinite", cell(file, name, int(endless[0]), table.line), "a finite number")
    return values


def _numbers(table: DataTable, name: str, file: Path) -> Array:
    """Of a column of words or instants."""
    column = table[name]
    if column.dtype.kind in "mM":
        raise InputError("holds instants, no numbers", f"{file} column '{name}'", "numbers, or another column")
    values = [as_number(word) for word in column]
    if None in values:
        row = values.index(None)
        raise InputError(
            f"'{column[row]}' is not a number",
            cell(file, name, row, table.line),
            "a number with a decimal point, or nothing where nothing was read",
        )
    return np.array(values, float)


def is_switch(column: Column) -> bool:
    """Does a column hold true and false?"""
    return column.dtype.kind == "b" or (column.dtype.kind == "O" and any(isinstance(word, bool) for word in column))


def cell(file: Path, column: str, row: int, first: int = HEADER) -> str:
    """Where a reading stands.  first : line of the first row"""
    return f"{file} column '{column}' line {row + first}"


def pairs(table: DataTable, time: str, column: str, file: Path) -> Array:
    """(n, 2) times and readings of two columns, where both are given."""
    both = np.column_stack([numbers(table, time, file), numbers(table, column, file)])
    return np.asarray(both[np.isfinite(both).all(axis=1)])


def rows_of(columns: Mapping[str, Sequence[Any] | Column]) -> list[list[Any]]:
    """Rows under their header, of Python's own types; None where a number is missing."""
    lists = [values.tolist() if isinstance(values, np.ndarray) else list(values) for values in columns.values()]
    plain = [[None if v != v else v for v in values] for values in lists]
    return [list(columns), *(list(row) for row in zip(*plain, strict=True))]


def csv_text(columns: Mapping[str, Sequence[Any] | Column]) -> Iterator[str]:
    """Columns as CSV, many rows at once: shortest numbers that read back the same, empty cells where there is none."""
    yield _csv([list(columns)])
    for i in range(0, max(map(len, columns.values()), default=0), PIECE):
        yield _csv(rows_of({name: values[i : i + PIECE] for name, values in columns.items()})[1:])


def _csv(rows: Iterable[Iterable[Any]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
