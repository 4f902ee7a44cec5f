"""What a command shows: progress and notes on stderr, tables or one JSON document on stdout."""

import json
import math
import platform
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

from geom.storage import write_whole
from geom.text import visible
from thermoscope.console.progress_bar import Progress, progress
from thermoscope.console.summary import Summary, printed, to_stdout

STDOUT = "-"
__all__ = ["Progress", "give", "notes", "notes_once", "plain", "progress", "ranges_as_notes", "say", "versions"]


NOTES_SO_FAR: ContextVar[set[str] | None] = ContextVar("said", default=None)  # where each is said once


@contextmanager
def notes_once() -> Iterator[None]:
    """Several commands in a row say each note once."""
    token = NOTES_SO_FAR.set(set())
    try:
        yield
    finally:
        NOTES_SO_FAR.reset(token)


def notes(messages: Iterable[str]) -> None:
    """Doubts about the data."""
    so_far = NOTES_SO_FAR.get()
    for message in messages:
        if so_far is None or message not in so_far:
            print(visible(f"note: {message}"), file=sys.stderr, flush=True)
        if so_far is not None:
            so_far.add(message)


@contextmanager
def ranges_as_notes() -> Iterator[None]:
    """What lies outside the range of its source is a note, said once; other warnings are shown as ever."""
    usual, so_far = warnings.showwarning, set[str]()

    def as_note(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
        subject = getattr(message, "subject", None)  # test after test has another number
        if subject is None:
            usual(message, category, *where, **more)
        elif subject not in so_far:
            so_far.add(subject)
            notes([str(message)])

    warnings.showwarning = as_note
    try:
        yield
    finally:
        warnings.showwarning = usual


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


def give(document: Mapping[str, Any], target: str | None, show: Callable[[], Summary | None]) -> None:
    """The document to a file or to stdout, and the summary, except when stdout belongs to the document."""
    text = json.dumps(plain(document), indent=2, ensure_ascii=False) + "\n"
    if target == STDOUT:
        with to_stdout():
            sys.stdout.write(text.encode(errors="backslashreplace").decode())  # halves of letters as JSON's escapes
        return
    if target is not None:
        write_whole(Path(target), text)
    if (summary := show()) is not None:
        printed(summary)


def say(message: str) -> None:
    """A sentence on stdout."""
    printed(Summary(message))


def versions() -> str:
    """What runs here, on what: in a report of a fault, and below a page."""
    from importlib.metadata import version

    python, system = platform.python_version(), f"{platform.system()} {platform.machine()}"
    return f"thermoscope {version('thermoscope')}, Python {python}, {system}"
