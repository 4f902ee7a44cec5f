"""thermoscope model calibrate CASE"""

from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

import typer

from geom.errors import InputError
from geom.table import Table
from geom.text import counted
from lumped.schemas.reader import suggestion
from measured.sensors.operators import of_measurement
from thermoscope.case_folder.folder import Folder
from thermoscope.commands.model.revise import revised
from thermoscope.commands.open_case import fingerprint, store, stored
from thermoscope.console.options import Anyway, Case, Json
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import Progress, give, notes
from validation.parameters.unknowns import value_words, working

if TYPE_CHECKING:
    from validation.revision.revise import Revision

NAME = "calibration.json"


def calibrate(
    case: Case,
    anyway: Anyway = False,
    target: Json = None,
    profile: Annotated[list[str] | None, typer.Option(metavar="GLOB", help="Profile these parameters too.")] = None,
    starts: Annotated[int | None, typer.Option(min=1, max=1000, help="Fits from so many points of the prior.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, max=2**32 - 1, help="Of the points.")] = None,
) -> int:
    """Fit the declared parameters to the calibration tests, with intervals and what the data cannot identify."""
    from validation.calibration.staged_fit import Search
    from validation.revision.revise import calibrate as fitted

    def step(folder: Folder, tell: Progress) -> "Revision":
        unfinished = Unfinished(folder)
        usual = folder.settings
        many, first_seed = usual.starts if starts is None else starts, usual.seed if seed is None else seed
        names = working(folder.case)[1].names
        for glob in profile or ():
            if not any(fnmatchcase(name, glob) for name in names):
                raise InputError(f"'{glob}' is not a free parameter", "--profile", suggestion(glob, names))
        search = Search(many, first_seed, unfinished.values(tell), unfinished.keep)
        try:
            result = fitted(folder.case, progress=tell, profiled=tuple(profile or ()), search=search)
        except KeyboardInterrupt:
            unfinished.show(folder, case)
            raise
        unfinished.done()
        return result

    return revised(case, step, anyway, target)


class Unfinished:
    """The values a calibration has reached so far, in out/, until it is done."""

    def __init__(self, folder: Folder) -> None:
        self.path: Path = folder.settings.out / NAME
        self.of = fingerprint(folder.settings.path)
        self.reached: dict[str, float] = {}

    def values(self, tell: Progress) -> dict[str, float]:
        """Those of an interrupted calibration of this very case, else none."""
        document = stored(self.path)
        if document is None or document.get("fingerprint") != self.of:
            return {}
        tell("going on with the calibration that was interrupted")
        self.reached = document["values"]
        return dict(self.reached)

    def keep(self, values: Mapping[str, float]) -> None:
        self.reached |= values
        store(self.path, {"fingerprint": self.of, "values": self.reached})

    def show(self, folder: Folder, called: str) -> None:
        """What is known of a fit that the user stopped, and where it is kept; no document, which is of a whole fit."""
        parameters = [p for p in working(folder.case)[1].parameters if p.name in self.reached and not of_measurement(p)]
        values = {p: (folder.case.model.values.get(p.name, p.value), self.reached[p.name]) for p in parameters}
        farthest_first = sorted(
            parameters, key=lambda p: -abs(values[p][1] - values[p][0]) / max(abs(values[p][0]), 1e-300)
        )
        rows = [[value_words(p.name), *values[p], "" if p.unit == "1" else p.unit] for p in farthest_first]
        if not rows:
            return
        grid = Table(
            "As far as the fit came", ["parameter", "before", "now", "unit"], rows, keep=["before", "now", "unit"]
        )
        count = counted(len(rows), "parameter")
        sentence = f"Stopped before the fit converged: {count} had moved; model.toml is as it was."
        more = f"thermoscope model calibrate {quote(called)} goes on from there"
        give({}, None, lambda: Summary(sentence, [grid], more))
        notes([f"stopped: the values reached so far are kept in {self.path}, and the same command goes on from them"])

    def done(self) -> None:
        self.path.unlink(missing_ok=True)
