"""What a command shows: one sentence, then what fits on a screen, then where the rest is. No number is ever broken.

Columns that do not fit are left out, the least important first; rows that do not fit are counted.
"""

import os
import re
import shutil
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from itertools import zip_longest
from textwrap import wrap
from typing import Any

from geom.errors import InputError
from geom.table import Table, cell
from geom.text import visible

LINES, USUAL = 25, 80  # lines after the sentence, and columns where nobody says
GAP = "  "
LEAST = 8  # letters of a line of a broken word

NUMBERS = re.compile(r"[-+]?\d[\d.,eE+()\s-]*(?:[^\W\d]?\S{0,8})?")  # one, an interval, or either with its unit

_limit: ContextVar[int | None] = ContextVar("lines", default=LINES)


@dataclass(frozen=True)
class Summary:
    """sentence : the result;  parts : what it rests on, most important first;  more : where the rest is

    rest : what only --all shows
    """

    sentence: str
    parts: Sequence[Table | str] = ()
    more: str = ""
    rest: Sequence[Table | str] = ()


def sentences(words: Sequence[str]) -> list[str]:
    """Each with a capital and a full stop."""
    return [f"{w[0].upper()}{w[1:]}{'' if w[-1] in '.?' else '.'}" for w in words]


@contextmanager
def limited_lines(lines: int | None) -> Any:
    """Summaries in here have so many lines after their sentence; None for all there is, at any width."""
    token = _limit.set(lines)
    try:
        yield
    finally:
        _limit.reset(token)


def lay_out(summary: Summary, width: int, most: int | None) -> list[tuple[str, str]]:
    """(line, style) of a summary: at most `most` lines after its sentence, None for everything."""
    wide = 10**6 if most is None else width
    sentence = [(line, "bold") for line in folded(summary.sentence, wide)]
    parts = [
        p for p in (*summary.parts, *(summary.rest if most is None else ())) if (p.rows if isinstance(p, Table) else p)
    ]
    full = [_lines(part, wide, None) for part in parts]
    if most is None:
        return [*sentence, *(line for block in full for line in block), *_plain(summary.more, wide)]
    tail = _plain(_pointer(summary.more, bool(summary.rest)), wide)
    if sum(map(len, full)) + len(tail) > most:
        tail = _plain(_pointer(summary.more, True), wide)
        full = _cut(parts, full, wide, most - len(tail))
    return [*sentence, *(line for block in full for line in block), *tail]


def _pointer(more: str, cut: bool) -> str:
    return "; ".join(filter(None, ["More: --all" if cut else "", more]))


def _cut(parts: Sequence[Table | str], full: list[Any], width: int, room: int) -> list[Any]:
    """The least of each part, the most important first, as far as there is room; the rest goes in the same order."""
    lengths, fitting = list(map(len, full)), list[int]()
    for part, whole in zip(parts, lengths, strict=True):
        n = min(len(grid(part, part.rows[:1], width)) + 1, whole) if isinstance(part, Table) else whole
        fitting.append(n if n <= room else 0)
        room -= fitting[-1]
    out = []
    for part, whole, mine in zip(parts, full, fitting, strict=True):
        more = min(len(whole) - mine, room) if mine else 0
        out.append(whole if mine + more >= len(whole) else _lines(part, width, mine + more))
        room -= len(out[-1]) - mine
    return out


def _lines(part: Table | str, width: int, most: int | None) -> list[tuple[str, str]]:
    if isinstance(part, str):
        lines = _plain(part, width)
        return lines if most is None or len(lines) <= most else []
    rows = part.rows[:most]  # a row is a line at least: of thousands of rows most are not even laid out
    lines = grid(part, rows, width)
    while most is not None and rows and len(lines) + (len(rows) < len(part.rows)) > most:
        rows = rows[:-1]
        lines = grid(part, rows, width)
    if not rows:
        return []
    left = len(part.rows) - len(rows)
    return [*lines, *([(f"{GAP}... and {left} more", "dim")] if left else [])]


def _plain(text: str, width: int) -> list[tuple[str, str]]:
    return [(line, "") for line in folded(text, width)]


