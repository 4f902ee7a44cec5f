"""CSV files, plain or packed: whole, text, not endless, and a name for every column."""

import csv
import gzip
import io
import re
import zlib
from codecs import getincrementaldecoder
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import chain, islice
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from geom.limits import COLUMNS
from geom.recording_bounds import CHUNK, check_text, timed
from measured.headers.layout import Layout, Row
from measured.recordings.data_table import Column, as_number, is_missing

COMMA, QUOTE, LF, CR = b',"\n\r'
NAN = np.frombuffer(b"nan", np.uint8)
MANY = "as many as names: decimal commas become points"
Finder = Callable[[Sequence[Row], str], Layout]
HEAD = 24  # rows that are enough where the header is nearly always the first
BLOCK = 2**20  # bytes that are read at once; csv takes ten times as long for one as NumPy


def csv_pieces(file: Path, find: Finder, size: int = BLOCK) -> tuple[Layout, int, Iterator[Sequence[Any]]]:
    """Where the table of a CSV file begins, the line of its first row, and its cells column by column, so many bytes at
    once.  find : tells from the first rows and the name of the file where the table begins"""
    blocks = cut_blocks(_checked(file, size), size)
    first = next(blocks, b"").removeprefix(b"\xef\xbb\xbf")
    if not first.strip():
        raise InputError("the file is empty: it holds no row", str(file), "a header line and rows of numbers")
    with _readable(file):
        plan, start, line = _layout(file, find, first)
    least = max((i for i, name in enumerate(plan.names, 1) if name.strip()), default=0)

    def pieces() -> Iterator[Sequence[Any]]:
        with _readable(file):
            yield from Body(file, plan.width, least).pieces(chain([first[start:]], blocks), line)

    return plan, line, pieces()


@contextmanager
def _readable(file: Path) -> Iterator[None]:
    try:
        yield
    except csv.Error as fault:
        right = "commas between columns, one header line, quotation marks in pairs"
        raise InputError(f"not readable as CSV: {fault}", str(file), right) from None


@dataclass
class Body:
    """The rows under a header, read block by block.

    width : columns;  least : cells of a row that is whole, 0 where its end may be empty
    words : columns that hold words;  gaps : there are empty cells
    Both are learnt from the block that NumPy's reader cannot take as it is, so that it takes those that follow.
    """

    file: Path
    width: int
    least: int = 0
    words: set[int] = field(default_factory=set)
    gaps: bool = False

    def columns(self, content: Iterable[bytes]) -> list[Any]:
        """All cells, column by column: numbers, or every cell of a column that has a word in it."""
        parts = [[*part] for part in self.pieces(cut_blocks(content), 1)]
        return [joined_parts([part.pop(0) for part in parts]) for _ in range(self.width)]

    def pieces(self, blocks: Iterator[bytes], line: int) -> Iterator[Sequence[Any]]:
        """The cells of whole lines.  line : that of the first of them"""
        for block in timed(blocks, self.file):
            part = self._quick(block) or self._slow(block, line) or _parsed(b"".join([block, *blocks]), self.width)
            line += block.count(b"\n")
            yield part

    def _quick(self, block: bytes) -> Sequence[Any] | None:
        """By NumPy's reader; None where it meets anything that is not as it was so far."""
        plain = _plain(block) if self.gaps else block
        return self._loaded(plain) if plain and plain.strip() else None

    def _loaded(self, block: bytes) -> Sequence[Any] | None:
        kinds = np.dtype([(f"{j}", object if j in self.words else float) for j in range(self.width)])
        try:
            rows = np.loadtxt(io.BytesIO(block), kinds, comments=None, delimiter=",", ndmin=1, encoding="utf-8")
        except ValueError:
            return None
        return [_numeric(rows[f"{j}"].tolist()) if j in self.words else rows[f"{j}"] for j in range(self.width)]

    def _slow(self, block: bytes, line: int) -> Sequence[Any] | None:
        """With its rows looked at one by one; None where quotation marks hold commas or line ends."""
        if self.least and b'"' not in block:
            self._complete(block, line)
        if (plain := _plain(block)) is None:
            return None
        self.gaps |= plain != block
        if plain.strip() and (part := self._loaded(plain)) is not None:
            return part
        columns = _parsed(plain, self.width)
        self.words |= {j for j, column in enumerate(columns) if isinstance(column, list)}
        return columns

    def _complete(self, block: bytes, first: int) -> None:
        """InputError for a row that was cut off or has more cells than names: what were readings would be others.

        first : line at which the block begins
        """
        for number, line in enumerate(io.BytesIO(block), first):
            if not self.least <= line.count(b",") + 1 <= self.width:
                check_row(line.split(b","), self.least, self.width, f"{self.file} line {number}")


