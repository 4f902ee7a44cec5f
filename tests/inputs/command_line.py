"""The command line in this process: what a command answers, and that it refuses as it should."""

import sys
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from unittest.mock import patch

from thermoscope.cli import main


def answered(*words: object) -> tuple[int, str, list[str]]:
    """Exit code, stdout and the lines of stderr."""
    out, err = StringIO(), StringIO()
    with patch.object(sys, "argv", ["thermoscope", *map(str, words)]), redirect_stdout(out), redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            return int(end.code or 0), out.getvalue(), err.getvalue().splitlines()
    raise AssertionError("the command did not end")


def contents(folder: Path) -> dict[Path, bytes]:
    return {p: p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def refusal(folder: Path, *words: object) -> str:
    """The one line with which a command refuses: exit code 2, nothing on stdout, a cure, all files as they were."""
    before = contents(folder)
    code, out, err = answered(*words)
    faults = [line for line in err if not line.startswith("note: ")]
    faults = [line for line in faults if line.startswith("error: ") or "Traceback" in line or "Warning" in line]
    assert (code, out, len(faults)) == (2, "", 1), (code, out, err)
    assert faults[0].startswith("error: ")
    assert "; " in faults[0]
    assert len(faults[0]) < 1500
    assert contents(folder) == before
    return faults[0]
