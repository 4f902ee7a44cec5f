"""Text exports: any encoding, delimiter and decimal sign, with or without a preamble."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from pathlib import Path

from geom.errors import InputError
from thermoscope.importing.cells import is_reading
from thermoscope.recordings.csv_file import chunks

DELIMITERS = ("\t", ";", ",", "|")
SAMPLE = 400  # lines from the middle that tell the delimiter
BOMS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"\xef\xbb\xbf": "utf-8-sig"}

Rows = list[list[str]]


def text_rows(file: Path) -> Rows:
    """The cells of a text file, line by line."""
    lines = decoded(b"".join(chunks(file)), file).splitlines()
    return _split(lines, delimiter(lines))


def decoded(raw: bytes, file: Path) -> str:
    """UTF-8, UTF-16 with its mark, or the Windows code page of western Europe that loggers write."""
    for bom, encoding in BOMS.items():
        if raw.startswith(bom):
            return raw.decode(encoding, errors="replace")
    if b"\0" in raw:
        raise InputError("holds zero bytes, so it is no text: it is no record", str(file),
                         "CSV or other text, .xlsx, .tdms, .mf4 or .parquet")  # fmt: skip
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


def delimiter(lines: list[str]) -> str:
    """The sign between columns, " " for blanks: the one that leaves the most cells that are readings."""
    middle = max(0, len(lines) // 2 - SAMPLE // 2)
    sample = [line for line in lines[middle : middle + SAMPLE] if line.strip()]
    scores: dict[str, float] = {}
    for sign in (*DELIMITERS, " "):
        cells = [cell for row in _split(sample, sign) if len(row) > 1 for cell in row]
        good = sum(is_reading(cell) for cell in cells)
        scores[sign] = good * good / len(cells) if cells else 0.0
    return max(scores, key=lambda sign: scores[sign])


def _split(lines: list[str], sign: str) -> Rows:
    if sign == " ":
        return [line.split() for line in lines]
    cells: Callable[[list[str]], list[str]] = lambda row: [cell.strip() for cell in row]  # noqa: E731
    try:
        return [cells(row) for row in csv.reader(io.StringIO("\n".join(lines)), delimiter=sign)]
    except csv.Error:
        return [cells(line.split(sign)) for line in lines]
