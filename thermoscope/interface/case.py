"""An open case in a script: compare, diagnose, add, calibrate, save, plot. A step gives a new case; this one stays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from geom.errors import InputError
from geom.table import Table, TableResult
from geom.text import counted, table
from thermoscope.case_folder.folder import Folder, find_case, load_case
from thermoscope.case_folder.history import History, save_history
from thermoscope.interface.notebook import Progress, hearing, silent
from thermoscope.parts import explained
from validation.effects import catalogue
from validation.effects.registry import kinds
from validation.parameters.unknowns import scene_of, standing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from lumped.model.network import Network
    from measured.case import Test
    from validation.comparison.compare import Comparison
    from validation.effects.base import Effect
    from validation.inference.result import Diagnosis
    from validation.revision.revise import Revision


@dataclass(frozen=True)
class Case(TableResult):
    """Measurements and the model held against them.

    folder : what the files hold, with the model as it stands here;  on_disk : the history that model.toml holds
    steps : what was done since, oldest first
    progress : is told what is going on; in a notebook that names none, a bar shows it
    """

    folder: Folder
    on_disk: History
    steps: tuple[Revision, ...] = ()
    progress: Progress = silent

    def __repr__(self) -> str:
        (content,) = self.tables()
        effects = f" with {', '.join(self.effects)}" if self.effects else ""
        unsaved = f", {counted(len(self.steps), 'step')} not saved" if self.steps else ""
        return (
            f"Case '{self.name}', revision {self.folder.history.last.number}{effects}{unsaved}\n"
            f"{table(content.columns, content.rows)}"
        )

    def tables(self) -> tuple[Table, ...]:
        """A row for each test."""
        rows = [[t.name, t.role, len(t.channels), (t.time[-1] - t.time[0]) / 60.0] for t in self.folder.case.tests]
        return (Table("", ["test", "role", "sensors", "minutes"], rows),)

    @property
    def name(self) -> str:
        return self.folder.case.name

    @property
    def tests(self) -> Mapping[str, Test]:
        """Test by name: time (s), inputs, boundaries (degC), channels with their readings (degC) and 1 sigma (K)."""
        return {test.name: test for test in self.folder.case.tests}

    @property
    def network(self) -> Network:
        """The network with the effects that were added."""
        return standing(self.folder.case)

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the effects in the model, "kind@place"."""
        return tuple(effect.name for effect in self.folder.case.model.effects)

    @property
    def values(self) -> Mapping[str, float]:
        """Calibrated value by parameter, in the parameter's unit."""
        return dict(self.folder.case.model.values)

    def candidates(self) -> tuple[Effect, ...]:
        """Every effect at every place of this network where it can sit."""
        return catalogue(scene_of(self.folder.case), self.folder.settings.kinds)

    def compare(self) -> Comparison:
        """The model against every test: error per sensor (K) against the uncertainty of reading, inputs, arithmetic.

        Source: ASME V&V 20-2009 (expanded uncertainty).
        """
        with hearing(self.progress, "test compare", str(self.folder.settings.path)):
            return self.folder.compared

    def diagnose(self, without: Sequence[str] = (), only: Sequence[str] = (), quick: bool = False) -> Diagnosis:
        """Which effect is missing, with its probability and size; kept in the case's out/, as the command does.

        without, only : kinds of effects, "kind@place" or "sensors" to leave out, or to ask about alone
        quick : stop at the first odds, which are preliminary and not kept

        Source: Kass and Raftery 1995, J. Am. Stat. Assoc. 90, 773 (probabilities from evidence).
        """
        from thermoscope.commands.explain.diagnose import diagnosed

        with hearing(self.progress, "explain diagnose", str(self.folder.settings.path)) as tell:
            return diagnosed(self.folder, tell, without, only, quick)[0]

    def add(self, effect: str) -> Case:
        """With the effect "kind@place", calibrated on all tests but the held-out ones.

        Raises InputError for an unknown effect, or one that cannot sit there.
        """
        from thermoscope.commands.model.revise import meant
        from validation.revision.revise import add

        with hearing(self.progress, "model add", str(self.folder.settings.path)) as tell:
            return self._after(add(self.folder.case, meant(self.folder, effect), tell))

    def remove(self, effect: str) -> Case:
        """Without the effect, calibrated again. Raises InputError if the model does not hold it."""
        from validation.revision.revise import remove

        with hearing(self.progress, "model add", str(self.folder.settings.path)) as tell:
            return self._after(remove(self.folder.case, effect, tell))

    def calibrate(self) -> Case:
        """With what case.toml leaves free fitted to the calibration tests; intervals are in `steps[-1].parameters`."""
        from validation.revision.revise import calibrate

        with hearing(self.progress, "model calibrate", str(self.folder.settings.path)) as tell:
            return self._after(calibrate(self.folder.case, progress=tell))

    def save(self, anyway: bool = False) -> Case:
        """Write the steps to model.toml, one revision each.  anyway : also those that were not accepted

        Raises InputError where a step was not accepted, where the case came with the tool, or where another program
        has changed model.toml since.
        """
        from thermoscope.case_folder.columns import write_columns
        from thermoscope.commands.open_case import PACKAGE

        refused = [s for s in self.steps if not s.accepted and s.action != "remove"]
        if refused and not anyway:
            what = f"{refused[0].action} {refused[0].effect or ''}".strip()
            raise InputError(f"was not accepted: {refused[0].why}", what, "save(anyway=True) writes it")
        path = self.folder.settings.path
        if PACKAGE in path.resolve().parents:
            raise InputError("came with the tool and is not changed", str(path), "a copy of the folder, opened instead")
        history = save_history(self.folder.settings.model_file, self.folder.history, self.on_disk)
        write_columns(self.folder, history.last.effects)
        return replace(self, folder=replace(self.folder, history=history), on_disk=history, steps=())

    @explained()
    def plot(self, test: str | None = None, png: str | Path | None = None) -> Figure:
        """Measured and modelled (degC) over time, a panel per sensor; beside the model before the last step.

        test : its name; else the first that was never used to fit. Raises InputError for an unknown one.
        """
        from thermoscope.case_folder.runs import by_interest, comparison_of
        from viz import measured_and_model

        if test is not None and test not in self.tests:
            raise InputError(f"no test '{test}'", f"case '{self.name}'", f"one of {', '.join(self.tests)}")
        subject = by_interest(self.folder)[0] if test is None else self.tests[test]
        return measured_and_model(comparison_of(self.folder, subject), png=png)

    def _after(self, step: Revision) -> Case:
        from thermoscope.commands.model.revise import evidence, recorded

        history = self.folder.history.and_then(recorded(step, evidence(self.folder, step)))
        case = replace(self.folder.case, model=step.model)
        return replace(self, folder=replace(self.folder, case=case, history=history), steps=(*self.steps, step))


def open(path: str | Path, progress: Progress = silent) -> Case:
    """A case: a folder with case.toml, or the name of a case that comes along.

    progress : is told what is going on; in a notebook that names none, a bar shows it

    Raises InputError: file, key or column, what is wrong with it, and what would be right.
    """
    with hearing(progress, "open", str(path)) as tell:
        folder = load_case(find_case(path), tell)
    return Case(folder, folder.history, progress=progress)


class Effects(dict[str, "type[Effect]"], TableResult):
    """Kinds of effects by name; shown as a table."""

    def __repr__(self) -> str:
        (content,) = self.tables()
        return f"{len(self)} kinds of effects\n{table(content.columns, content.rows)}"

    def tables(self) -> tuple[Table, ...]:
        """What each is, what it needs to be seen, and the test that would prove it."""
        columns = "effect=kind | title | unit | needs | proof=isolating_test | source"
        return (Table.of("", self.values(), columns, needs=lambda kind: ", ".join(kind.needs)),)


def effects() -> Effects:
    """Every kind of effect by name, those of other packages too (entry points "thermoscope.effects").

    Each says its title, unit, typical size, needs, source and isolating_test.
    """
    return Effects(kinds())
