"""What a command shows: progress and notes on stderr, tables or one JSON document on stdout."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from thermoscope.files import write_whole

Progress = Callable[[str], None]
WIDTH = 140  # columns of a table that goes to a file or a pipe
STDOUT = "-"


@contextmanager
def progress() -> Iterator[Progress]:
    """A function that says what is going on: one line that changes on a terminal, else a line per step."""
    from rich.console import Console

    console = Console(stderr=True)
    if not console.is_terminal:
        yield _line
        return
    with console.status("") as status:
        yield lambda message: status.update(message)


def _line(message: str) -> None:
    print(message, file=sys.stderr, flush=True)


def notes(messages: Iterable[str]) -> None:
    """Doubts about the data."""
    for message in messages:
        _line(f"note: {message}")


def plain(value: Any) -> Any:
    """Any document as JSON can hold it: arrays become lists, what is not finite becomes null."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, list | tuple | set):
        return [plain(v) for v in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value


def give(document: Mapping[str, Any], target: str | None, show: Callable[[], None]) -> None:
    """The document to a file or to stdout, and the tables, except when stdout belongs to the document."""
    text = json.dumps(plain(document), indent=2, ensure_ascii=False) + "\n"
    if target == STDOUT:
        sys.stdout.write(text)
        return
    if target is not None:
        write_whole(Path(target), text)
    show()


def table(title: str, headers: Sequence[str], rows: Iterable[Sequence[Any]], marked: Sequence[str] = ()) -> None:
    """A table on stdout; numbers to three digits, right-aligned; rows that hold a `marked` word stand out."""
    from rich.table import Table
    from rich.text import Text

    body = [list(row) for row in rows]
    grid = Table(title=title, title_justify="left", title_style="bold")
    for i, header in enumerate(headers):
        numeric = any(isinstance(row[i], int | float) for row in body)
        grid.add_column(header, justify="right" if numeric else "left", overflow="fold", no_wrap=i == 0)
    for row in body:
        style = "bold" if any(isinstance(c, str) and c in marked for c in row) else ""
        grid.add_row(*(Text(cell(c)) for c in row), style=style)
    out().print(grid)


def say(message: str) -> None:
    """A sentence on stdout, never broken."""
    out().print(message, soft_wrap=True, markup=False, highlight=False)


def out() -> Any:
    from rich.console import Console

    console = Console()
    return console if console.is_terminal else Console(width=WIDTH)


def sized(value: float | None, low: float | None, high: float | None) -> str:
    """A value with its interval: three digits tell what an interval leaves sure."""
    one, *two = (f"{x:.3g}" if x is not None and math.isfinite(x) else "-" for x in (value, low, high))
    return f"{one} ({' ... '.join(two)})"


def cell(value: Any) -> str:
    """A value as a table shows it."""
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return "-"
    if isinstance(value, float):
        return f"{value:.2f}" if 0.1 <= abs(value) < 1000 else f"{value:.3g}"
    if isinstance(value, list | tuple):
        return ", ".join(cell(v) for v in value)
    return str(value)
