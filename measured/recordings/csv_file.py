"""CSV files, plain or packed: whole, text, not endless, and a name for every column."""

from __future__ import annotations

import csv
import gzip
import io
import re
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from geom.limits import COLUMNS
from geom.recording_bounds import CHUNK, check_text, timed
from measured.recordings.data_table import Column, DataTable, as_number, is_missing

COMMA, QUOTE, LF, CR = b',"\n\r'
NAN = np.frombuffer(b"nan", np.uint8)
BLOCK = 2**20  # bytes that are read at once; csv takes ten times as long for one as NumPy


def read_csv(file: Path) -> DataTable:
    """The table of a CSV file under its own header."""
    content = _content(file)
    if not content.strip():
        raise InputError("the file is empty", str(file), "a header line and rows of numbers")
    try:
        header, start = _header(file, content)
        columns = Body(file, header).columns(content, start)
    except (csv.Error, UnicodeError) as fault:
        right = "commas between columns, one header line, quotation marks in pairs"
        raise InputError(f"not readable as CSV: {fault}", str(file), right) from None
    return DataTable.of(zip(header, columns, strict=True), file)


@dataclass
class Body:
    """The rows under a header, read block by block; words : columns that hold words;  gaps : there are empty cells

    strict : a row that is cut off is refused, else its end is empty

    Both are learnt from the block that NumPy's reader cannot take as it is, so that it takes those that follow.
    """

    file: Path
    header: list[str]
    words: set[int] = field(default_factory=set)
    gaps: bool = False
    strict: bool = True

    def columns(self, content: bytes, start: int) -> list[Any]:
        """The cells from a byte on, column by column: numbers, or all cells of a column that has a word in it."""
        parts: list[Sequence[Any]] = []
        for at, block in timed(_blocks(content, start), self.file):
            if (part := self._quick(block)) is None and (part := self._slow(block, content, at)) is None:
                return _parsed(content[start:], len(self.header))
            parts.append(part)
        return [_joined([part[j] for part in parts]) for j in range(len(self.header))]

    def _quick(self, block: bytes) -> Sequence[Any] | None:
        """By NumPy's reader; None where it meets anything that is not as it was so far."""
        plain = _plain(block) if self.gaps else block
        return self._loaded(plain) if plain and plain.strip() else None

    def _loaded(self, block: bytes) -> Sequence[Any] | None:
        width = len(self.header)
        kinds = np.dtype([(f"{j}", object if j in self.words else float) for j in range(width)])
        try:
            rows = np.loadtxt(io.BytesIO(block), kinds, comments=None, delimiter=",", ndmin=1, encoding="utf-8")
        except ValueError:
            return None
        return [_numeric(rows[f"{j}"].tolist()) if j in self.words else rows[f"{j}"] for j in range(width)]

    def _slow(self, block: bytes, content: bytes, at: int) -> Sequence[Any] | None:
        """With its rows looked at one by one; None where quotation marks hold commas or line ends."""
        if self.strict and b'"' not in block:
            _complete(self.file, block, self.header, content.count(b"\n", 0, at) + 1)
        if (plain := _plain(block)) is None:
            return None
        self.gaps |= plain != block
        if plain.strip() and (part := self._loaded(plain)) is not None:
            return part
        columns = _parsed(plain, len(self.header))
        self.words |= {j for j, column in enumerate(columns) if isinstance(column, list)}
        return columns


def _blocks(content: bytes, start: int) -> Iterator[tuple[int, bytes]]:
    """Whole lines, so many at once, each with the byte at which they begin."""
    while start < len(content):
        end = content.find(b"\n", start + BLOCK) + 1 or len(content)
        yield start, content[start:end]
        start = end


def _plain(block: bytes) -> bytes | None:
    """With nan in empty cells, which NumPy's reader does not know, and without quotation marks around cells.

    None where such marks are anything else, so that commas and line ends may be within them.
    """
    lines = b"\n" + re.sub(rb", +", b",", block) + b"\n"
    signs = np.frombuffer(lines.replace(b'\n""', b"\nnan"), np.uint8)  # else a line of one empty cell would be blank
    comma, end = _limits(signs)
    if b'"' in block:
        mark, limit = signs == QUOTE, comma | end
        at = np.flatnonzero(mark)
        odd = np.cumsum(mark, dtype=np.uint8)[limit] % 2
        if odd.any() or not (limit[at - 1] | limit[at + 1]).all():
            return None
        signs = signs[~mark]
        comma, end = _limits(signs)
    empty = np.flatnonzero((comma[:-1] & (comma | end)[1:]) | (end[:-1] & comma[1:])) + 1
    return np.insert(signs, np.repeat(empty, 3), np.tile(NAN, empty.size))[1:-1].tobytes()


