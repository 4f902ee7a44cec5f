"""The command line in this process: what a command answers, and that it refuses as it should."""

import contextlib
import gc
import json
import sys
from io import StringIO
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

from thermoscope.cli import main, whole_app

# Of a name that several groups have, the first: `report` is `show report`
GROUPS = reversed(whole_app().registered_groups)
GROUP = {str(c.name): str(g.name) for g in GROUPS for c in g.typer_instance.registered_commands}
RUN = "import sys; sys.argv[0] = 'thermoscope'; from thermoscope.cli import main; main()"  # in a process of its own


class Answer(NamedTuple):
    """What a command left: exit code, stdout, stderr."""

    code: int
    out: str
    err: str

    @property
    def document(self) -> Any:
        return json.loads(self.out)

    @property
    def errors(self) -> list[str]:
        return [line for line in self.err.splitlines() if line.startswith("error")]

    @property
    def notes(self) -> list[str]:
        return [line for line in self.err.splitlines() if line.startswith("note: ")]


def answered(*words: object, cwd: Path | str = ".") -> Answer:
    """thermoscope WORDS in the folder `cwd`; a command may stand without its group."""
    if words and words[0] in GROUP:
        words = (GROUP[str(words[0])], *words)
    out, err = StringIO(), StringIO()
    with contextlib.ExitStack() as stack:
        stack.enter_context(patch.object(sys, "argv", ["thermoscope", *map(str, words)]))
        stack.enter_context(contextlib.chdir(cwd))
        stack.enter_context(contextlib.redirect_stdout(out))
        stack.enter_context(contextlib.redirect_stderr(err))
        try:
            main()
        except SystemExit as end:
            return Answer(int(end.code or 0), out.getvalue(), err.getvalue())
        finally:
            gc.unfreeze()  # of a process of many commands something is garbage
    raise AssertionError("the command did not end")


def contents(folder: Path) -> dict[str, bytes]:
    """Every file and its bytes: to see that a failed command left nothing."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def refusal(folder: Path, *words: object) -> str:
    """The one line with which a command refuses: exit code 2, nothing on stdout, a cure, all files as they were."""
    before = contents(folder)
    code, out, err = answered(*words)
    faults = [line for line in err.splitlines() if not line.startswith("note: ")]
    faults = [line for line in faults if line.startswith("error: ") or "Traceback" in line or "Warning" in line]
    assert (code, out, len(faults)) == (2, "", 1), (code, out, err)
    assert faults[0].startswith("error: ")
    assert "; " in faults[0]
    assert len(faults[0]) < 1500
    assert contents(folder) == before
    return faults[0]
