"""The one store of results on disk: files named KIND-KEY.SUFFIX by the content they come from.

All of them together take `geom.limits.CACHE_BYTES`; what was not used for longest goes first. A damaged entry counts as
none, and is made again. `thermoscope check --clean` empties the store.
"""

import hashlib
import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from os import utime
from pathlib import Path
from typing import TypeVar

from geom.description.part import Part
from geom.limits import CACHE_BYTES
from geom.storage import atomic_write, write_whole

Result = TypeVar("Result")
ENTRY = re.compile(r"stages\.json|[a-z][\w.-]*-[0-9a-f]{8,20}\.(brep|json|npz)")
PARTIAL = re.compile(r"\..*\.[0-9a-f]{32}\.part\.(brep|json|npz)")
ABANDONED_S = 86400.0  # no entry takes a day to write: what is unfinished for longer a killed process has left
UNCOUNTED = 0.01  # of the bound, which a process may write before it counts the store again
_since_count: dict[Path, int] = {}  # folder -> bytes that this process has written since then


def cache_file(part: Part, folder: Path | str | None, kind: str, suffix: str) -> Path | None:
    """Where a result of the part's shape lies; neither its name nor its material matter. None without a folder."""
    if folder is None:
        return None
    content = hashlib.sha256(repr((part.prisms, part.cad_shape)).encode()).hexdigest()[:20]
    return Path(folder) / f"{kind}-{content}.{suffix}"


def recalled(file: Path, read: Callable[[Path], Result]) -> Result | None:
    """An entry, which counts as a use of it; None where there is none or it is damaged: then it is made again.

    Whatever fails in reading means damage: zip, NumPy, JSON and CAD have no error in common.
    """
    if not file.is_file():
        return None
    try:
        result = read(file)
    except Exception:
        return None
    with suppress(OSError):  # a folder that can only be read
        utime(file)
    return result


@contextmanager
def stored(file: Path) -> Iterator[Path]:
    """A file to write an entry to, which takes its place when it is complete."""
    with atomic_write(file) as partial:
        yield partial
    _bound(file)


def store(file: Path, content: str | bytes) -> None:
    """Write an entry as a whole."""
    write_whole(file, content)
    _bound(file)


def _bound(new: Path) -> None:
    """Cut the store of a new entry to its bound; the entry itself stays."""
    folder, most, total = new.parent, CACHE_BYTES.most, 0
    _since_count[folder] = _since_count.get(folder, most) + new.stat().st_size
    if _since_count[folder] <= UNCOUNTED * most:
        return
    _since_count[folder] = 0
    for _, size, path in sorted(entries(folder), key=lambda entry: (entry[2] != new, -entry[0])):
        total += size
        if total > most and path != new:
            _removed(path)


def entries(folder: Path) -> list[tuple[int, int, Path]]:
    """Last use (ns), size (bytes) and path of all that the store has written here; other files are left alone."""
    out = []
    for path in folder.iterdir() if folder.is_dir() else ():
        with suppress(OSError):  # another process dropped it first
            status = path.stat()
            abandoned = PARTIAL.fullmatch(path.name) and time.time() - status.st_mtime > ABANDONED_S
            if path.is_file() and (ENTRY.fullmatch(path.name) or abandoned):
                out.append((status.st_mtime_ns, status.st_size, path))
    return out


def empty(folder: Path) -> tuple[int, int]:
    """Remove all entries: how many files went, and how many bytes they had."""
    sizes = [size for _, size, path in entries(folder) if _removed(path)]
    return len(sizes), sum(sizes)


def _removed(path: Path) -> bool:
    with suppress(OSError):  # another process dropped it first, or has it open on Windows
        path.unlink()
        return True
    return False
