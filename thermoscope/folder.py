"""A case folder: case.toml, tests/NAME.csv with tests/NAME.toml, model.toml -> the case the rooms work on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from geom.errors import InputError
from geom.names import checked_name
from geom.toml_file import read_toml
from lumped.motor_losses import ASSUMED_W
from lumped.network import Network, Parameter
from lumped.reader import Table, known
from thermoscope.doctor import Finding, Patient, examined
from thermoscope.formats import stem_of
from thermoscope.history import History, checked_values, load_history
from thermoscope.quantities import with_quantities
from thermoscope.readings import read_test
from thermoscope.sheet import Sheet, load_sheet
from thermoscope.tables import load_table
from validation.case import AddedEffect, Case, Model, Role, Test
from validation.fitting import matching

if TYPE_CHECKING:
    from geom import Machine
    from thermoscope.pipeline import Built

Progress = Callable[[str], None]
ROLES = ("calibrate", "validate", "hold-out")


@dataclass(frozen=True)
class Entry:
    """A test as case.toml lists it.  frees : globs of the parameters it is to fix before the others are fitted"""

    name: str
    role: Role
    file: Path
    sheet: Path
    frees: tuple[str, ...] = ()


@dataclass(frozen=True)
class Settings:
    """case.toml.  machine or network is set, the other None;  free : globs of what calibration may move, () for all

    model_K : slow misfit (K) the model is not expected to get right, see validation.case.Channel
    axial_m : thickest layer of the mesh along the axis (m), for long stacks; None: the usual one
    """

    path: Path
    name: str
    description: str
    machine: Path | None
    network: Path | None
    sample_s: float
    model_K: float
    tests: tuple[Entry, ...]
    free: tuple[str, ...] = ()
    axial_m: float | None = None

    @property
    def out(self) -> Path:
        return self.path / "out"

    @property
    def model_file(self) -> Path:
        return self.path / "model.toml"


@dataclass(frozen=True)
class Folder:
    """An open case.  positions : channel -> (x, y, z) m where the sheet gives them;  notes : doubts about the data

    findings : what looks wrong in the files, see `thermoscope doctor`
    """

    settings: Settings
    case: Case
    history: History
    notes: tuple[str, ...]
    positions: dict[str, tuple[float, ...]]
    built: Built | None = None
    findings: tuple[Finding, ...] = ()


def read_settings(path: Path, untested: bool = False) -> Settings:
    """What case.toml says; `untested` allows it to name no tests."""
    file = path / "case.toml"
    if path.is_file():
        raise InputError("is a file", str(path), "a folder with a case.toml")
    top = Table(read_toml(file, "a case folder with a case.toml"), str(file))
    head, tests, calibration = top.table("case"), top.tables("tests"), top.table("calibration")
    top.close()
    name, description = head.word("name", path.name), head.word("description", "")
    machine, network = (path / head.word(key) if key in head else None for key in ("machine", "network"))
    if (machine is None) == (network is None):
        raise head.error(
            "neither or both of machine and network given", 'machine = "NAME.toml" or network = "network.toml"'
        )
    sample, free = head.number("sample_s", 10.0), calibration.words("free", [])
    model_K = head.number("model_error_K", 0.0)
    axial_m = head.number("axial_mm") / 1e3 if "axial_mm" in head else None
    head.close()
    calibration.close()
    if not tests and not untested:
        raise InputError("no tests", str(file), '[tests.NAME] with role = "calibrate"')
    entries = tuple(_entry(path, n, t) for n, t in tests.items())
    return Settings(
        path, name, description, machine, network, sample, model_K, entries, free,
        axial_m,
    )  # fmt: skip


def _once(settings: Settings, files: Mapping[str, Path]) -> None:
    """A recording is one test: the same twice would count double, or hold out what was fitted."""
    seen: dict[Path, Entry] = {}
    for entry in settings.tests:
        first = seen.setdefault(files[entry.name].resolve(), entry)
        if first is not entry:
            what = f"[tests.{first.name}] ({first.role}) and [tests.{entry.name}] ({entry.role}) are one recording"
            raise InputError(what, str(settings.path / "case.toml"), "another file for one of them")


def _entry(path: Path, name: str, table: Table) -> Entry:
    file = path / table.word("file", f"tests/{checked_name(name, table.where)}")
    role, beside = table.word("role", None, ROLES), file.with_name(f"{stem_of(file)}.toml")
    sheet, frees = path / table.word("sheet") if "sheet" in table else beside, table.words("frees", [])
    if frees and role != "calibrate":
        raise table.error(f"frees parameters though its role is {role}", 'role = "calibrate"')
    table.close()
    return Entry(name, role, file, sheet, tuple(frees))  # type: ignore[arg-type]


def load_case(
    path: str | Path, progress: Progress = lambda message: None, bare: bool = False, untested: bool = False
) -> Folder:
    """Open a case. All files are read and checked before anything is computed.

    bare : skip model.toml;  untested : a model alone will do, to run it over a drive cycle
    """
    settings = read_settings(Path(path), untested)
    history = History() if bare else load_history(settings.model_file)
    patients: dict[str, Patient] = {}
    for entry in settings.tests:
        progress(f"reading {entry.name}")
        patients[entry.name] = patient_of(entry)
    _once(settings, {name: one.samples.file for name, one in patients.items()})
    network, built = network_of(settings, progress)
    read = [
        read_test(e.name, e.role, patients[e.name].samples, patients[e.name].sheet, network, settings.sample_s)
        for e in settings.tests
    ]
    findings = examined(list(patients.values()), network)
    notes = tuple(dict.fromkeys([*_assumed(built), *(note for _, doubts in read for note in doubts)]))
    frees = {e.name: e.frees for e in settings.tests}
    tests = tuple(replace(_allowing(test, settings.model_K), frees=frees[test.name]) for test, _ in read)
    sheets = [one.sheet for one in patients.values()]
    network = with_quantities(network, sheets, tests)
    case = Case(settings.name, _model(network, history), tests, _free(network, settings))
    return Folder(settings, _checked(case, history), history, notes, _positions(sheets), built, findings)


def patient_of(entry: Entry) -> Patient:
    """A test as its files have it."""
    sheet = load_sheet(entry.sheet)
    return Patient(entry.name, sheet, load_table(entry.file, sheet))


def _assumed(built: Built | None) -> list[str]:
    """Losses that nobody declared."""
    if built is None or built.machine.sections.get("losses"):
        return []
    return [f"{built.machine.name} declares no losses: {ASSUMED_W:g} W in its windings are assumed ([losses.NAME])"]


def _allowing(test: Test, model_K: float) -> Test:
    """The test with the model's own expected error on every channel."""
    return replace(test, channels=tuple(replace(c, model_K=model_K) for c in test.channels))


