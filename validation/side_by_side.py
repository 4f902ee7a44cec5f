"""Independent pieces of work in several processes, in order, with progress."""

from __future__ import annotations

import multiprocessing
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from typing import Any

_shared: list[tuple[Callable[[Any, int], Any], Any]] = []


def side_by_side(
    piece: Callable[[Any, int], Any], setting: Any, count: int, workers: int, progress: Callable[[str], None], what: str
) -> list[Any]:
    """[piece(setting, 0), piece(setting, 1), ...]; forked processes see `setting` without a copy being sent."""
    done: list[Any] = []

    def keep(row: Any) -> None:
        done.append(row)
        progress(f"{what} {len(done)}/{count}")

    if workers < 2 or "fork" not in multiprocessing.get_all_start_methods():
        for i in range(count):
            keep(piece(setting, i))
        return done
    _shared[:] = [(piece, setting)]
    with ProcessPoolExecutor(workers, multiprocessing.get_context("fork")) as pool:
        for row in pool.map(_one, range(count)):
            keep(row)
    return done


def _one(i: int) -> Any:
    piece, setting = _shared[0]
    return piece(setting, i)
