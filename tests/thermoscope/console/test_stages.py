"""Share and time left of long work, from how long its stages took the last time."""

import json
import re
import time

import pytest

from thermoscope.console import progress_bar
from thermoscope.console.progress_bar import ProgressBar, one_bar, progress, remembering


class Clock:
    now = 0.0

    def __call__(self):
        return self.now


def worked(stages, clock, steps):
    for message, seconds in steps:
        stages.enter(message)
        clock.now += seconds


STEPS = [("reading a", 1.0), ("reading b", 1.0), ("fitting step 1", 3.0), ("fitting step 2", 3.0), ("drawing", 2.0)]


def test_the_second_time_share_and_time_left_are_known():
    clock = Clock()
    first = ProgressBar({}, clock)
    worked(first, clock, STEPS)
    first.leave()
    assert first.took == {"reading": 2.0, "fitting": 6.0, "drawing": 2.0}
    assert first.left() is None
    clock.now = 0.0
    again = ProgressBar(first.took, clock)
    worked(again, clock, STEPS[:3])
    share, seconds = again.left()
    assert share == pytest.approx(0.5)
    assert seconds == pytest.approx(5.0)
    assert progress_bar._line("fitting", again.left()) == "fitting (50 %, about 5 s left)"


def test_the_share_never_falls():
    clock = Clock()
    stages, seen = ProgressBar({"reading": 2.0, "fitting": 6.0, "drawing": 2.0}, clock), []
    for message, seconds in [("reading", 9.0), ("fitting", 1.0), ("drawing", 4.0)]:
        stages.enter(message)
        for _ in range(4):
            clock.now += seconds / 4
            seen.append(stages.left()[0])
    assert seen == sorted(seen)
    assert 0.95 < seen[-1] < 1.0


