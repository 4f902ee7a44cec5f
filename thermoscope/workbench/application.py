"""What all tabs share: the open case, its first comparison, and the pages of the machines that were drawn."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import History
from thermoscope.case_folder.runs import at_revision
from thermoscope.commands.show.viewer import viewer_page
from thermoscope.console.terminal import Progress
from thermoscope.workbench.appearance import Appearance, appearance_of

NO_MACHINE = "This case has a network declared by hand, so there is no machine to show."
MOST_PAGES = 8  # pages of machines, about 1 MB each


@dataclass
class Machines:
    """Pages that play a model on the machine in the browser's own GL, the last MOST_PAGES of them."""

    pages: list[tuple[History, str]] = field(default_factory=list)

    def find(self, history: History) -> str | None:
        return next((page for model, page in self.pages if model == history), None)

    def store(self, history: History, page: str) -> None:
        self.pages = [*self.pages, (history, page)][-MOST_PAGES:]


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
    """Run the model once on every test, and draw the machine if there is one: the first page shows it at once."""
    tell("running the model on every test")
    opened = Bench(folder, appearance_of(folder))
    if folder.built is not None:
        opened.machines.store(folder.history, viewer_page(folder, tell))
    return opened