def _positions(sheets: Iterable[Sheet]) -> dict[str, tuple[float, ...]]:
    columns = [c for sheet in sheets for c in sheet.columns if c.position_mm]
    return {c.name: tuple(1e-3 * x for x in c.position_mm) for c in columns}


def find_case(name: str | Path) -> Path:
    """A case folder by its path, or by the name of a case that comes with the tool."""
    path = Path(name)
    if path.is_dir():
        return path
    shipped = {p.parent.name: p.parent for home in _homes() for p in sorted(home.glob("*/case.toml"))}
    if str(name) in shipped:
        return shipped[str(name)]
    if path.exists():
        raise InputError("is a file", str(path), "a folder with a case.toml")
    raise InputError("no such case folder", str(path), known(str(name), shipped or ["no case came along"]))


def _homes() -> list[Path]:
    """Where shipped cases lie: in the wheel inside this package, in a checkout beside it; the latter wins."""
    here = Path(__file__).resolve().parent
    return [home for home in (here / "cases", here.parent / "cases") if home.is_dir()]


def _free(network: Network, settings: Settings) -> tuple[Parameter, ...]:
    """The parameters that calibration may move; a pattern that matches nothing is an error."""
    for pattern in settings.free:
        if not matching(network, [pattern]):
            right = known(pattern, [p.name for p in network.parameters])
            raise InputError(
                f"'{pattern}' matches no parameter", f"{settings.path / 'case.toml'} [calibration] free", right
            )
    return matching(network, settings.free)


def network_of(settings: Settings, progress: Progress) -> tuple[Network, Built | None]:
    """The network of a case, and how it was built where it comes from a machine."""
    if settings.network is not None:
        from lumped.declared import load_network

        return load_network(settings.network), None
    from thermoscope.pipeline import build

    machine = load_machine_file(settings.machine)  # type: ignore[arg-type]
    built = build(machine, progress=progress, axial_m=settings.axial_m)
    return built.network, built


def load_machine_file(path: Path) -> Machine:
    """A machine by its file, or by the name of a machine that comes with the tool."""
    from geom import library, load_machine

    if path.exists():
        return load_machine(path)
    shipped = library()
    name = path.name.removesuffix(".toml")
    if name in shipped:
        return load_machine(name)
    raise InputError(
        "no such machine file", str(path), f"a file, or one of the machines that come along: {', '.join(shipped)}"
    )


def _model(network: Network, history: History) -> Model:
    last = history.last
    effects = tuple(AddedEffect(*name.partition("@")[::2]) for name in last.effects)
    return Model(network, effects, dict(last.values), last.number)


def _checked(case: Case, history: History) -> Case:
    """The model's effects can sit where model.toml has them, and its values belong to parameters."""
    from validation.effects import effect
    from validation.fitting import scene_of, working

    for one in case.model.effects:
        effect(one.name, scene_of(case))
    checked_values(history.last, working(case)[0].parameters, "model.toml")
    return case
