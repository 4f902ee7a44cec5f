"""What all tabs share: the open case, its first comparison, and the machines that they show.

Each machine is drawn once, in a process of its own, for every tab that waits for it.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from extras.workbench.appearance import Appearance
from extras.workbench.jobs import Job, StoppedError
from thermoscope import plugin as th

MOST_DOCUMENTS = 8  # of machines, about 1 MB each
PARTS = 3  # of a machine: in one test, in every test, then what takes longest
NO_MACHINE = "This case has a network declared by hand, so there is no machine to show."

Document = dict[str, Any]


class Drawing:
    """A model's machine while it is drawn.  parts : what there is of it so far, FailedError or StoppedError"""

    def __init__(self, history: th.History, job: Job) -> None:
        loop = asyncio.get_running_loop()
        self.history, self.stopped = history, False
        self.parts: list[asyncio.Future[Document]] = [loop.create_future() for _ in range(PARTS)]
        self._message, self._listeners = "starting", list[th.Progress]()
        self._job = job
        self.task = loop.create_task(self._job.run(self._tell, self._take))
        self.task.add_done_callback(self._end)

    def hear(self, tell: th.Progress) -> None:
        """`tell` hears how far it is, until it leaves."""
        self._listeners.append(tell)
        tell(self._message)

    def leave(self, tell: th.Progress) -> None:
        """A tab wants it no more; nobody draws what no tab wants."""
        if tell in self._listeners:
            self._listeners.remove(tell)
            if not self._listeners:
                self.stop()

    def stop(self) -> None:
        """End it, whoever waits."""
        self.stopped = True
        self._job.stop()

    def document(self) -> Document | None:
        """All of it, once it is there."""
        whole = all(part.done() and not part.exception() for part in self.parts)
        return {k: v for part in self.parts for k, v in part.result().items()} if whole else None

    def _tell(self, message: str) -> None:
        self._message = message
        for tell in self._listeners:
            tell(message)

    def _take(self, part: Document) -> None:
        next(future for future in self.parts if not future.done()).set_result(part)

    def _end(self, task: asyncio.Task[None]) -> None:
        fault = StoppedError() if task.cancelled() else task.exception() or StoppedError()
        for part in self.parts:
            if not part.done():
                part.set_exception(fault)
                part.exception()  # asked for: a part that no tab waits for is not an error


@dataclass
class Machines:
    """The documents of the last MOST_DOCUMENTS machines, and those that are being drawn."""

    documents: list[tuple[th.History, Document]] = field(default_factory=list)
    drawings: list[Drawing] = field(default_factory=list)

    def find(self, history: th.History) -> Document | None:
        return next((document for model, document in self.documents if model == history), None)

    def drawing(self, folder: th.Folder, job_of: Callable[[th.Folder], Job]) -> Drawing:
        """The one under way for this model, or a new one."""
        for drawing in self.drawings:
            if drawing.history == folder.history and not drawing.stopped:
                return drawing
        drawing = Drawing(folder.history, job_of(folder))
        self.drawings.append(drawing)
        drawing.task.add_done_callback(lambda task: self._end(drawing))
        return drawing

    def stop(self) -> None:
        """End what is under way."""
        for drawing in self.drawings:
            drawing.stop()

    def _end(self, drawing: Drawing) -> None:
        self.drawings.remove(drawing)
        document = drawing.document()
        if document is not None:
            self.documents = [*self.documents, (drawing.history, document)][-MOST_DOCUMENTS:]


@dataclass
class Bench:
    """folder : the case as opened;  first : its model when it was opened, None until it is compared

    machines : of the models that tabs showed
    """

    folder: th.Folder
    first: Appearance | None = None
    machines: Machines = field(default_factory=Machines)
    _comparing: asyncio.Task[Appearance] | None = None
    _job: Job | None = None

    @property
    def why_flat(self) -> str:
        """Why there is no machine to show; empty where there is one."""
        return NO_MACHINE if self.folder.built is None else ""

    async def compared(self, job_of: Callable[[th.Folder], Job]) -> Appearance:
        """The model when it was opened, compared once for all tabs that wait. FailedError, StoppedError"""
        if self.first is None:
            if self._comparing is None:
                self._comparing = asyncio.get_running_loop().create_task(self._compare(job_of(self.folder)))
            self.first = await asyncio.shield(self._comparing)
        return self.first

    async def _compare(self, job: Job) -> Appearance:
        """Once the first picture of the machine is there, or cannot be had: both want all of the computer."""
        self._job = job
        if self.machines.drawings:
            await asyncio.wait([self.machines.drawings[0].parts[0]])
        return await job.run(lambda message: None)

    def stop(self) -> None:
        """End what is under way."""
        self.machines.stop()
        if self._job is not None:
            self._job.stop()
