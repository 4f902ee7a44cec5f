"""The command line as a user runs it, and small case folders to run it on."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from small_case import small_case

RUN = "import sys; sys.argv[0] = 'thermoscope'; from thermoscope.cli import main; main()"


@dataclass(frozen=True)
class Answer:
    """What a command left: exit code, stdout, stderr."""

    code: int
    out: str
    err: str

    @property
    def document(self) -> dict:
        return json.loads(self.out)


@pytest.fixture(scope="session")
def thermoscope():
    """thermoscope(*arguments) -> Answer, in a process of its own."""

    def run(*arguments: object, cwd: Path | None = None) -> Answer:
        command = [sys.executable, "-c", RUN, *map(str, arguments)]
        done = subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=500)
        return Answer(done.returncode, done.stdout, done.stderr)

    return run


@pytest.fixture
def case(tmp_path) -> Path:
    """A case whose model lacks convection at the flange."""
    return small_case(tmp_path)


@pytest.fixture
def contents():
    """contents(folder) -> every file and its bytes: to see that a failed command left nothing."""

    def read(folder: Path) -> dict[str, bytes]:
        return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}

    return read
