"""Independent solutions in two processes: SciPy holds Python's lock while it factorises, so threads would wait."""

import ctypes
import os
import pickle
import signal
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, TypeVar

A = TypeVar("A")
B = TypeVar("B")
BYTES = 10_000  # per unknown: the second factor and what it was assembled from; 1.3 GB at 130,000
LEAST = 10_000  # unknowns: below, a fork and the way back of the solutions take longer than they save


def in_two_processes(
    work: Callable[[A], B], items: Sequence[A], unknowns: int, after: Callable[[], None] = lambda: None
) -> list[B]:
    """work(item) of every item, at most 255, in their order; a forked process takes its share where there is room.

    unknowns : of the largest matrix that is factorised;  work : does not depend on what it was called with before,
    and uses no library that keeps threads of its own (CAD does): in a forked process it would wait for them for ever
    after : in each process when no item is left, before solutions are sent
    """
    return_memory()
    if len(items) < 2 or unknowns < LEAST or not _room(BYTES * unknowns):
        try:
            return [work(item) for item in items]
        finally:
            after()
    turns, numbers = os.pipe()  # a byte is the number of an item: whoever is free reads the next
    os.write(numbers, bytes(range(len(items))))
    os.close(numbers)
    back, forth = os.pipe()
    parent, child = os.getpid(), os.fork()
    if child == 0:
        try:
            os.close(back)
            with os.fdopen(forth, "wb") as out:
                pickle.dump(_share(work, items, turns, parent, after), out, protocol=5)
        except BaseException:  # its parent does what is missing, and meets the same
            os._exit(1)
        os._exit(0)
    os.close(forth)
    try:
        with os.fdopen(back, "rb") as source:
            results = {**_share(work, items, turns, os.getppid(), after), **_received(source)}
    finally:
        os.close(turns)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    return [results[k] if k in results else work(item) for k, item in enumerate(items)]


def return_memory() -> None:
    """Give back to the system what was freed: glibc keeps it, 2.1 of 2.7 GB after 300,000 unknowns."""
    with suppress(AttributeError, OSError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)


def _share(
    work: Callable[[A], B], items: Sequence[A], turns: int, parent: int, after: Callable[[], None]
) -> dict[int, B]:
    numbers = iter(lambda: os.read(turns, 1) if os.getppid() == parent else b"", b"")
    try:
        return {turn[0]: work(items[turn[0]]) for turn in numbers}
    finally:
        after()


def _received(source: BinaryIO) -> dict[int, B]:
    try:
        results: dict[int, B] = pickle.load(source)
    except (EOFError, pickle.UnpicklingError):  # it was killed, or failed
        return {}
    return results


def _room(needed: int) -> bool:
    """Whether two cores and so many bytes are free; False where no process can be forked, or nothing tells."""
    if not hasattr(os, "fork") or not hasattr(os, "sched_getaffinity") or len(os.sched_getaffinity(0)) < 2:
        return False
    try:
        lines = Path("/proc/meminfo").read_text(encoding="ascii").splitlines()
    except OSError:
        return False
    return any(line.startswith("MemAvailable:") and 1024 * int(line.split()[1]) > needed for line in lines)
