"""Where the table begins in rows of cells: preamble, header, units, numbers."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geom.errors import InputError
from thermoscope.importing.cells import is_reading, is_unit, number

SAMPLE = 2000  # rows that are enough to find the table
FIRM = 3  # rows of numbers in a row that are a table
LEAST = 0.5  # share of a row's cells that are readings

Row = Sequence[object]


@dataclass(frozen=True)
class Layout:
    """names, units : one per column, "" where the file gives none;  first : row where the readings begin

    width : columns;  preamble : rows before the header
    """

    names: tuple[str, ...]
    units: tuple[str, ...]
    first: int
    width: int
    preamble: int


def layout(rows: Sequence[Row], where: str) -> Layout:
    """InputError where no table of at least two columns stands in the rows."""
    head = rows[:SAMPLE]
    widths = Counter(len(trimmed(row)) for row in head if _readings(row))
    if not widths:
        raise InputError("no rows of readings in it: it is no record", where,
                         "columns of numbers, with a header or without")  # fmt: skip
    width = max(n for n, count in widths.items() if count >= 0.5 * max(widths.values()))
    if width < 2:
        raise InputError("the file has one column only", where,
                         "a time or an input, and at least one temperature")  # fmt: skip
    first = _first(head, width, where)
    above = [i for i in range(first) if any(str(c).strip() for c in rows[i] if c is not None)]
    return _headed(rows, above[-2:], first, width)


def _headed(rows: Sequence[Row], above: list[int], first: int, width: int) -> Layout:
    """The row of names over the readings, and the row of units between them where there is one."""
    units, names, header = [""] * width, [""] * width, first
    if above and len(above) > 1 and _filled(rows[above[-2]], width) and _all_units(rows[above[-1]]):
        units = _padded(rows[above[-1]], width)
        names, header = _padded(rows[above[-2]], width), above[-2]
    elif above and _filled(rows[above[-1]], width):
        names, header = _padded(rows[above[-1]], width), above[-1]
    return Layout(tuple(names), tuple(units), first, width, header)


def trimmed(row: Row) -> Row:
    """Without empty cells at the end: many exports close each line with a delimiter."""
    end = len(row)
    while end and (row[end - 1] is None or not str(row[end - 1]).strip()):
        end -= 1
    return row[:end]


def _readings(row: Row) -> bool:
    cells = [c for c in row if c is not None and str(c).strip()]
    good = sum(is_reading(c) for c in cells)
    return good > 0 and good >= LEAST * len(cells) and any(np.isfinite(number(c)) for c in cells)


def _first(rows: Sequence[Row], width: int, where: str) -> int:
    """The first of several rows of readings, as wide as the table or a little less (empty cells at the end)."""
    fits = [_readings(row) and width / 2 < len(trimmed(row)) <= width for row in rows]
    for i in range(len(rows)):
        if all(fits[i : i + FIRM]) and len(fits[i : i + FIRM]) == FIRM:
            return i
    raise InputError("fewer than three rows of readings: it is no record", where, "at least 3 rows of numbers")


def _filled(row: Row, width: int) -> bool:
    """Does it name (nearly) every column?"""
    cells = [c for c in row if c is not None and str(c).strip()]
    return width - 1 <= len(cells) <= width and not all(is_reading(c) for c in cells)


def _all_units(row: Row) -> bool:
    cells = [str(c).strip() for c in row if c is not None and str(c).strip()]
    return bool(cells) and sum(is_unit(c) for c in cells) >= 0.7 * len(cells)


def _padded(row: Row, width: int) -> list[str]:
    cells = ["" if c is None else str(c).strip() for c in row]
    return [*cells, *[""] * width][:width]
