"""Calculations in processes of their own: results, messages, failures, and a clean end of all they started."""

import asyncio
import multiprocessing
import os
import time
from pathlib import Path

import pytest

from extras.workbench.jobs import FailedError, Job, StoppedError
from extras.workbench.session import share
from geom.errors import InputError


def doubled(x, tell):
    tell("half 1/2")
    return 2 * x, os.getpid()


def refusing(tell):
    raise InputError("no such effect 'x'", "case", "known: y")


def broken(tell):
    raise ZeroDivisionError("division by zero")


def forever(file: str, tell):
    """Starts a helper of its own, says so, and never ends."""
    helper = multiprocessing.get_context("fork").Process(target=_wait)
    helper.start()
    Path(file).write_text(str(helper.pid))
    tell("waiting")
    helper.join()


def _wait():
    time.sleep(600)


def test_result_and_messages_come_from_another_process():
    heard = []
    (value, pid) = asyncio.run(Job(doubled, 21).run(heard.append))
    assert value == 42
    assert pid != os.getpid()
    assert heard == ["half 1/2"]


@pytest.mark.parametrize(("work", "words"), [(refusing, "no such effect 'x'"), (broken, "ZeroDivisionError")])
def test_failures_are_one_message(work, words):
    with pytest.raises(FailedError, match=words):
        asyncio.run(Job(work).run(lambda message: None))


def test_stopping_ends_the_process_and_its_helpers(tmp_path):
    file = tmp_path / "pid"

    async def main():
        job = Job(forever, str(file))
        await job.run(lambda message: job.stop())

    with pytest.raises(StoppedError):
        asyncio.run(main())
    assert ends(int(file.read_text()))


def ends(pid: int) -> bool:
    """It ends, or waits to be collected, soon: a signal closes a process's files before the process is gone."""
    for _ in range(500):
        if gone(pid):
            return True
        time.sleep(0.02)
    return False


def gone(pid: int) -> bool:
    try:
        return "State:\tZ" in Path(f"/proc/{pid}/status").read_text()
    except (FileNotFoundError, ProcessLookupError):
        return True


def test_progress_is_read_from_the_messages():
    said = {"simulated null 12/40": 30.0, "scoring": None, "0/0": None, "40/40": 100.0}
    assert {message: share(message) for message in said} == said
