"""A case folder: case.toml, tests/NAME.csv with tests/NAME.toml, model.toml -> the case the rooms work on."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from geom.errors import InputError
from lumped.model.network import Network, Parameter
from lumped.model.sites import ASSUMED, ASSUMED_W
from lumped.schemas.reader import suggestion
from measured.case import Case, LowFidelity, Reference, Test
from measured.doubt import split_answers
from measured.recordings.formats import recording
from measured.recordings.readings import read_test, rows_of
from measured.recordings.sheet import Sheet, load_sheet
from measured.recordings.tables import Samples, load_table
from measured.sensors.sampling import SampleStep
from thermoscope.case_folder.doctor import examined
from thermoscope.case_folder.history import History, checked_values, load_history
from thermoscope.case_folder.quantities import with_quantities
from thermoscope.case_folder.recording_checks import Finding, Patient
from thermoscope.case_folder.settings import Entry, Settings, read_settings
from validation.effects import effect
from validation.parameters.unknowns import case_reference, matching, scene_of, standing, working
from validation.threads import counted

if TYPE_CHECKING:
    from geom import Machine
    from lumped.build.pipeline import Built
    from lumped.condensation.error_budget import ErrorBudget
    from thermoscope.case_folder.stored_comparison import StoredComparison
    from validation.comparison.compare import Comparison
    from validation.yardstick.yardstick import Yardstick

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Folder:
    """An open case.  positions : channel -> (x, y, z) m where the sheet gives them;  notes : doubts about the data

    findings : what looks wrong in the files, see `thermoscope test doctor`;  steps : test -> its sample step
    """

    settings: Settings
    case: Case
    history: History
    notes: tuple[str, ...]
    positions: dict[str, tuple[float, ...]]
    built: Built | None = None
    findings: tuple[Finding, ...] = ()
    steps: Mapping[str, SampleStep] = field(default_factory=dict)

    @property
    def small(self) -> Folder:
        """The same on the small network, where there is one; its error budget is that network's."""
        if self.built is None or self.built.small is None or self.case.small is self.case:
            return self
        return replace(self, case=self.case.small, built=replace(self.built, network=self.built.small))

    @cached_property
    def budgets(self) -> Mapping[str, ErrorBudget]:
        """Test -> what mesh, condensation and time steps may put wrong in the model's numbers; computed once."""
        from validation.comparison.error_budget import budgets_of

        return budgets_of(self, self.case.tests) if self.stored is None else self.stored.budgets

    @property
    def numeric_K(self) -> dict[str, dict[str, float]]:
        """Test -> channel -> the sum of its error budget (K)."""
        return {name: dict(budget.total_K) for name, budget in self.budgets.items()}

    @cached_property
    def stored(self) -> StoredComparison | None:
        """What an earlier command computed of this very model; None where none did."""
        from thermoscope.case_folder.stored_comparison import stored_comparison

        return stored_comparison(self)

    @cached_property
    def compared(self) -> Comparison:
        """The model against every test: the one comparison that tables, pictures and pages show; computed once."""
        from thermoscope.case_folder.stored_comparison import new_comparison

        return new_comparison(self) if self.stored is None else self.stored.comparison

    @cached_property
    def yardstick(self) -> Yardstick | None:
        """What plain models leave on these tests; None where the tests teach nothing."""
        from thermoscope.case_folder.stored_comparison import stored_yardstick

        return stored_yardstick(self.case)

    def limits(self, test: Test) -> dict[str, float]:
        """Channel -> the largest error that counts as agreement (K); of this test alone unless all are compared."""
        if "compared" in vars(self) or self.stored is not None:
            return self.compared.limits[test.name]
        from validation.comparison.compare import judged_error, physical
        from validation.comparison.error_budget import budgets_of

        case = self.case
        budget = self.budgets if "budgets" in vars(self) else budgets_of(self, [test])
        judged = judged_error(standing(case), test, physical(case), case.doubt, dict(budget[test.name].total_K))
        return {c.channel: c.limit_K for c in judged.channels if c.limit_K is not None}


def _once(settings: Settings, files: Mapping[str, Path]) -> None:
    """A recording is one test: the same twice would count double, or hold out what was fitted."""
    entries: dict[Path, Entry] = {}
    for entry in settings.tests:
        first = entries.setdefault(files[entry.name].resolve(), entry)
        if first is not entry:
            what = f"[tests.{first.name}] ({first.role}) and [tests.{entry.name}] ({entry.role}) are one recording"
            raise InputError(what, str(settings.path / "case.toml"), "another file for one of them")


