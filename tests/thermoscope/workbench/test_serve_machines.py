"""The page of a model's machine is made once, beside everything else, for all tabs that wait for it."""

import asyncio
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from thermoscope.case_folder.history import History
from thermoscope.workbench import application
from thermoscope.workbench.application import Machines
from thermoscope.workbench.jobs import StoppedError


def counted(folder, tell):
    """Stands for the page of a machine; every call leaves a mark."""
    with Path(folder.log).open("a") as log:
        log.write("x")
    tell("half 1/2")
    time.sleep(folder.seconds)
    return "page"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(application, "viewer_page", counted)
    return SimpleNamespace(history=History(), log=str(tmp_path / "log"), seconds=0.5)


def test_two_tabs_wait_for_one_drawing(folder):
    async def main():
        machines, heard = Machines(), ([], [])
        first, second = machines.drawing(folder), machines.drawing(folder)
        pages = await asyncio.gather(first.page(heard[0].append), second.page(heard[1].append))
        await asyncio.sleep(0)
        return machines, pages, heard

    machines, pages, heard = asyncio.run(main())
    assert pages == ["page", "page"]
    assert Path(folder.log).read_text() == "x"
    assert heard == (["starting", "half 1/2"], ["starting", "half 1/2"])
    assert machines.find(folder.history) == "page"
    assert machines.drawings == []


def test_a_tab_that_leaves_stops_nobody_else(folder):
    async def main():
        drawing, left, stays = Machines().drawing(folder), [], []
        waiting = asyncio.create_task(drawing.page(stays.append))
        other = asyncio.create_task(drawing.page(left.append))
        await asyncio.sleep(0)
        drawing.leave(left.append)
        other.cancel()
        return await waiting, left

    assert asyncio.run(main()) == ("page", ["starting"])


def test_what_no_tab_wants_is_stopped_and_made_anew_when_asked_again(folder):
    folder.seconds = 600.0

    async def main():
        machines, heard = Machines(), []
        drawing = machines.drawing(folder)
        waiting = asyncio.create_task(drawing.page(heard.append))
        while "half 1/2" not in heard:
            await asyncio.sleep(0.01)
        drawing.leave(heard.append)
        again = machines.drawing(folder)
        with pytest.raises(StoppedError):
            await waiting
        again.stop()
        return drawing is again, machines.find(folder.history)

    assert asyncio.run(main()) == (False, None)