def folded(text: str, width: int) -> list[str]:
    """A sentence over several lines, broken between words."""
    return [
        line
        for piece in text.splitlines()
        for line in wrap(piece, width, break_long_words=False, break_on_hyphens=False)
    ]


def grid(table: Table, rows: Sequence[Sequence[Any]], width: int) -> list[tuple[str, str]]:
    """Title, headers and rows as lines that are no wider than `width`."""
    body = [[cell(value) for value in row] for row in rows]
    whole = [[cell(value) for value in row] for row in table.rows]
    right = [
        any(isinstance(row[j], int | float) and not isinstance(row[j], bool) for row in table.rows)
        for j in range(len(table.columns))
    ]
    widths = [max(map(len, (h, *(row[j] for row in whole)))) for j, h in enumerate(table.columns)]
    columns = _fitting(table, whole, widths, width)
    words = [j for j in columns if not right[j] and not _numbers(whole, j)]
    while _total(widths, columns) > width and (wide := [j for j in words if widths[j] > LEAST]):
        widths[max(wide, key=lambda j: (table.columns[j] == table.folded and widths[j] > 2 * LEAST, widths[j]))] -= 1

    def lines(cells: Sequence[str]) -> list[str]:
        parts = [wrap(cells[j], widths[j]) if j in words else [cells[j]] for j in columns]
        sides = [str.rjust if right[j] else str.ljust for j in columns]
        return [
            GAP.join(side(part, widths[j]) for side, part, j in zip(sides, row, columns, strict=True)).rstrip()
            for row in zip_longest(*parts, fillvalue="")
        ]

    styles = ["bold" if any(c in table.marked for c in row) else "" for row in body]
    head = [(title, "bold") for title in folded(table.title, width)[:1]]
    head += [(text, "dim") for text in lines(list(table.columns))]
    return [*head, *((text, style) for row, style in zip(body, styles, strict=True) for text in lines(row))]


def _fitting(table: Table, body: list[list[str]], widths: list[int], width: int) -> list[int]:
    """The columns that are shown: those that say something, less the least important until the rest fits."""
    columns = [j for j in range(len(table.columns)) if j == 0 or any(row[j] not in ("", "-") for row in body)]
    important = [j for j in columns if table.columns[j] in table.keep]
    order = [*reversed([j for j in columns[1:] if j not in important]), *reversed([j for j in important if j != 0])]
    lines = [LEAST if name == table.folded else 3 * LEAST for name in table.columns]
    floor = [w if _numbers(body, j) else min(w, lines[j]) for j, w in enumerate(widths)]
    order = [j for j in order if table.columns[j] != table.folded]
    for j in order:
        if _total(floor, columns) <= width:
            break
        columns.remove(j)
    return columns


def _numbers(body: list[list[str]], j: int) -> bool:
    """Does a column hold numbers, which are not to be broken? Names that begin with a digit may be."""
    return any(NUMBERS.fullmatch(row[j]) for row in body)


def _total(widths: Sequence[int], columns: Sequence[int]) -> int:
    return sum(widths[j] for j in columns) + len(GAP) * (len(columns) - 1)


def width() -> int:
    """Of the terminal, or as COLUMNS says; a pipe has 80."""
    return shutil.get_terminal_size((USUAL, 24)).columns if sys.stdout.isatty() or "COLUMNS" in os.environ else USUAL


def printed(summary: Summary) -> None:
    """On stdout."""
    from rich.console import Console
    from rich.text import Text

    class Terminal(Console):
        def on_broken_pipe(self) -> None:
            raise  # by default the program ends here, without a word

    console = Terminal(soft_wrap=True)
    with to_stdout():
        for line, style in lay_out(summary, width(), _limit.get()):
            console.print(Text(visible(line), style if console.is_terminal else ""), soft_wrap=True)


@contextmanager
def to_stdout() -> Iterator[None]:
    """What is written in here has arrived. Raises InputError where nobody reads any more; the rest goes nowhere."""
    try:
        yield
        sys.stdout.flush()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise InputError(
            "was closed before all was written", "stdout", "a program that reads to the end, or --json FILE"
        ) from None
