"""Files written whole or not at all."""

from __future__ import annotations

from pathlib import Path

from geom.errors import InputError
from geom.kept import written_whole


def write_whole(path: Path, text: str | bytes) -> Path:
    """Write beside the target, then rename: a reader sees the old file or the new one, never half of it."""
    try:
        with written_whole(path) as partial:
            partial.write_bytes(text if isinstance(text, bytes) else text.encode("utf-8"))
    except OSError as fault:
        right = "a folder you may write to, with room in it"
        raise InputError(f"cannot be written: {fault.strerror}", str(path), right) from None
    return path
