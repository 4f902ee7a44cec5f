"""What all tabs share: the open case, its first comparison, and the machines that were drawn."""

from __future__ import annotations

from dataclasses import dataclass, field

from thermoscope.case_folder.folder import Folder
from thermoscope.console.terminal import Progress
from thermoscope.workbench.appearance import Appearance, appearance_of
from thermoscope.workbench.machines import Machines

NO_MACHINE = "This case has a network declared by hand, so there is no machine to show."


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


def bench(folder: Folder, tell: Progress) -> Bench:
    """Run the model once on every test."""
    tell("running the model on every test")
    return Bench(folder, appearance_of(folder))