def load_case(
    path: str | Path, progress: Progress = lambda message: None, bare: bool = False, untested: bool = False
) -> Folder:
    """Open a case. All files are read and checked before anything is computed.

    bare : skip model.toml;  untested : a model alone will do, to run it over a drive cycle
    """
    settings = read_settings(Path(path), untested)
    history = History() if bare else load_history(settings.model_file)
    patients: dict[str, Patient] = {}
    for number, entry in enumerate(settings.tests, 1):
        count = f" ({number} of {len(settings.tests)})"
        patients[entry.name] = patient_of(entry, lambda message, count=count: progress(message + count))  # type: ignore[misc]
    _once(settings, {name: one.samples.file for name, one in patients.items()})
    sheets = [one.sheet for one in patients.values()]
    percentages = list[str]()
    network, built = network_of(settings, progress, sheets, percentages.append)
    assumed = [*_assumed(network, settings), *percentages]
    read = [
        read_test(e.name, e.role, patients[e.name].samples, patients[e.name].sheet, network, settings.sample_s)
        for e in counted("preparing the tests", settings.tests, len(settings.tests))
    ]
    findings = examined(list(patients.values()), network)
    notes = tuple(dict.fromkeys([*assumed, *(note for one in read for note in one.notes)]))
    frees = {e.name: e.frees for e in settings.tests}
    channels = {r.test.name: tuple(replace(c, model_K=settings.model_K) for c in r.test.channels) for r in read}
    tests = tuple(replace(r.test, channels=channels[r.test.name], frees=frees[r.test.name]) for r in read)
    network = with_quantities(network, sheets, tests, history.reference)
    low = None
    if built and built.small:
        small = with_quantities(built.small, sheets, tests, history.reference)
        every = [(p.name, rows_of(p.sheet, p.samples, small)) for p in patients.values()]
        low = LowFidelity(network, small, {(test, name): row for test, rows in every for name, row in rows.items()})
    model, free = history.model(network, history.last), _free(network, settings)
    doubt, answers = split_answers(settings.doubt, history.last.answers)
    case = Case(settings.name, model, tests, free, doubt, answers, low, settings.odds)
    steps = {r.test.name: r.step for r in read}
    positions = {c.name: tuple(1e-3 * x for x in c.position_mm) for s in sheets for c in s.columns if c.position_mm}
    notes = (*notes, *_assumed_reference(case, settings), *_fitted_holdouts(case))
    return Folder(settings, _checked(case, history, settings), history, notes, positions, built, findings, steps)


READ = 32  # recordings that a process keeps: a command, or the demo, works on one case
# Cells of a recording that no process keeps (32 MB): a million rows would stay beside all that is made of them
LARGE = 2**22
_read: dict[tuple, Samples] = {}  # by sheet and files: nothing that is asked for has changed


def patient_of(entry: Entry, progress: Progress = lambda message: None) -> Patient:
    """A test as its files have it; a recording that has not changed is read once in a process."""
    sheet = load_sheet(entry.sheet)
    files = (recording(entry.file), *(recording(r.file) for r in sheet.recorders.values()))
    key = (pickle.dumps(sheet), *(_stamp(file) for file in files))
    if key not in _read:
        progress(f"reading {entry.name}")
        samples = load_table(entry.file, sheet)
        if samples.time.size * len(samples.values) > LARGE:
            return Patient(entry.name, sheet, samples)
        while len(_read) >= READ:
            _read.pop(next(iter(_read)))
        _read[key] = samples
    return Patient(entry.name, sheet, _read[key])


def _stamp(file: Path) -> tuple[str, int, int, int]:
    """What changes when a file is written: name, number on the disk, length, instant (ns)."""
    status = file.stat()
    return str(file.resolve()), status.st_ino, status.st_size, status.st_mtime_ns


def _assumed(network: Network, settings: Settings) -> list[str]:
    """A note on losses that nobody declared; InputError where measurements are to be held against them."""
    if all(source.name != ASSUMED for source in network.sources):
        return []
    what, right = "the machine declares no losses", "[losses.NAME] with kind, at and its numbers"
    if settings.tests:
        where = str(settings.machine)
        raise InputError(f"{what}: nothing says what heated it in the tests", where, right)
    return [f"{what}: {ASSUMED_W:g} W in its windings are assumed; {right}"]


def _assumed_reference(case: Case, settings: Settings) -> list[str]:
    """A note on a file that does not say what its exponents refer to."""
    if not case.model.values or case.model.reference is not None:
        return []
    levels = case_reference(case).levels
    words = ", ".join(f"{n} {u:.4g}" for n, u in levels.items() if any(v.endswith(f"^{n}") for v in case.model.values))
    return [
        f"{settings.model_file} does not say what its exponents and effects refer to, as files of before did not: "
        f"taken from the tests that are not held out{f' ({words})' if words else ''}; the next step writes it down"
    ]


