"""What all tabs share: the open case, its first comparison, and the pages of the machines that were drawn."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field, replace

from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import History
from thermoscope.case_folder.runs import at_revision
from thermoscope.commands.show.viewer import viewer_page
from thermoscope.console.terminal import Progress
from thermoscope.workbench.appearance import Appearance, appearance_of
from thermoscope.workbench.jobs import Job

NO_MACHINE = "This case has a network declared by hand, so there is no machine to show."
MOST_PAGES = 8  # pages of machines, about 1 MB each


class Drawing:
    """The page of a model's machine while it is made: once, for every tab that waits for it."""

    def __init__(self, folder: Folder) -> None:
        self.history, self.stopped = folder.history, False
        self._message, self._listeners, self._job = "starting", list[Progress](), Job(viewer_page, folder)
        self.task = asyncio.get_running_loop().create_task(self._job.run(self._tell))

    async def page(self, tell: Progress) -> str:
        """The page; `tell` hears how far it is. FailedError or StoppedError as from a job."""
        self._listeners.append(tell)
        tell(self._message)
        return await asyncio.shield(self.task)

    def leave(self, tell: Progress) -> None:
        """A tab wants it no more; nobody makes what no tab wants."""
        if tell in self._listeners:
            self._listeners.remove(tell)
            if not self._listeners:
                self.stop()

    def stop(self) -> None:
        """End it, whoever waits."""
        self.stopped = True
        self._job.stop()

    def _tell(self, message: str) -> None:
        self._message = message
        for tell in self._listeners:
            tell(message)


@dataclass
class Machines:
    """Pages that play a model on the machine in the browser's own GL, the last MOST_PAGES of them."""

    pages: list[tuple[History, str]] = field(default_factory=list)
    drawings: list[Drawing] = field(default_factory=list)

    def find(self, history: History) -> str | None:
        return next((page for model, page in self.pages if model == history), None)

    def drawing(self, folder: Folder) -> Drawing:
        """The one under way for this model, or a new one."""
        for drawing in self.drawings:
            if drawing.history == folder.history and not drawing.stopped:
                return drawing
        drawing = Drawing(folder)
        self.drawings.append(drawing)
        drawing.task.add_done_callback(lambda task: self._end(drawing, task))
        return drawing

    def stop(self) -> None:
        """End what is under way."""
        for drawing in self.drawings:
            drawing.stop()

    def _end(self, drawing: Drawing, task: asyncio.Task[str]) -> None:
        self.drawings.remove(drawing)
        if not task.cancelled() and task.exception() is None:
            self.pages = [*self.pages, (drawing.history, task.result())][-MOST_PAGES:]


@dataclass(frozen=True)
class Bench:
    """folder : the case as opened;  first : its model when it was opened;  machines : of the models that tabs showed"""

    folder: Folder
    first: Appearance
    machines: Machines = field(default_factory=Machines)

    @property
    def why_flat(self) -> str:
        """Why there is no machine to show; empty where there is one."""
        return NO_MACHINE if self.folder.built is None else ""


def at(folder: Folder, history: History) -> Folder:
    """The case with the model that `history` ends with."""
    return replace(folder, case=at_revision(folder, history.last), history=history)


def bench(folder: Folder, tell: Progress) -> Bench:
    """Run the model once on every test. The machine is drawn later, while the page is loaded."""
    tell("running the model on every test")
    return Bench(folder, appearance_of(folder))
