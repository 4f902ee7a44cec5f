"""What all tabs share: the open case, and the machine's surface, cut once. Nothing here changes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from geom.errors import MissingDependency
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.history import History
from thermoscope.case_folder.runs import at_revision, temperature_range
from thermoscope.console.terminal import Progress
from thermoscope.workbench.appearance import Appearance, appearance_of

if TYPE_CHECKING:
    from viz.rendering.cut import Surface


NO_MACHINE = "This case has a network declared by hand, so there is no machine to show."


@dataclass(frozen=True)
class Bench:
    """folder : the case as opened;  first : its model when it was opened

    surface : the machine cut open, None without geometry or without OpenGL;  why_flat : which of the two, else ""
    """

    folder: Folder
    first: Appearance
    surface: Surface | None = None
    why_flat: str = ""

    @cached_property
    def limits(self) -> tuple[float, float]:
        """Coldest and hottest temperature that colours show (degC), of a case with a surface."""
        assert self.surface is not None
        return temperature_range(self.folder, self.surface.nodes)


def at(folder: Folder, history: History) -> Folder:
    """The case with the model that `history` ends with."""
    return replace(folder, case=at_revision(folder, history.last), history=history)


def bench(folder: Folder, tell: Progress) -> Bench:
    """Cut the machine open, if there is one and this computer can draw it, and run the model once."""
    surface, why_flat = _surface(folder)
    tell("running the model on every test")
    return Bench(folder, appearance_of(folder, surface), surface, why_flat)


def _surface(folder: Folder) -> tuple[Surface | None, str]:
    if folder.built is None:
        return None, NO_MACHINE
    from viz import require_gl, split
    from viz.rendering.cut import cut_away

    try:
        require_gl()
    except MissingDependency as fault:
        return None, str(fault)
    return cut_away(split(folder.built.mesh)), ""
