"""A model's machine is drawn once, beside everything else, for all tabs that wait for it; one test comes first."""

import asyncio
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from extras.workbench import serve
from extras.workbench.appearance import Appearance
from extras.workbench.jobs import FailedError, StoppedError
from extras.workbench.machines import Bench, Machines
from extras.workbench.steps import comparing_job, drawing_job
from thermoscope.case_folder.history import History

FIRST, EVERY, REST = {"fields": 1, "points": 4}, {"fields": 3}, {"network": 2}


def counted(folder, tell):
    """Stands for the drawing of a machine; every call leaves a mark."""
    with Path(folder.log).open("a") as log:
        log.write("x")
    tell("half 1/2")
    wait_for(folder.begin)
    yield FIRST
    wait_for(folder.go)
    if folder.fault:
        raise ValueError(folder.fault)
    yield EVERY
    yield REST


def wait_for(file):
    while not Path(file).exists():
        time.sleep(0.01)


def compared(folder, tell):
    """Stands for the first comparison; it ends only while the machine is drawn."""
    Path(folder.compared).touch()
    if folder.fault:
        raise ValueError(folder.fault)
    wait_for(folder.log)
    return Appearance({"rmse_K": 1.0}, {})


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr("extras.workbench.steps.machine_documents", counted)
    files = {name: str(tmp_path / name) for name in ("log", "begin", "go", "compared")}
    for name in ("begin", "go"):  # what holds the first picture and the rest back where they are not there
        Path(files[name]).touch()
    return SimpleNamespace(history=History(), fault="", built="a machine", **files)


async def ended(machines):
    """Wait until no drawing is under way: the last part of one comes before its process has ended."""
    for _ in range(6000):
        if not machines.drawings:
            return
        await asyncio.sleep(0.01)
    pytest.fail("a drawing never ended")


def test_two_tabs_wait_for_one_drawing(folder):
    Path(folder.go).unlink()

    async def main():
        machines, heard = Machines(), ([], [])
        first, second = machines.drawing(folder, drawing_job), machines.drawing(folder, drawing_job)
        first.hear(heard[0].append)
        second.hear(heard[1].append)
        early = await first.parts[0], first.parts[1].done()
        Path(folder.go).touch()
        rest = await second.parts[2]
        await ended(machines)
        return machines, early, rest, heard

    machines, early, rest, heard = asyncio.run(main())
    assert early == (FIRST, False)
    assert rest == REST
    assert Path(folder.log).read_text() == "x"
    assert heard == (["starting", "half 1/2"], ["starting", "half 1/2"])
    assert machines.find(folder.history) == {**FIRST, **EVERY, **REST}
    assert machines.drawings == []


def test_a_machine_without_its_rest_is_shown_and_drawn_anew_when_asked_again(folder):
    folder.fault = "no covariance"

    async def main():
        machines = Machines()
        drawing = machines.drawing(folder, drawing_job)
        first = await drawing.parts[0]
        with pytest.raises(FailedError, match="no covariance"):
            await drawing.parts[2]
        await ended(machines)
        return first, machines.find(folder.history), machines.drawings

    assert asyncio.run(main()) == (FIRST, None, [])


def test_a_tab_that_leaves_stops_nobody_else(folder):
    async def main():
        drawing, left, stays = Machines().drawing(folder, drawing_job), [], []
        drawing.hear(stays.append)
        drawing.hear(left.append)
        drawing.leave(left.append)
        return await drawing.parts[2], left

    assert asyncio.run(main()) == (REST, ["starting"])


def test_what_no_tab_wants_is_stopped_and_made_anew_when_asked_again(folder):
    Path(folder.go).unlink()

    async def main():
        machines, heard = Machines(), []
        drawing = machines.drawing(folder, drawing_job)
        drawing.hear(heard.append)
        while "half 1/2" not in heard:
            await asyncio.sleep(0.01)
        drawing.leave(heard.append)
        again = machines.drawing(folder, drawing_job)
        with pytest.raises(StoppedError):
            await drawing.parts[1]
        again.stop()
        return drawing is again, machines.find(folder.history)

    assert asyncio.run(main()) == (False, None)


def test_a_job_may_begin_before_there_is_a_loop(folder):
    job = drawing_job(folder)
    job.start()

    async def main():
        drawing = Machines().drawing(folder, lambda _: job)
        return [await part for part in drawing.parts]

    assert asyncio.run(main()) == [FIRST, EVERY, REST]
    assert Path(folder.log).read_text() == "x"


def test_the_machine_is_drawn_while_the_model_is_compared(folder, monkeypatch):
    """Both begin with the server, before anyone asks; all tabs wait for one comparison."""
    monkeypatch.setattr("extras.workbench.steps.first_appearance", compared)

    async def main():
        bench = Bench(folder)
        task = asyncio.create_task(serve._prepared(bench))
        looks = await asyncio.gather(bench.compared(comparing_job), bench.compared(comparing_job))
        await task
        rest = await bench.machines.drawings[0].parts[2] if bench.machines.drawings else REST
        bench.stop()
        return looks, bench.first, rest

    (one, other), first, rest = asyncio.run(main())
    assert one is other is first
    assert rest == REST
    assert first.errors == {"rmse_K": 1.0}
    assert Path(folder.log).read_text() == "x"


@pytest.mark.parametrize("succeeds", [True, False])
def test_the_comparison_waits_for_the_first_picture_or_until_there_will_be_none(folder, monkeypatch, succeeds):
    """Two cores cannot do both at once, and the page waits for the picture."""
    monkeypatch.setattr("extras.workbench.steps.first_appearance", compared)
    Path(folder.begin).unlink()

    async def main():
        bench = Bench(folder)
        task = asyncio.create_task(serve._prepared(bench))
        while not Path(folder.log).exists():
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.2)
        early = Path(folder.compared).exists()
        if succeeds:
            Path(folder.begin).touch()
        else:
            bench.machines.stop()
        await task
        bench.stop()
        return early, bench.first

    early, first = asyncio.run(main())
    assert not early
    assert first is not None


def test_a_comparison_that_fails_is_said_to_every_tab(folder, monkeypatch):
    monkeypatch.setattr("extras.workbench.steps.first_appearance", compared)
    folder.built, folder.fault = None, "no readings"

    async def main():
        bench = Bench(folder)
        await serve._prepared(bench)
        with pytest.raises(FailedError, match="no readings"):
            await bench.compared(comparing_job)
        return bench.first

    assert asyncio.run(main()) is None
