"""CSV files, plain or packed: whole, text, not endless, and a name for every column."""

from __future__ import annotations

import csv
import gzip
import io
import zlib
from pathlib import Path
from typing import TYPE_CHECKING

from geom.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

CHUNK, LARGEST = 2**24, 2**30  # bytes; a day of 100 channels at 1 Hz is a tenth of that


def read_csv(file: Path) -> pd.DataFrame:
    """The table of a CSV file under its own header."""
    import pandas as pd

    text = _text(file)
    try:
        header, first = _top(text)
        if any(cell.strip() for cell in first[len(header) :]):
            raise InputError(f"{len(first)} values under {len(header)} names", f"{file} line 2",
                             "as many as names: decimal commas become points")  # fmt: skip
        _complete(file, text, max((i for i, name in enumerate(header, 1) if name.strip()), default=0))
        table = pd.read_csv(io.StringIO(text), skipinitialspace=True, low_memory=False, index_col=False)
    except pd.errors.EmptyDataError:
        raise InputError("the file is empty", str(file), "a header line and rows of numbers") from None
    except (pd.errors.ParserError, csv.Error, UnicodeError) as fault:
        raise InputError(
            f"not readable as CSV: {fault}", str(file), "commas between columns, one header line"
        ) from None
    if len(table.columns) == 1 and ";" in str(table.columns[0]):
        raise InputError("columns are separated by ';'", str(file), "commas between columns, points in numbers")
    if len(header) == len(table.columns):
        table.columns = header  # pandas would rename a second column of one name
    return table


def _top(text: str) -> tuple[list[str], list[str]]:
    """The header and the row after it."""
    rows = csv.reader(io.StringIO(text), skipinitialspace=True)
    return next(rows, []), next(rows, [])


def _complete(file: Path, text: str, names: int) -> None:
    """A row that ends early was cut off, mostly within a number: what is left of that would be a wrong reading."""
    if '"' in text:
        return  # commas and line breaks within quotes are no ends
    for number, line in enumerate(text.split("\n"), 1):
        if (found := line.count(",") + 1) < names and line.strip():
            raise InputError(f"{found} values under {names} names: the row was cut off", f"{file} line {number}",
                             "a whole row (commas where nothing was read), or none: delete it")  # fmt: skip


def _text(file: Path) -> str:
    """The whole of a CSV file, unpacked; nothing that is no text, and nothing too large to be a test."""
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
        return b"".join(parts).decode("utf-8-sig")
    except UnicodeDecodeError as fault:
        raise InputError(f"is no UTF-8 text: {fault.reason} at byte {fault.start}", str(file),
                         "CSV saved as UTF-8") from None  # fmt: skip
    except (OSError, EOFError, zlib.error) as fault:
        kind = "gzip" if packed else "CSV"
        raise InputError(f"not readable as {kind}: {fault}", str(file), "a whole file of that kind") from None
