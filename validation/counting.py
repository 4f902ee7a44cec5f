"""Long loops say how far they are, to whoever listens."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

T = TypeVar("T")
_listener: ContextVar[Callable[[str], None]] = ContextVar("listener", default=lambda message: None)


@contextmanager
def listening(tell: Callable[[str], None]) -> Iterator[None]:
    """In here `tell` hears of every piece of a counted loop."""
    token = _listener.set(tell)
    try:
        yield
    finally:
        _listener.reset(token)


def counted(what: str, pieces: Iterable[T], count: int) -> Iterator[T]:
    """The pieces one by one, each announced as "WHAT (3 of 200)"; without words where they are part of something."""
    for number, piece in enumerate(pieces, 1):
        _listener.get()(f"{what} ({number} of {count})".strip())
        yield piece
