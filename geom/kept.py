"""Results kept on disk, named by the content of the prisms they come from."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from uuid import uuid4

from geom.part import Part


def kept_file(part: Part, folder: Path | str | None, kind: str, suffix: str) -> Path | None:
    """Where a result of the part's shape lies; neither its name nor its material matter. None without a folder."""
    if folder is None:
        return None
    content = hashlib.sha256(repr((part.prisms, part.made)).encode()).hexdigest()[:20]
    return Path(folder) / f"{kind}-{content}.{suffix}"


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """A file to write to that takes its place only when it is complete; hidden until then, gone if writing fails."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.stem}.{uuid4().hex}.part{path.suffix}")
    try:
        yield partial
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)
