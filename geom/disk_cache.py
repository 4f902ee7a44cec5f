"""Results kept on disk, named by the content of the prisms they come from."""

from __future__ import annotations

import errno
import hashlib
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar
from uuid import uuid4

from geom.description.part import Part

Result = TypeVar("Result")


def cache_file(part: Part, folder: Path | str | None, kind: str, suffix: str) -> Path | None:
    """Where a result of the part's shape lies; neither its name nor its material matter. None without a folder."""
    if folder is None:
        return None
    content = hashlib.sha256(repr((part.prisms, part.cad_shape)).encode()).hexdigest()[:20]
    return Path(folder) / f"{kind}-{content}.{suffix}"


def recalled(file: Path, read: Callable[[Path], Result]) -> Result | None:
    """What is kept there; None where there is nothing or it is damaged: then it is made again.

    Whatever fails in reading means damage: zip, NumPy, JSON and CAD have no error in common.
    """
    if not file.is_file():
        return None
    try:
        return read(file)
    except Exception:
        return None


@contextmanager
def atomic_write(path: Path) -> Iterator[Path]:
    """A file to write to that takes its place only when it is complete; hidden until then, gone if writing fails.

    It is on the disk before it is renamed, and its new name is before this returns: a power cut leaves old or new.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.stem}.{uuid4().hex}.part{path.suffix}")
    try:
        yield partial
        _synced(partial, os.O_RDWR)
        partial.replace(path)
        _synced(path.parent, os.O_RDONLY)
    finally:
        partial.unlink(missing_ok=True)


def _synced(path: Path, mode: int) -> None:
    """What was written there is on the disk. Some systems cannot open folders, or sync them: then they need not."""
    if path.is_dir() and os.name == "nt":
        return
    file = os.open(path, mode)
    try:
        os.fsync(file)
    except OSError as fault:
        if fault.errno not in (errno.EINVAL, errno.ENOTSUP):
            raise
    finally:
        os.close(file)
