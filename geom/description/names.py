"""What a file may call a thing: one rule for every name, said where the name is read."""

from collections.abc import Mapping
from typing import Any

from geom.errors import InputError

LETTERS = 80  # of a name: fits a line of a terminal, and a picture
LEADING = "=+-@"  # spreadsheets take a text that begins so for a formula, command lines for an option
LONGEST = 100  # bytes of a file's name; file systems stop at 255, and names get prefixes and endings
DEVICES = {"CON", "PRN", "AUX", "NUL", *(f"{port}{i}" for port in ("COM", "LPT") for i in range(1, 10))}  # of Windows
FORBIDDEN = set('/\\:*?"<>|')
# Keys of names that are put together from others, KIND@PLACE:PARAMETER.
COMPOUND = {"acts_on", "effect", "effects", "free", "frees", "values", "intervals", "answers", "evidence"}


def is_plain(name: str, letters: int = LETTERS) -> bool:
    """Can it be a name: printed, in one line, short, and no spreadsheet's formula?"""
    return name.isprintable() and len(name) <= letters and name[:1] not in (*LEADING,)


def plain_name(name: str, where: str, letters: int = LETTERS) -> str:
    """The name. Raises InputError, with `where` it stands, for one that no document of ours could hold unchanged."""
    if not is_plain(name, letters):
        right = f"one line of at most {letters} letters that can be printed, not beginning with {' '.join(LEADING)}"
        raise InputError(f"{_short(name)} cannot be a name", where, right)
    return name


def most_letters(*keys: str) -> int:
    """Of a name that stands under these keys."""
    return 3 * LETTERS if COMPOUND & set(keys) else LETTERS


def plain_header(text: str) -> str:
    """A recorder's name for a column as a plain name, with room for a number behind it; "" where nothing is left."""
    words = "".join(c if c.isprintable() else " " for c in text).split()
    return " ".join(words).lstrip(LEADING + " ")[: LETTERS - 5].rstrip()


def checked_document(node: Any, file: str, way: tuple[str, ...] = ()) -> None:
    """InputError for a key anywhere in a document that is not a plain name, or a text that cannot be printed.

    way : keys of the tables around the node
    """
    where = f"{file} [{'.'.join(way)}]" if way else file
    if isinstance(node, Mapping):
        letters = most_letters(*way)
        for key, inner in node.items():
            checked_document(inner, file, (*way, plain_name(key, where, letters)))
    elif isinstance(node, list):
        for inner in node:
            checked_document(inner, file, way)
    elif isinstance(node, str) and not node.replace("\n", "").replace("\t", "").isprintable():
        raise InputError(f"{_short(node)} is not possible", where, "letters that can be printed")


def checked_name(name: Any, where: str) -> str:
    """The name, if it can be part of a file's name on every system and leads nowhere else."""
    right = (
        f"up to {LONGEST} characters without / \\ : * ? \" < > |, no . or space at either end, none of Windows' devices"
    )
    fits = isinstance(name, str) and name.isprintable() and 0 < len(name.encode()) <= LONGEST
    if not fits or FORBIDDEN & set(name) or name.strip(" .") != name or _is_device(name):
        raise InputError(f"{_short(str(name))} cannot be the name of a file", where, right)
    return plain_name(str(name), where)


def file_stem(name: str) -> str:
    """A name as part of a file's name: what could lead elsewhere, or no file may have, is an underscore."""
    safe = "".join("_" if c in FORBIDDEN or not c.isprintable() else c for c in name).strip(" .")
    return f"_{safe}" if not safe or _is_device(safe) else safe


def _is_device(file: str) -> bool:
    """Does Windows open a device in place of this file, whatever its ending?"""
    return file.partition(".")[0].rstrip().upper() in DEVICES


def cut_short(text: str) -> str:
    """The beginning of a text that fits into a name, in letters and in bytes."""
    return text.encode(errors="replace")[:LETTERS].decode(errors="ignore")


def _short(text: str) -> str:
    return repr(text[:LETTERS])
