"""TOML files as dictionaries, or one message that says what is wrong with the file."""

import tomllib
from pathlib import Path
from typing import Any

from geom.description.names import checked_document
from geom.errors import InputError
from geom.limits import TOML_BYTES


def read_toml(path: Path, right: str) -> dict[str, Any]:
    """The tables of a TOML file; a byte-order mark at its start is not a fault. right : what the file should be."""
    if not path.exists():
        raise InputError("no such file", str(path), right)
    if not path.is_file():
        raise InputError("is not a file", str(path), right)
    TOML_BYTES.check(path.stat().st_size, path, "holds")
    try:
        document = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        checked_document(document, str(path))
        return document
    except (OSError, ValueError, RecursionError) as fault:
        raise InputError(f"not readable as TOML: {fault or type(fault).__name__}", str(path), right) from None
