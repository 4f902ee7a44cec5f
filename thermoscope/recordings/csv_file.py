"""CSV files, plain or packed: whole, text, not endless, and a name for every column."""

from __future__ import annotations

import csv
import gzip
import io
import zlib
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

CHUNK, LARGEST = 2**24, 2**30  # bytes; a day of 100 channels at 1 Hz is a tenth of that
SMALL = 2**20  # bytes; so many readings take NumPy less time than pandas needs to be loaded
MOST_COLUMNS, MOST_LINES = 10_000, 50_000_000  # what so many bytes of readings cannot exceed


class NumberTable(dict[str, NDArray[np.float64]]):
    """Columns of equal length that hold numbers only, NaN where that was written."""

    @property
    def columns(self) -> list[str]:
        return list(self)

    def __len__(self) -> int:
        """Rows."""
        return len(next(iter(self.values())))


def read_numbers(file: Path) -> NumberTable | None:
    """The table of a small CSV file in which every cell is a number; None for any other (read_csv reads them all)."""
    content = _content(file)
    if len(content) > SMALL or b'"' in content or content.strip().count(b"\n") == 0:
        return None
    names = [name.strip() for name in _header(file, content)]
    _complete(file, content, names)
    try:
        body = np.loadtxt(io.BytesIO(content), delimiter=",", skiprows=1, ndmin=2, comments=None, encoding="utf-8")
    except ValueError:
        return None
    if body.shape[1] != len(names) or len(set(names)) < len(names):
        return None
    return NumberTable(zip(names, np.ascontiguousarray(body.T)))


def read_csv(file: Path) -> pd.DataFrame:
    """The table of a CSV file under its own header."""
    import pandas as pd

    content = _content(file)
    try:
        header = _header(file, content)
        _complete(file, content, header)
        table = pd.read_csv(io.BytesIO(content), skipinitialspace=True, low_memory=False, index_col=False)
    except pd.errors.EmptyDataError:
        raise InputError("the file is empty", str(file), "a header line and rows of numbers") from None
    except (pd.errors.ParserError, csv.Error, UnicodeError) as fault:
        why = str(fault).rpartition("C error: ")[2]
        right = "commas between columns, one header line, quotation marks in pairs"
        raise InputError(f"not readable as CSV: {why}", str(file), right) from None
    if len(header) == len(table.columns):
        table.columns = header  # pandas would rename a second column of one name
    return table


def _header(file: Path, content: bytes) -> list[str]:
    """The names of the columns; InputError where the first row has more values than there are names."""
    with io.TextIOWrapper(io.BytesIO(content), encoding="utf-8", newline="") as text:
        header, first = [*islice(csv.reader(text, skipinitialspace=True), 2), [], []][:2]
    if b"\n" not in content and b"\r" in content:
        raise InputError("its lines end with CR alone", str(file), "lines that end with LF or CR LF: save it again")
    for sign, name in ((";", "';'"), ("\t", "tabs")):
        if len(header) == 1 and sign in header[0]:
            raise InputError(f"columns are separated by {name}", str(file), "commas between columns, points in numbers")
    if len(header) > MOST_COLUMNS:
        raise InputError(f"has {len(header)} columns", f"{file} line 1", f"at most {MOST_COLUMNS}")
    if any(cell.strip() for cell in first[len(header) :]):
        raise InputError(f"{len(first)} values under {len(header)} names", f"{file} line 2",
                         "as many as names: decimal commas become points, the header is line 1")  # fmt: skip
    return header


def _complete(file: Path, content: bytes, header: list[str]) -> None:
    """A row that ends early was cut off, mostly within a number: what is left of that would be a wrong reading."""
    if content.count(b"\n") > MOST_LINES:
        raise InputError(f"has more than {MOST_LINES} lines", str(file), "a shorter recording")
    if b'"' in content:
        return  # commas and line breaks within quotes are no ends
    least = max((i for i, name in enumerate(header, 1) if name.strip()), default=0)
    for number, line in enumerate(io.BytesIO(content), 1):
        columns = line.count(b",") + 1
        if columns < least and line.strip():
            raise InputError(f"{columns} values under {least} names: the row was cut off", f"{file} line {number}",
                             "a whole row (commas where nothing was read), or none: delete it")  # fmt: skip
        if columns > len(header) and any(cell.strip() for cell in line.split(b",")[len(header) :]):
            raise InputError(f"{columns} values under {len(header)} names", f"{file} line {number}",
                             "as many as names: decimal commas become points")  # fmt: skip


def _content(file: Path) -> bytes:
    """The whole of a CSV file, unpacked; nothing that is no UTF-8 text, and nothing too large to be a test."""
    packed = file.name.lower().endswith(".gz")
    parts: list[bytes] = []
    try:
        with gzip.open(file) if packed else file.open("rb") as source:
            while part := source.read(CHUNK):
                parts.append(part)
                if b"\0" in part:
                    raise InputError("holds zero bytes, so it is no text", str(file), "CSV as UTF-8 text")
                if len(parts) * CHUNK > LARGEST:
                    raise InputError(f"holds more than {LARGEST / 2**20:.0f} MB", str(file), "a shorter recording")
        content = b"".join(parts).removeprefix(b"\xef\xbb\xbf")
        content.decode("utf-8")
    except UnicodeDecodeError as fault:
        raise InputError(f"is no UTF-8 text: {fault.reason} at byte {fault.start}", str(file),
                         "CSV saved as UTF-8") from None  # fmt: skip
    except (OSError, EOFError, zlib.error) as fault:
        kind = "gzip" if packed else "CSV"
        raise InputError(f"not readable as {kind}: {fault}", str(file), "a whole file of that kind") from None
    return content
