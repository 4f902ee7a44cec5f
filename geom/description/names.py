"""Names that become names of files: checked once, where they are read."""

from __future__ import annotations

from typing import Any

from geom.errors import InputError

LONGEST = 100  # characters; file systems stop at 255 bytes, and names get prefixes and endings
FORBIDDEN = set('/\\:*?"<>|')


def checked_name(name: Any, where: str) -> str:
    """The name, if it can be part of a file's name on every system and leads nowhere else."""
    right = f'up to {LONGEST} characters without / \\ : * ? " < > |, no . or space at either end'
    fits = isinstance(name, str) and 0 < len(name) <= LONGEST and name.isprintable() and not FORBIDDEN & set(name)
    if not fits or name.strip(" .") != name:
        raise InputError(f"{str(name)[:LONGEST]!r} cannot be the name of a file", where, right)
    return str(name)
