"""Names that become names of files: checked once, where they are read."""

from __future__ import annotations

from typing import Any

from geom.errors import InputError

LONGEST = 100  # bytes; file systems stop at 255, and names get prefixes and endings
DEVICES = {"CON", "PRN", "AUX", "NUL", *(f"{port}{i}" for port in ("COM", "LPT") for i in range(1, 10))}  # of Windows
FORBIDDEN = set('/\\:*?"<>|')


def checked_name(name: Any, where: str) -> str:
    """The name, if it can be part of a file's name on every system and leads nowhere else."""
    right = (
        f"up to {LONGEST} characters without / \\ : * ? \" < > |, no . or space at either end, none of Windows' devices"
    )
    fits = isinstance(name, str) and name.isprintable() and 0 < len(name.encode()) <= LONGEST
    if not fits or FORBIDDEN & set(name) or name.strip(" .") != name or name.upper() in DEVICES:
        raise InputError(f"{str(name)[:LONGEST]!r} cannot be the name of a file", where, right)
    return str(name)
