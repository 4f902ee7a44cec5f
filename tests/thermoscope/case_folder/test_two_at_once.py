"""Two commands on one case at once: both work, one writes, the other is told and nothing is lost."""

import os
import subprocess
import sys

import pytest

from geom.storage import locked
from thermoscope.case_folder.history import load_history

# The second command begins to write only after the first has: each waits for the other before it saves.
MEETING = """
import sys, time
from pathlib import Path
import thermoscope.commands.model.revise as revise

save, mine, other = revise.save_history, Path(sys.argv[1]), Path(sys.argv[2])

def met(*given):
    mine.touch()
    while not other.exists():
        time.sleep(0.05)
    return save(*given)

revise.save_history = met
sys.argv = ["thermoscope", *sys.argv[3:]]
from thermoscope.cli import main
main()
"""


@pytest.mark.nightly
def test_the_second_of_two_calibrations_is_refused(case, tmp_path):
    doors = [tmp_path / "a", tmp_path / "b"]
    both = [
        subprocess.Popen(
            [sys.executable, "-c", MEETING, *map(str, order), "model", "calibrate", str(case), "--anyway"],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        for order in (doors, doors[::-1])
    ]
    told = [process.communicate(timeout=500) for process in both]
    codes = sorted(process.returncode for process in both)
    assert codes == [0, 2]
    refused = next(err for process, (_, err) in zip(both, told, strict=True) if process.returncode == 2)
    (line,) = [line for line in refused.splitlines() if line.startswith("error: ")]
    assert str(case / "model.toml") in line
    assert "at revision 1" in line
    assert "the step again" in line
    assert [r.number for r in load_history(case / "model.toml").revisions] == [1]
    assert not list(case.rglob("*.part*"))


@pytest.mark.skipif(sys.platform == "win32", reason="no locks on folders")
def test_the_lock_goes_with_its_owner(tmp_path):
    """A killed owner leaves no lock."""
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        with locked(tmp_path):
            os.write(writer, b"x")
            os.kill(os.getpid(), 9)
    os.read(reader, 1)
    os.waitpid(child, 0)
    with locked(tmp_path):
        pass