def test_a_pipe_has_one_line_a_stage(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    with progress() as tell:
        for message, _ in STEPS:
            tell(message)
    assert capsys.readouterr().err.splitlines() == ["reading a", "fitting step 1", "drawing"]


def test_time_left_follows_the_pace_of_this_run():
    """The last time 10 s in all; this run took twice as long for the first half: what is left takes twice as long."""
    clock = Clock()
    stages = ProgressBar({"reading": 5.0, "fitting": 5.0}, clock)
    clock.now = 1e6
    assert stages.left() is None, "a bar is drawn before its first stage"
    worked(stages, clock, [("reading", 10.0), ("fitting", 0.0)])
    assert stages.left() == (pytest.approx(0.5), pytest.approx(10.0))


@pytest.mark.parametrize(("reads", "rest"), [(40.0, 20.0), (1.0, 10.0), (3.0, 30.0)])
def test_stages_of_another_case_tell_little_by_one_of_them(reads, rest):
    """A file of a million rows is read forty times as long; what comes after takes twice as long, not forty times."""
    clock = Clock()
    stages = ProgressBar({"reading": 1.0, "running": 4.0, "learning": 6.0}, clock, same_case=False)
    worked(stages, clock, [("reading", reads), ("running", 0.0)])
    assert 0.3 * rest < stages.left()[1] < 3.0 * rest


def test_several_pieces_of_work_have_one_bar(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    monkeypatch.setattr("sys.argv", ["thermoscope", "demo", "--out", "x"])
    monkeypatch.setattr("thermoscope.console.progress_bar._usual", dict)
    file = tmp_path / "stages.json"
    for _ in range(2):
        with one_bar(shortest_s=1e-3):
            for _ in range(2):
                with progress() as tell:
                    tell("reading a")
                    time.sleep(0.02)
        kept = json.loads(file.read_text())
        assert list(kept) == ["demo"], "the options are no part of its name"
        assert len(kept["demo"]) == 2, "the same word in two pieces of work is two stages"
        file.write_text(json.dumps({"demo": dict.fromkeys(kept["demo"], 0.02)}))  # a busy computer takes longer for one
    shares = [int(n) for n in re.findall(r"\((\d+) %", capsys.readouterr().err)]
    assert shares == sorted(shares)
    assert len(shares) == 2, "of the second run, each stage one line"
    assert shares[-1] > 30


def test_the_first_run_of_long_commands_knows_a_share(tmp_path, monkeypatch):
    """Before anything was remembered on this computer."""
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    known = progress_bar._usual()
    assert {"demo", "explain diagnose 0", "model build 0", "model calibrate 0", "model add 0"} <= set(known)
    assert all(sum(stages.values()) > progress_bar.WORTH_S for stages in known.values())


def test_a_stage_that_counts_says_how_long_it_takes():
    """The last time it took 2 s; by its own count it takes 100 s, and what follows fifty times 3 s."""
    clock = Clock()
    stages, seen = ProgressBar({"mesh": 50.0, "reading": 2.0, "fitting": 3.0}, clock), []
    for number in range(1, 101):
        stages.enter(f"reading run{number} ({number} of 100)")
        clock.now += 0.5
        seen.append(stages.left()[0])
        clock.now += 0.5
        if number == 50:
            assert stages.left()[1] == pytest.approx(51.0 + 153.0, rel=0.03)
    assert seen == sorted(seen)
    stages.enter("fitting")
    assert stages.left()[1] == pytest.approx(150.0), "a mesh that was not needed is not waited for"


def test_the_same_stages_once_more_are_waited_for():
    """Ten steps of 40 s, where the last time there was one: in every 20 s the share moves, and something is left."""
    clock = Clock()
    last = {"reading": 1.0, "fitting": 24.0, "looking": 16.0, "1 step": 0.0, "1 fitting": 24.0, "1 looking": 16.0}
    stages, seen = ProgressBar(last, clock), []
    worked(stages, clock, [("reading", 1.0), ("fitting", 24.0), ("looking", 16.0), ("step 1: wind", 0.0)])
    assert stages.left()[1] == pytest.approx(40.0)
    for number in range(2, 10):
        for message, seconds in [("fitting", 24.0), ("looking", 16.0)]:
            stages.enter(message)
            for _ in range(int(seconds)):
                clock.now += 1.0
                seen.append(progress_bar._remaining(stages.left()).partition(" ")[0])
        stages.enter(f"step {number}: more")
        assert stages.left()[1] == pytest.approx(80.0), "this one, and one more"
    assert all(a != b for a, b in zip(seen, seen[20:]))


def test_a_line_of_80_columns_keeps_its_times():
    from io import StringIO

    from rich.console import Console

    clock, screen = Clock(), StringIO()
    stages = ProgressBar({"running": 5400.0, "writing": 60.0}, clock)
    console = Console(file=screen, force_terminal=True, width=80)
    with progress_bar._bar(stages, console) as tell:
        tell(f"running {'a test of a very long name ' * 5}(3 of 200)")
        clock.now = 60.0
        time.sleep(0.3)
    lines = [line for line in re.split(r"[\r\n]", re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "\r", screen.getvalue())) if line]
    text = re.sub(r"\s+", " ", re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", screen.getvalue()))
    assert max(len(line) for line in lines) <= 80
    assert re.search(r"[\d.]+ %, about \d+ min left 0:00:0\d", text)
    assert "…" in text


def test_a_case_is_remembered_for_itself(tmp_path, monkeypatch):
    """A large case says nothing of a small one that was looked at before."""
    monkeypatch.setenv("THERMOSCOPE_CACHE", str(tmp_path))
    for case, seconds in (("small", 3.0), ("large", 300.0)):
        monkeypatch.setattr("sys.argv", ["thermoscope", "test", "compare", case])
        with remembering("test compare", progress_bar._case()) as stages:
            stages.took["running"] = seconds
    for case, seconds in (("small", 3.0), ("large", 300.0), ("new", 300.0)):
        monkeypatch.setattr("sys.argv", ["thermoscope", "test", "compare", case])
        with remembering("test compare", progress_bar._case()) as stages:
            assert stages.last == {"running": seconds}
