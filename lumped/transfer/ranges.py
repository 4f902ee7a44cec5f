"""What lies outside the range of a source is said, once for each thread that is not told to be silent."""

from __future__ import annotations

import re
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

_thread = threading.local()


class RangeWarning(UserWarning):
    """A correlation or a map was used outside the range of its source."""

    @property
    def subject(self) -> str:
        """Of what it warns: its words without their numbers, the same however often and however far outside."""
        return re.sub(r"(?<![\w.])-?\d[\d.e+-]*", "", str(self).partition(" = ")[0])


def out_of_range(what: str) -> None:
    """A RangeWarning, unless this thread is in `within_silence`."""
    if not getattr(_thread, "silent", False):
        warnings.warn(what, RangeWarning, stacklevel=2)


@contextmanager
def within_silence() -> Iterator[None]:
    """No RangeWarning of this thread: of grids that leave a range by construction, and of what was said before.

    Filters of `warnings` belong to all threads: who sets and restores them beside another leaves them wrong.
    """
    before = getattr(_thread, "silent", False)
    _thread.silent = True
    try:
        yield
    finally:
        _thread.silent = before
