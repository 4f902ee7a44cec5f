"""Work side by side: whole pieces of it in threads. The kernel and BLAS free Python's lock."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from itertools import chain
from typing import TypeVar

from validation.counting import counted

R = TypeVar("R")
T = TypeVar("T")


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
        for _ in counted("", chain([None], as_completed(futures.values())), len(every) + 1):  # as it begins, too
            pass
        return [futures[i].result() for i in range(len(every))]
