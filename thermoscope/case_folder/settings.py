"""case.toml: which model, which tests in which role, and how the commands go about them."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path

from geom.description.names import LONGEST, checked_name
from geom.description.toml_file import read_toml
from geom.errors import InputError
from lumped.schemas.reader import Table, excerpt, suggestion
from measured.case import Role
from measured.doubt import USUAL, Doubt, Odds, widened
from measured.recordings.formats import stem_of

ROLES = ("calibrate", "validate", "hold-out")
MOST_ODDS = 100.0  # to one: nobody is surer of an effect that was not measured; to leave one out is another question


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

    model_K : slow misfit (K) the model is not expected to get right, see measured.case.Channel
    sample_s : coarsest step (s) at which tests are looked at; None: as coarse as their sensors do not feel
    axial_m : thickest layer of the mesh along the axis (m), for long stacks; None: the usual one
    kinds : of effects that a diagnosis looks for, None for all;  starts, seed : of a calibration, see Search
    doubt : the table of doubt with the lines that the case widens
    odds : kind, "kind@place" or "sensors" -> what the odds of these effects are multiplied by, and why
    guesses : what `test new` could not tell of the recordings
    """

    path: Path
    name: str
    description: str
    machine: Path | None
    network: Path | None
    sample_s: float | None
    model_K: float
    tests: tuple[Entry, ...]
    free: tuple[str, ...] = ()
    axial_m: float | None = None
    kinds: tuple[str, ...] | None = None
    starts: int = 1
    seed: int = 0
    doubt: Doubt = field(default_factory=lambda: USUAL)
    odds: Mapping[str, Odds] = field(default_factory=dict)
    guesses: str = ""

    @property
    def out(self) -> Path:
        return self.path / "out"

    @property
    def model_file(self) -> Path:
        return self.path / "model.toml"


def read_settings(path: Path, untested: bool = False) -> Settings:
    """What case.toml says; `untested` allows it to name no tests."""
    file = path / "case.toml"
    if path.is_file():
        raise InputError("is a file", str(path), "a folder with a case.toml")
    top = Table(read_toml(file, "a case folder with a case.toml"), str(file))
    head, tests, calibration = top.table("case"), top.tables("tests"), top.table("calibration")
    diagnosis, doubt = top.table("diagnosis"), top.table("doubt").constants("doubt")
    odds = {effect: _odds(table) for effect, table in top.tables("odds").items()}
    top.close()
    name, description = _title(head, path.name), head.word("description", "")
    machine, network = (path / head.word(key) if key in head else None for key in ("machine", "network"))
    if (machine is None) == (network is None):
        raise head.error(
            "neither or both of machine and network given", 'machine = "NAME.toml" or network = "network.toml"'
        )
    sample, free = head.number("sample_s") if "sample_s" in head else None, _all_or(calibration, "free")
    model_K = head.number("model_error_K", 0.0)
    axial_m = head.number("axial_mm") / 1e3 if "axial_mm" in head else None
    if axial_m is not None and machine is None:
        raise head.error("axial_mm is of a machine's mesh, and this case has a network", "no axial_mm")
    guesses = head.word("guesses", "")
    starts, seed = int(calibration.number("starts", 1)), int(calibration.number("seed", 0))
    kinds = _kinds(diagnosis)
    for table in (head, calibration, diagnosis):
        table.close()
    if not tests and not untested:
        raise InputError("no tests", str(file), '[tests.NAME] with role = "calibrate"')
    entries = tuple(_entry(path, n, t) for n, t in tests.items())
    of_case = (path, name, description, machine, network, sample, model_K, entries)
    return Settings(*of_case, free, axial_m, kinds, starts, seed, widened(doubt, f"{file} [doubt]"), odds, guesses)


def _title(head: Table, usual: str) -> str:
    """The name of the case: one short line."""
    name = head.word("name", usual)
    if not 0 < len(name.strip()) <= LONGEST or not name.isprintable():
        raise head.error(f"name = {excerpt(name)} is not possible", f"one line of 1 to {LONGEST} letters")
    return name


def _all_or(table: Table, key: str) -> tuple[str, ...]:
    """Globs; () where the file has none, which means all."""
    return table.members(key) if key in table else ()


def _odds(table: Table) -> Odds:
    """What the odds of an effect are multiplied by in this case, and why."""
    odds = Odds(table.number("factor", low=1.0 / MOST_ODDS, high=MOST_ODDS), table.word("reason").strip())
    if not odds.reason:
        raise table.error("reason is empty", 'reason = "the flange is inside a box"')
    table.close()
    return odds


def _kinds(table: Table) -> tuple[str, ...] | None:
    """The kinds of effects that the globs of `catalogue` mean; a glob that means none is an error."""
    if "catalogue" not in table:
        return None
    from validation.effects import kinds

    matches: dict[str, None] = {}
    for glob in table.members("catalogue"):
        matched = [kind for kind in kinds() if fnmatchcase(kind, glob)]
        if not matched:
            raise table.error(f"catalogue: '{glob}' is not a kind of effect", suggestion(glob, kinds()))
        matches |= dict.fromkeys(matched)
    return tuple(matches)


def _entry(path: Path, name: str, table: Table) -> Entry:
    file = path / table.word("file", f"tests/{checked_name(name, table.where)}")
    role, beside = table.word("role", None, ROLES), file.with_name(f"{stem_of(file)}.toml")
    sheet, frees = path / table.word("sheet") if "sheet" in table else beside, _all_or(table, "frees")
    if frees and role != "calibrate":
        raise table.error(f"frees parameters though its role is {role}", 'role = "calibrate"')
    table.close()
    return Entry(name, role, file, sheet, frees)  # type: ignore[arg-type]