def _limits(signs: NDArray[np.uint8]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Where cells end at a comma, and where at the end of a line."""
    return signs == COMMA, (signs == LF) | (signs == CR)


def _parsed(block: bytes, width: int) -> list[Any]:
    """Columns by csv, whose rows may be shorter than the header; blank lines are none."""
    text = io.StringIO(block.decode("utf-8"), newline="")
    rows = [row for row in csv.reader(text, skipinitialspace=True, strict=True) if len(row) > 1 or "".join(row).strip()]
    if long := [row for row in rows if not all(map(is_missing, row[width:]))]:
        raise csv.Error(f"{len(long[0])} values under {width} names")
    return [_numeric([row[j] if j < len(row) else "" for row in rows]) for j in range(width)]


def _numeric(cells: list[str]) -> list[str] | Column:
    """As numbers, or as they are where one is a word."""
    values = {cell: as_number(cell) for cell in set(cells)}
    if None in values.values():
        return [cell.strip() for cell in cells]
    return np.array([values[cell] for cell in cells], float)


def _joined(parts: Sequence[Any]) -> Any:
    """One column of the parts of all blocks."""
    if any(isinstance(part, list) for part in parts):
        return [cell for part in parts for cell in part]
    return np.concatenate(parts) if parts else np.empty(0)


def _header(file: Path, content: bytes) -> tuple[list[str], int]:
    """The names of the columns and the byte after them.

    InputError where the first row has more values than there are names.
    """
    with io.TextIOWrapper(io.BytesIO(content), encoding="utf-8", newline="") as text:
        reader = csv.reader(text, skipinitialspace=True)
        header = next(reader, [])
        lines, first = reader.line_num, next(reader, [])
        text.seek(0)
        start = sum(len(line.encode()) for line in islice(text, lines))
    if b"\n" not in content and b"\r" in content:
        raise InputError("its lines end with CR alone", str(file), "lines that end with LF or CR LF: save it again")
    for sign, name in ((";", "';'"), ("\t", "tabs")):
        if len(header) == 1 and sign in header[0]:
            raise InputError(f"columns are separated by {name}", str(file), "commas between columns, points in numbers")
    COLUMNS.check(len(header), f"{file} line 1", "holds")
    if any(cell.strip() for cell in first[len(header) :]):
        raise InputError(
            f"{len(first)} values under {len(header)} names",
            f"{file} line 2",
            "as many as names: decimal commas become points, the header is line 1",
        )
    return header, start


def _complete(file: Path, block: bytes, header: list[str], first: int) -> None:
    """InputError for a row that was cut off or has more cells than names: what were readings would be others.

    first : line at which the block begins
    """
    least = max((i for i, name in enumerate(header, 1) if name.strip()), default=0)
    for number, line in enumerate(io.BytesIO(block), first):
        columns = line.count(b",") + 1
        if columns < least and line.strip():
            raise InputError(
                f"{columns} values under {least} names: the row was cut off",
                f"{file} line {number}",
                "a whole row (commas where nothing was read), or none: delete it",
            )
        if columns > len(header) and any(cell.strip() for cell in line.split(b",")[len(header) :]):
            raise InputError(
                f"{columns} values under {len(header)} names",
                f"{file} line {number}",
                "as many as names: decimal commas become points",
            )


def chunks(file: Path) -> Iterator[bytes]:
    """All of a file, unpacked, piece by piece; InputError where it is not whole, or too large to be a test."""
    try:
        with _opened(file) as source:
            check_text(source, file)
        with _opened(file) as source:
            while part := source.read(CHUNK):
                yield part
    except (OSError, EOFError, zlib.error) as fault:
        kind = "gzip" if file.name.lower().endswith(".gz") else "text"
        raise InputError(f"not readable as {kind}: {fault}", str(file), "a whole file of that kind") from None


def _opened(file: Path) -> IO[bytes]:
    return cast("IO[bytes]", gzip.open(file)) if file.name.lower().endswith(".gz") else file.open("rb")


def _content(file: Path) -> bytes:
    """The whole of a CSV file; nothing that is no UTF-8 text."""
    parts: list[bytes] = []
    for part in chunks(file):
        if b"\0" in part:
            raise InputError("holds zero bytes, so it is no text", str(file), "CSV as UTF-8 text")
        parts.append(part)
    content = b"".join(parts).removeprefix(b"\xef\xbb\xbf")
    try:
        content.decode("utf-8")
    except UnicodeDecodeError as fault:
        raise InputError(
            f"is no UTF-8 text: {fault.reason} at byte {fault.start}", str(file), "CSV saved as UTF-8"
        ) from None
    return content