def check_row(cells: Sequence[bytes] | Sequence[str], least: int, width: int, where: str) -> None:
    """InputError for a row of fewer cells than `least`, or more readings than names; a blank one is none."""
    if len(cells) < least and any(cell.strip() for cell in cells):
        right = "a whole row (commas where nothing was read), or none: delete it"
        raise InputError(f"{len(cells)} values under {least} names: the row was cut off", where, right)
    if any(cell.strip() for cell in cells[width:]):
        raise InputError(f"{len(cells)} values under {width} names", where, MANY)


def cut_blocks(parts: Iterable[bytes], size: int = BLOCK) -> Iterator[bytes]:
    """Whole lines of a text, so many bytes at once."""
    rest = b""
    for part in parts:
        rest, start = rest + part, 0
        while end := rest.find(b"\n", start + size) + 1:
            yield rest[start:end]
            start = end
        rest = rest[start:]
    if rest:
        yield rest


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
        return shared([cell.strip() for cell in cells])
    return np.array([values[cell] for cell in cells], float)


def shared(cells: Sequence[Any]) -> list[Any]:
    """Cells of which equal ones are one object: a million words of their own take a hundred megabytes."""
    one = dict(zip(cells, cells, strict=True))
    return [one[cell] for cell in cells]


def joined_parts(parts: Sequence[Any]) -> Any:
    """One column of the parts of all blocks."""
    if any(isinstance(part, list) for part in parts):
        return [cell for part in parts for cell in part]
    return np.concatenate(parts) if parts else np.empty(0)


def in_rows(pieces: Iterator[Sequence[Any]], most: int) -> Iterator[Sequence[Any]]:
    """Cells column by column, so many rows at once; the last time what is left."""
    rest = next(pieces, [()])
    for part in chain(pieces, [None]):
        while len(rest[0]) >= most:
            yield [column[:most] for column in rest]
            rest = [column[most:] for column in rest]
        rest = rest if part is None else [joined_parts(both) for both in zip(rest, part, strict=True)]
    if len(rest[0]):
        yield rest


def _layout(file: Path, find: Finder, content: bytes) -> tuple[Layout, int, int]:
    """Where the table begins, by row, by byte, and by line.

    InputError where the first row has more values than there are names.
    """
    if b"\n" not in content and b"\r" in content:
        raise InputError("its lines end with CR alone", str(file), "lines that end with LF or CR LF: save it again")
    with io.TextIOWrapper(io.BytesIO(content), encoding="utf-8", newline="") as text:
        reader = csv.reader(text, skipinitialspace=True)
        rows = [(row, reader.line_num) for row in islice(reader, HEAD)]
        text.seek(0)
        COLUMNS.check(max(len(row) for row, _ in rows), f"{file} line 1", "holds")
        plan = find([row for row, _ in rows], str(file))
        lines = rows[plan.first - 1][1]
        start = sum(len(line.encode()) for line in islice(text, lines))
    for sign, name in ((";", "';'"), ("\t", "tabs")):
        if plan.width == 1 and sign in plan.names[0]:
            raise InputError(f"columns are separated by {name}", str(file), "commas between columns, points in numbers")
    for row, line in rows[plan.first : plan.first + 1]:
        if any(cell.strip() for cell in row[plan.width :]):
            what = f"{len(row)} values under {plan.width} names"
            raise InputError(what, f"{file} line {line}", f"{MANY}, the header is line {lines}")
    return plan, start, lines + 1


def chunks(file: Path, size: int = CHUNK) -> Iterator[bytes]:
    """All of a file, unpacked, so many bytes at once; InputError where it is not whole, or too large to be a test."""
    try:
        with _opened(file) as source:
            check_text(source, file)
        with _opened(file) as source:
            while part := source.read(size):
                yield part
    except (OSError, EOFError, zlib.error) as fault:
        kind = "gzip" if file.name.lower().endswith(".gz") else "text"
        raise InputError(f"not readable as {kind}: {fault}", str(file), "a whole file of that kind") from None


def _opened(file: Path) -> IO[bytes]:
    return cast("IO[bytes]", gzip.open(file)) if file.name.lower().endswith(".gz") else file.open("rb")


def _checked(file: Path, size: int) -> Iterator[bytes]:
    """The bytes of a CSV file, piece by piece; nothing that is no UTF-8 text."""
    decode, start = getincrementaldecoder("utf-8")().decode, 0
    for part in chain(chunks(file, size), [b""]):
        if b"\0" in part:
            raise InputError("holds zero bytes, so it is not text", str(file), "CSV as UTF-8 text")
        try:
            decode(part, not part)
        except UnicodeDecodeError as fault:
            what = f"is no UTF-8 text: {fault.reason} at byte {start + fault.start}"
            raise InputError(what, str(file), "CSV saved as UTF-8") from None
        start += len(part)
        yield part
