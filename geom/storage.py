"""Files written whole or not at all, one writer at a time, and the folder of what is kept."""

import errno
import os
import re
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from uuid import uuid4

from geom.errors import InputError

CURES = {errno.ENAMETOOLONG: "a shorter name", errno.ELOOP: "a file, not a link to itself"}
YOUNG_S = 5.0  # a folder may be made and not yet locked


def write_whole(path: Path, text: str | bytes | Iterator[str]) -> Path:
    """Write beside the target, then rename: a reader sees the old file or the new one, never half of it.

    text : of a large file piece by piece
    """
    try:
        with atomic_write(path) as partial, partial.open("wb") as file:
            for part in [text] if isinstance(text, str | bytes) else text:
                file.write(part if isinstance(part, bytes) else part.encode("utf-8", "backslashreplace"))
    except OSError as fault:
        right = "a folder you may write to, with room in it"
        raise InputError(
            f"cannot be written: {fault.strerror}", str(path), CURES.get(fault.errno or 0, right)
        ) from None
    return path


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


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Only one process at a time in here. The lock is on the folder: no file is left, and it ends with its owner.

    Systems without such locks (Windows, some network drives) go without: a stale writer is still refused.
    """
    try:
        import fcntl
    except ImportError:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)


def abandoned(folder: Path, name: re.Pattern[str]) -> list[Path]:
    """Folders of such a name that were `locked` once and whose process is gone; none where there are no locks."""
    try:
        import fcntl
    except ImportError:
        return []
    out = []
    for path in (p for p in folder.iterdir() if name.fullmatch(p.name) and p.is_dir() and not p.is_symlink()):
        if time.time() - path.stat().st_mtime < YOUNG_S:
            continue
        handle = os.open(path, os.O_RDONLY)
        try:
            with suppress(OSError):
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                out.append(path)
        finally:
            os.close(handle)
    return out


def cache_folder() -> Path:
    """Where meshes and bases are kept: $THERMOSCOPE_CACHE, else a folder of the user's."""
    home = os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))
    return Path(os.environ.get("THERMOSCOPE_CACHE", Path(home) / "thermoscope"))