def _fitted_holdouts(case: Case) -> list[str]:
    """A note on tests that are held out now, and that the model was fitted to."""
    fitted = case.model.reference.tests if case.model.values and case.model.reference else ()
    names = ", ".join(t.name for t in case.tests if t.role == "hold-out" and t.name in fitted)
    right = "calibrate from revision 0 again, or hold out another"
    return [f"{names}: held out, but the model was fitted to it, so its error says little; {right}"] if names else []


def find_case(name: str | Path, machines: Iterable[str] = ()) -> Path:
    """A case folder by its path or the name of a case that comes along.  machines : what may be meant as well"""
    path = Path(name)
    if path.is_dir():
        return path
    shipped = {p.parent.name: p.parent for home in _homes() for p in sorted(home.glob("*/case.toml"))}
    if str(name) in shipped:
        return shipped[str(name)]
    if path.exists():
        raise InputError("is a file", str(path), "a folder with a case.toml")
    beside = [str(p.parent) for p in path.parent.glob("*/case.toml")]
    near = [*beside, *shipped, *machines] or ["no case came along"]
    raise InputError("no such case folder", str(path), suggestion(str(path), near))


def _homes() -> list[Path]:
    """Where shipped cases lie: in the wheel inside this package, in a checkout beside it; the latter wins."""
    here = Path(__file__).resolve().parents[1]
    return [home for home in (here / "cases", here.parent / "cases") if home.is_dir()]


def _free(network: Network, settings: Settings) -> tuple[Parameter, ...]:
    """The parameters that calibration may move; a pattern that matches nothing is an error."""
    for pattern in settings.free:
        if not matching(network, [pattern]):
            where = f"{settings.path / 'case.toml'} [calibration] free"
            right = suggestion(pattern, [p.name for p in network.parameters])
            raise InputError(f"'{pattern}' matches no parameter", where, right)
    return matching(network, settings.free)


def network_of(
    settings: Settings, progress: Progress, sheets: Iterable[Sheet] = (), note: Progress = lambda words: None
) -> tuple[Network, Built | None]:
    """The network of a case, and how it was built where it comes from a machine.

    sheets : what says which inputs are recorded as shares;  note : told what was taken otherwise than it stands
    """
    if settings.network is not None:
        from lumped.declarations.network import load_network

        shares = {c.feeds for sheet in sheets for c in sheet.columns if c.quantity == "fraction"}
        return load_network(settings.network, shares, note), None
    from lumped.build.pipeline import build

    machine = load_machine_file(settings.machine)  # type: ignore[arg-type]
    built = build(machine, progress=progress, axial_m=settings.axial_m)
    return built.network, built


def load_machine_file(path: Path) -> Machine:
    """A machine by its file, or by the name of a machine that comes with the tool."""
    from geom import library, load_machine
    from lumped.machine.loss_sources import checked_losses

    if path.exists():
        machine = load_machine(path)
        try:
            checked_losses(machine)
        except InputError as fault:
            raise InputError(fault.what, f"{path}, {fault.where}", fault.right) from None
        return machine
    shipped = library()
    name = path.name.removesuffix(".toml")
    if name in shipped:
        return load_machine(name)
    right = suggestion(name, shipped, "a file, or one of the machines that come along")
    raise InputError("no such machine file", str(path), right)


def _checked(case: Case, history: History, settings: Settings) -> Case:
    """The model's effects can sit where model.toml has them, its values belong to parameters, as what tests free."""
    from validation.calibration.staged_fit import fit_stages

    where = f"{settings.model_file} revision {history.last.number}"
    try:
        scene = scene_of(case)
        reference = case.model.reference or Reference()
        tests = (*scene.tests, *history.last.rmse_K, *reference.tests)
        channels = (*scene.channels, *reference.errors)  # a model may speak of sensors and tests that have gone since
        scene = replace(scene, inputs=scene.inputs.union(reference.signals), channels=channels, tests=tests)
        for one in case.model.effects:
            effect(one.name, scene)
        network = standing(case)
    except InputError as fault:
        raise (
            fault if not case.model.effects else InputError(fault.what, f"{where}, {fault.where}", fault.right)
        ) from None
    checked_values(history.last, network.parameters, where)
    if any(test.frees for test in case.tests):
        fit_stages(case, case.tests, working(case)[1])
    return case
