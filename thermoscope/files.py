"""Files written whole or not at all, one writer at a time, and never over what the user brought."""

from pathlib import Path
from tempfile import TemporaryFile

from geom.errors import InputError
from geom.storage import CURES
from geom.text import visible
from measured.input_folders import CASE, within_inputs

STOPPED = 130  # exit code of what the user stopped, as shells have it
LONGEST_WORD = 300  # characters of a word in a message: longer than most paths


def checked_result(path: Path) -> Path:
    """Where a result is kept: a file or nothing yet, in a folder or nothing yet; said before anything is computed."""
    for place, right, kind in ((path.parent, "folder", Path.is_dir), (path, "file", Path.is_file)):
        if (place.exists() or place.is_symlink()) and not kind(place):
            raise InputError(f"is not a {right}", str(place), f"a {right} for results: move it away or delete it")
    return path


def message_of(fault: Exception) -> str:
    """The message of a fault; of the system's own with the file it was about and the cure."""
    if not isinstance(fault, OSError) or not fault.strerror:
        return str(fault)
    cure = CURES.get(fault.errno or 0, "a file or folder you may read and write, with room on its disk")
    return f"{fault.filename2 or fault.filename or 'the disk'}: {fault.strerror}; {cure}"


def printable(message: str) -> str:
    """In one line, control characters as their escapes, no word longer than LONGEST_WORD."""
    return " ".join(w if len(w) <= LONGEST_WORD else f"{w[:LONGEST_WORD]}..." for w in map(visible, message.split()))


def checked_target(target: str | None) -> str | None:
    """Where a document is to go: a new file, or an earlier document; never a file of another kind, such as an input."""
    if target in (None, "-"):
        return target
    path, right = Path(str(target)), "a new file NAME.json, or - for stdout"
    if not target or path.is_dir():
        raise InputError(f"{target!r} is not a file to write to", "--json", right)
    if not path.parent.is_dir():
        raise InputError("lies in a folder that is not there", f"--json {path}", right)
    if path.exists() and (not path.is_file() or not _is_document(path)):
        raise InputError("is there already and is not a document of this tool: it stays", f"--json {path}", right)
    try:
        with TemporaryFile(dir=path.parent):  # by trying: /proc looks as if its owner might write there
            return target
    except OSError as fault:
        raise InputError(f"cannot be written: {fault.strerror}", f"--json {path}", right) from None


def _is_document(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(64).lstrip()[:1] in (b"{", b"")


def checked_out(out: Path | None) -> Path | None:
    """Where files are to go: a folder, new or of results; never one where a case keeps its inputs."""
    if out is None:
        return None
    right = "a folder for results, such as out/NAME"
    if not str(out) or "\0" in str(out) or (out.exists() and not out.is_dir()):
        raise InputError("is not a folder", f"--out {out}", right)
    if (out / CASE).exists() or within_inputs(out):
        raise InputError("a case keeps its inputs there: results would be mixed with them", f"--out {out}", right)
    return out
