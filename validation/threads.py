"""Work side by side: whole pieces of it in threads. The kernel and BLAS free Python's lock."""

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import chain
from typing import Protocol, TypeVar

from geom.arrays import Array

_listener: ContextVar[Callable[[str], None]] = ContextVar("listener", default=lambda message: None)
WORTH_A_THREAD = 3000  # states times instants below which starting threads costs more than it saves
R = TypeVar("R")
T = TypeVar("T")


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


class Timed(Protocol):
    """A test, or a record.  time : (n,) s"""

    @property
    def time(self) -> Array: ...


S = TypeVar("S", bound=Timed)


def side_by_side(work: Callable[[T], R], pieces: Iterable[T], length: Callable[[T], float] | None = None) -> list[R]:
    """What `work` makes of every piece, in their order. No piece may depend on another.

    length : of a piece, of which the longest begin first. Whoever listens hears how many are done.
    """
    every = list(pieces)
    if len(every) < 2:
        return [work(piece) for piece in every]
    order = sorted(range(len(every)), key=lambda i: -length(every[i])) if length else range(len(every))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        futures = {i: pool.submit(work, every[i]) for i in order}
        try:
            for _ in counted("", chain([None], as_completed(futures.values())), len(every) + 1):  # as it begins, too
                pass
        except KeyboardInterrupt:
            pool.shutdown(wait=False, cancel_futures=True)  # what runs is waited for, what has not begun is not
            raise
        return [futures[i].result() for i in range(len(every))]


def run_by_run(work: Callable[[S], R], runs: Sequence[S], states: int) -> list[R]:
    """The same for runs of a network of so many states: the longest first, short ones one after the other."""
    if len(runs) < 2 or len(runs[0].time) * states < WORTH_A_THREAD:
        return [work(run) for run in runs]
    return side_by_side(work, runs, lambda run: len(run.time))
