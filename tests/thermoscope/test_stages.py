"""Share and time left of long work, from how long its stages took the last time."""

import pytest

from thermoscope.console.progress_bar import ProgressBar, progress


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
    assert again.words("fitting") == "fitting (50 %, about 5 s left)"


def test_the_share_never_falls():
    clock = Clock()
    stages, seen = ProgressBar({"reading": 2.0, "fitting": 6.0, "drawing": 2.0}, clock), []
    for message, seconds in [("reading", 9.0), ("fitting", 1.0), ("drawing", 4.0)]:
        stages.enter(message)
        for _ in range(4):
            clock.now += seconds / 4
            seen.append(stages.left()[0])
    assert seen == sorted(seen)
    assert seen[-1] == 0.99


def test_a_pipe_has_one_line_a_stage(capsys):
    with progress() as tell:
        for message, _ in STEPS:
            tell(message)
    assert capsys.readouterr().err.splitlines() == ["reading a", "fitting step 1", "drawing"]
