"""Files written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from geom.errors import InputError


def write_whole(path: Path, text: str | bytes) -> Path:
    """Write beside the target, then rename: a reader sees the old file or the new one, never half of it."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    except OSError as fault:
        raise InputError(f"cannot be written: {fault.strerror}", str(path), "a folder you may write to") from None
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(text if isinstance(text, bytes) else text.encode("utf-8"))
        os.chmod(name, 0o644)
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
    return path
