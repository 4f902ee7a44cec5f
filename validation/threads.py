"""Work side by side: whole pieces of it in threads, and one thread of BLAS in each.

The kernel and BLAS free Python's lock. Matrices of a diagnosis are small: threads of BLAS would mostly wait for each
other, ten times as long as one.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor, as_completed
from functools import wraps
from itertools import chain
from typing import ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from validation.counting import counted

P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")


def one_blas_thread(work: Callable[P, R]) -> Callable[P, R]:
    """`work` with one thread of BLAS, whatever the environment allows; afterwards as before."""

    @wraps(work)
    def alone(*args: P.args, **kwargs: P.kwargs) -> R:
        with threadpool_limits(limits=1, user_api="blas"):
            return work(*args, **kwargs)

    return alone


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
