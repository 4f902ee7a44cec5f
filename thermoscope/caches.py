"""What is kept between commands, and where."""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from geom.storage import write_whole

Result = TypeVar("Result")
MOST_FILES = 50  # results of one kind: every step of a model and every new version of the code makes another
MOST_BYTES = 300_000_000  # of one kind: a machine's page is 1 MB, with long tests and many revisions some ten


def recalled_result(file: Path, read: Callable[[Path], Result]) -> Result | None:
    """What `store_result` wrote there, which counts as a use of it; None where there is nothing or it is damaged."""
    from geom.disk_cache import recalled  # loads NumPy, which help does without

    result = recalled(file, read)
    if result is not None:
        with suppress(OSError):  # a folder that is only read: nothing is written there either
            os.utime(file)
    return result


def store_result(file: Path, content: str | bytes, kind: str) -> None:
    """Write KIND-KEY.SUFFIX, and drop what of its kind was not used for longest, beyond MOST_FILES and MOST_BYTES.

    What is made from files that are expensive, such as meshes, is not for this: it is made again where it is missing.
    """
    write_whole(file, content)
    total = 0
    for number, (_, size, path) in enumerate(_last_used(file, kind)):
        total += size
        if path != file and (number >= MOST_FILES or total > MOST_BYTES):
            with suppress(OSError):  # another process dropped it first, or has it open on Windows
                path.unlink()


def _last_used(file: Path, kind: str) -> list[tuple[int, int, Path]]:
    """When (ns), bytes and path of all files of a kind, the last used one first, and the file itself before all."""
    out = []
    for path in file.parent.glob(f"{kind}-*"):
        with suppress(OSError):
            status = path.stat()
            out.append((status.st_mtime_ns, status.st_size, path))
    return sorted(out, key=lambda entry: (entry[2] != file, -entry[0]))
