"""A calculation in a process of its own: it cannot freeze a page, and it can be stopped."""

import asyncio
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from typing import Any

from thermoscope import ThermoscopeError

Tell = Callable[[str], None]
PRELOAD = [
    "extras.workbench.steps",
    "lumped.build.pipeline",
    "thermoscope.commands.model.revise",
    "validation.diagnosis",
    "validation.revision.revise",
    "thermoscope.case_folder.error_field",
    "viz.viewer.page",
    "thermoscope.kernels",
    "pyvista",
    "matplotlib",
]


class StoppedError(Exception):
    """The calculation was stopped, or its process died."""


class FailedError(Exception):
    """The calculation ended with an error; the message says which."""


def starter() -> Any:
    """How processes are made: from a small server that has loaded the packages, where the system can do that."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(PRELOAD)
    return context


def prepare() -> None:
    """Start that small server now, so that the first calculation need not wait for it."""
    from multiprocessing import forkserver

    if starter().get_start_method() == "forkserver":
        forkserver.ensure_running()


class Job:
    """One run of work(*arguments, tell); a generator gives its parts one by one, and no result."""

    def __init__(self, work: Callable[..., Any], *arguments: Any) -> None:
        self._work, self._arguments = work, arguments
        self._process: Any = None
        self._pipe: Any = None

    def start(self) -> None:
        """Begin before there is anyone to hear of it; what it says waits for `run`."""
        context = starter()
        self._pipe, its = context.Pipe(duplex=False)
        self._process = context.Process(target=_run, args=(its, self._work, self._arguments))
        self._process.start()
        its.close()

    async def run(self, tell: Tell, take: Callable[[Any], None] = lambda part: None) -> Any:
        """The result; `tell` is called in this thread with every message, `take` with every part.

        FailedError or StoppedError otherwise.
        """
        if self._process is None:
            await asyncio.to_thread(self.start)
        mine = self._pipe
        try:
            while True:
                kind, value = await asyncio.to_thread(mine.recv)
                if kind == "done":
                    return value
                if kind == "failed":
                    raise FailedError(value)
                {"tell": tell, "part": take}[kind](value)
        except EOFError:
            raise StoppedError("the calculation was stopped") from None
        finally:
            mine.close()
            await asyncio.to_thread(self._process.join, 5)

    def stop(self) -> None:
        """End the process and all it started."""
        if self._process is not None and self._process.is_alive():
            try:
                os.killpg(self._process.pid, signal.SIGTERM)
            except (ProcessLookupError, PermissionError):
                self._process.terminate()


def _run(pipe: Connection, work: Callable[..., Any], arguments: tuple) -> None:
    """In the other process: leader of its own group, so that stopping it stops its own helpers too."""
    os.setpgrp()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        result = work(*arguments, lambda text: pipe.send(("tell", text)))
        if isinstance(result, Iterator):
            for part in result:
                pipe.send(("part", part))
            result = None
        message = "done", result
    except (ThermoscopeError, OSError) as fault:
        message = "failed", str(fault)
    except Exception as fault:  # whatever it is, the page says so and lives on
        message = "failed", f"{type(fault).__name__}: {fault}"
    pipe.send(message)
