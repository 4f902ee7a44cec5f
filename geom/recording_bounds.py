"""Recordings are counted before they are kept: bytes, rows and columns, in pieces that need no memory themselves."""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO, Any, TypeVar

from geom.errors import InputError
from geom.limits import BYTES, CELLS, COLUMNS, ROWS, ReadingTime

Piece = TypeVar("Piece")
CHUNK = 2**24  # bytes
SHEET_ROWS = 2**20  # of a worksheet: no program writes more
OF_CELLS = re.compile(rb"<(?:\w+:)?(?:c|v|f|is|t)\b")  # elements of a worksheet that are bounded as its cells are
DEEPEST = 1000  # elements in each other: a workbook has ten
DELIMITERS = (b",", b";", b"\t", b"|")


def check_text(source: IO[bytes], file: Path) -> None:
    """InputError where a text file, as it is unpacked, has more bytes, lines or cells than a recording may have."""
    size, lines, delimiters, clock = 0, [0, 0], [0] * len(DELIMITERS), ReadingTime(file)
    while part := source.read(CHUNK):
        size += len(part)
        lines = [n + part.count(end) for n, end in zip(lines, (b"\n", b"\r"), strict=True)]
        delimiters = [n + part.count(sign) for n, sign in zip(delimiters, DELIMITERS, strict=True)]
        BYTES.check(size, file, "holds at least")
        ROWS.check(max(lines), file, "holds at least")
        CELLS.check(max(delimiters), file, "holds at least")
        clock.check()


def check_elements(parts: Iterable[bytes], where: object) -> None:
    """InputError where a part of a workbook has more rows, texts and the like than a recording may have rows."""
    count, depth, end = 0, 0, b""
    for part in timed(parts, where):
        pairs, marks = end + part, part.count(b"<")
        closed = pairs.count(b"</")
        count += marks - closed - len(OF_CELLS.findall(part))
        depth += marks - 2 * closed - sum(map(pairs.count, (b"/>", b"<?", b"<!")))
        end = part[-1:]
        ROWS.check(count, where, "holds elements of")
        if depth > DEEPEST:
            raise InputError("holds elements in elements without end", str(where), "a workbook of plain tables")


def check_shape(rows: int, columns: int, where: object) -> None:
    """InputError where a table would have too many rows, columns or cells."""
    ROWS.check(rows, where, "holds")
    COLUMNS.check(columns, where, "holds")
    CELLS.check(rows * columns, where, "holds")


def timed(pieces: Iterable[Piece], where: object) -> Iterator[Piece]:
    """Pieces of a file as they are read; InputError once that has taken too long."""
    clock = ReadingTime(where)
    for piece in pieces:
        clock.check()
        yield piece


def counted_rows(rows: Iterable[tuple[Any, ...]], where: object) -> Iterator[tuple[Any, ...]]:
    """Rows of a sheet as they come, empty ones at their end cut off; InputError at the first that is too much."""
    cells, most_rows, most_columns, most_cells = 0, ROWS.most, COLUMNS.most, CELLS.most
    for number, row in enumerate(timed(rows, where), 1):
        cells += len(row)
        if number > SHEET_ROWS:
            raise InputError(f"holds more than {SHEET_ROWS:,} rows", str(where), "no more: larger tables as CSV")
        if number > most_rows or len(row) > most_columns or cells > most_cells:
            check_shape(number, len(row), where)
            CELLS.check(cells, where, "holds at least")
        yield row
