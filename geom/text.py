"""Results as plain text: what a script or a notebook shows of them."""

from collections.abc import Sequence
from math import floor, log10
from typing import Any

# Between columns; digits of a number, more than a model is sure of; decimals, a hundredth of a kelvin.
SPACE, DIGITS, DECIMALS = ("  ", 3, 2)


def table(headers: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Lines of aligned columns: words to the left; numbers to the right, the largest of a column with three digits."""
    columns = [_column(list(cells)) for cells in zip(*rows, strict=True)] or [[] for _ in headers]
    out = []
    for head, cells, first in zip(headers, columns, rows[0] if rows else headers, strict=True):
        wide = max(map(len, [head, *cells]))
        out.append([x.ljust(wide) if isinstance(first, str) else x.rjust(wide) for x in (head, *cells)])
    return "\n".join(SPACE.join(line).rstrip() for line in zip(*out, strict=True))


def counted(n: int, what: str) -> str:
    """A number of things: "1 test", "3 tests"."""
    return f"{n} {what}" if n == 1 else f"{n} {what}s"


def visible(line: str) -> str:
    """A line with its control characters as escapes: it moves no cursor, and begins no other line."""
    return line if line.isprintable() else "".join(c if c.isprintable() else repr(c)[1:-1] for c in line)


def _column(cells: list[Any]) -> list[str]:
    """Numbers with the same decimals, whole ones with none."""
    numbers = [abs(x) for x in cells if not isinstance(x, str)]
    most = max(numbers, default=0.0)
    whole = all(isinstance(x, int) for x in cells) or most == 0.0
    decimals = 0 if whole else min(max(DIGITS - 1 - floor(log10(most)), 0), DECIMALS)
    return [x if isinstance(x, str) else f"{x:.{decimals}f}" for x in cells]
