"""thermoscope test new FILE... [--machine M | --network N] [--yes]"""

import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from geom.errors import InputError
from geom.escapes import toml_value
from geom.storage import write_whole
from geom.table import Table
from geom.text import counted
from lumped.model.quantities import INPUTS, USUAL
from lumped.model.sites import ASSUMED
from lumped.schemas.reader import suggestion
from measured.case import Case, Model as CaseModel
from measured.importing.aligned import Recording, common, grouped, longest_part, shift
from measured.importing.aloud import first_lines, short_lines
from measured.importing.case_files import check_new_folder, folder_whole, read_runs, set_aside, write_case
from measured.importing.clock import Clock
from measured.importing.dialogue import Dialogue
from measured.importing.draft import ASSUMED_ROOM, Draft, test_name
from measured.importing.guess import Guess, assigned, guesses
from measured.importing.source import Source, signature
from measured.importing.starter import FirstNetwork, of_machine, place_of, starter
from measured.importing.target import Target, measure_of, target_of
from measured.recordings.invalid_readings import coded
from thermoscope.console.options import Json, read_pairs
from thermoscope.console.summary import Summary, sentences
from thermoscope.console.terminal import Progress, give, notes, progress
from thermoscope.parts import message as missing_extra

if TYPE_CHECKING:
    from lumped.model.network import Network
    from thermoscope.case_folder.settings import Settings
    from viz.figures.curves import Panel

PICTURE = "columns.png"
LATEST_S = 1e9  # as [test] from_s in a sheet


@dataclass(frozen=True)
class Wishes:
    """The options of the command.  constants : NAME=VALUE of what was not recorded;  period_s : between rows

    window_s : the part of each recording that is the test;  places : COLUMN=PLACE of what is not to be guessed
    """

    machine: str | None = None
    network: Path | None = None
    out: Path | None = None
    yes: bool = False
    constants: Mapping[str, float] | None = None
    period_s: float | None = None
    window_s: tuple[float, float | None] = (0.0, None)
    places: Mapping[str, str] | None = None


@dataclass(frozen=True)
class Model:
    """What the tests are held against.  put : copies it into a case and returns its line of case.toml

    first : where nobody gave one
    """

    network: "Network"
    target: Target
    put: Callable[[Path], str]
    first: FirstNetwork | None = None


def new(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="CSV, text, xlsx, MAT, TDMS, MF4, Parquet.")],
    machine: Annotated[str | None, typer.Option(metavar="M", help="Hold them against this machine.")] = None,
    network: Annotated[Path | None, typer.Option(metavar="N", help="Or against this network.toml.")] = None,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="The new case; else the file's name.")
    ] = None,
    yes: Annotated[bool, typer.Option("--yes", help="Ask nothing: take the guesses.")] = False,
    constants: Annotated[
        list[str] | None, typer.Option("--set", metavar="NAME=VALUE", help="What was not recorded: ambient=21.5.")
    ] = None,
    place: Annotated[
        list[str] | None,
        typer.Option(metavar="COLUMN=PLACE", help="Where a column belongs: a place, an input, nothing."),
    ] = None,
    period: Annotated[
        float | None, typer.Option(min=1e-6, max=1e7, help="Seconds between rows without a clock.")
    ] = None,
    start: Annotated[
        float, typer.Option("--from", min=0.0, max=LATEST_S, help="The tests begin here (s from the first row).")
    ] = 0.0,
    end: Annotated[float | None, typer.Option("--to", min=0.0, max=LATEST_S, help="And end here.")] = None,
    target: Json = None,
) -> int:
    """A case from your own recordings: guesses each column, asks what it cannot know. Same columns: one test a file."""
    window_s, values = (start, end), read_pairs(constants or (), "--set", "NAME=VALUE", "such as ambient=21.5")
    return new_case(files, Wishes(machine, network, out, yes, values, period, window_s, places(place or ())), target)


def new_case(files: Sequence[Path], wishes: Wishes, target: str | None) -> int:
    """A case from recordings; nothing is written where anything is wrong."""
    if wishes.machine and wishes.network:
        raise InputError("a machine and a network are both given", "--machine, --network", "one of the two")
    folder, (start, end) = wishes.out or Path(test_name(files[0], [])), wishes.window_s
    if end is not None and end <= start:
        raise InputError(f"{start:g} is not before {end:g}", "--from, --to", "--from below --to")
    check_new_folder(folder)  # before minutes of reading
    with progress() as tell:
        read = read_runs(*files, period_s=wishes.period_s, tell=tell)
        model = _model(wishes, read, tell)
    drafts = _drafts(read, model, wishes)
    read.clear()
    with progress() as tell:
        document = save_case(folder, model, drafts, tell)
    give(document, target, lambda: new_case_summary(document))
    return 0


def places(words: Sequence[str]) -> dict[str, str]:
    """COLUMN=PLACE of --place; a place has no equals sign in it."""
    for word in words:
        if "=" not in word:
            right = "such as T_Wickl_U=winding; PLACE may be an input"
            raise InputError(f"'{word}' is not of the form COLUMN=PLACE", "--place", right)
    return {column.strip(): place.strip() for column, _, place in (word.rpartition("=") for word in words)}


def model_of_case(settings: "Settings", network: "Network") -> Model:
    """The machine or the network of a case that is there, for another one."""
    if settings.network is not None:
        return Model(network, target_of(network), _copied("network", settings.network, "network.toml"))
    assert settings.machine is not None, "a case has a machine or a network"
    return Model(network, target_of(network), _put_machine(settings.machine))


def _put_machine(machine: Path) -> Callable[[Path], str]:
    """Copies the file of a machine into a case; one that comes along, or that is no TOML file, is only named there."""
    if machine.exists() and machine.suffix == ".toml":
        return _copied("machine", machine, "machine.toml")
    name = str(machine.resolve()) if machine.exists() else machine.name.removesuffix(".toml")
    return lambda folder: f"machine = {toml_value(name)}"


def _model(wishes: Wishes, read: Sequence[tuple[Source, Clock]], tell: Progress) -> Model:
    """The model that was asked for, or a first one made from the columns."""
    if wishes.network:
        from lumped.declarations.network import load_network

        network = load_network(wishes.network)
        return Model(network, target_of(network), _copied("network", wishes.network, "network.toml"))
    return _machine(wishes.machine, tell) if wishes.machine else first_model(read, wishes.places or {})


def _machine(machine: str, tell: Progress) -> Model:
    from lumped.build.pipeline import build
    from thermoscope.case_folder.folder import load_machine_file

    network = build(load_machine_file(Path(machine)), progress=tell).network
    if any(source.name == ASSUMED for source in network.sources):
        what = "declares no losses: nothing says what heated it in the tests"
        raise InputError(what, machine, "[losses.NAME] with kind, at and its numbers")
    return Model(network, target_of(network), _put_machine(Path(machine)))


def _copied(kind: str, path: Path, name: str) -> Callable[[Path], str]:
    def put(folder: Path) -> str:
        write_whole(folder / name, path.read_bytes())
        return f"{kind} = {toml_value(name)}"

    return put


def first_model(read: Sequence[tuple[Source, Clock]], fixed_places: Mapping[str, str]) -> Model:
    """A network made from the columns of recordings.  said : column -> place that is not to be guessed"""
    from lumped.declarations.network import read_network

    columns = [
        (source, g if (place := fixed_places.get(g.column)) is None else _at_place(source, g, place))
        for source, clock in read
        for g in guesses(source, clock.columns, Target())
    ]
    first = starter(machine := of_machine(columns), test_name(read[0][0].file, []), read[0][1].end_s)
    network = read_network(tomllib.loads(first.text()), "network.toml")

    def put(folder: Path) -> str:
        write_whole(folder / "network.toml", first.text())
        return 'network = "network.toml"'

    places = {s.labels[g.column]: place for s, g in machine if (place := place_of(g, s.labels[g.column]))}
    inputs = {g.column: g.feeds for _, g in machine if g.feeds in network.inputs}
    return Model(network, replace(target_of(network), places_by_header=places, inputs_by_column=inputs), put, first)


def _at_place(source: Source, g: Guess, place: str) -> Guess:
    """A column of a first network at the place that --place says; an input keeps what was guessed of it."""
    if place == g.feeds or not source.is_numeric(g.column):
        return g
    is_input = place in {*INPUTS, *USUAL} or (g.quantity != "temperature" and measure_of(place))
    free, part = replace(g, quantity="", feeds=""), place and not is_input
    return assigned([free], source, g.column, place, Target({place: None} if part else {}))[0]


def _drafts(read: Sequence[tuple[Source, Clock]], model: Model, wishes: Wishes) -> list[Draft]:
    """Files into tests, columns into places; what is missing is asked for once."""
    dialogue = Dialogue(model.target, not wishes.yes, dict(wishes.constants or {}))
    columns = {c for source, _ in read for c in source.cells}
    for column in wishes.places or {}:
        if column not in columns:
            raise InputError(f"no column '{column}'", "--place", suggestion(column, sorted(columns)))
    records, unused, kinds = [], list[str](), [signature(source) for source, _ in read]
    for source, clock in read:
        guessed_columns = guesses(source, clock.columns, model.target)
        for column, place in (wishes.places or {}).items():
            guessed_columns = assigned(guessed_columns, source, column, place, model.target)
        try:
            records.append(Recording(source, clock, dialogue.answered(source, guessed_columns)))
        except InputError as fault:  # a recorder of something else, beside others
            if kinds.count(signature(source)) > 1 or (not records and source is read[-1][0]):
                raise
            unused.append(f"{source.file.name} is left out: {fault.what}")
    first, *others = drafts_of(records, dialogue, wishes.window_s)
    return [replace(first, notes=(*first.notes, *unused)), *others]


def drafts_of(
    records: Sequence[Recording], dialogue: Dialogue, window_s: tuple[float, float | None] = (0.0, None)
) -> list[Draft]:
    """A test from each group of recordings that ran together; their clocks are aligned."""
    out: list[Draft] = []
    for first, *others in grouped(list(records), [signature(r.source) for r in records]):
        one = len(others) > 1 and all(np.array_equal(r.clock.seconds, first.clock.seconds) for r in others)
        shifts = [(0.0, "all clocks are alike") if one else shift(first, r) for r in others]  # of one program's files
        rest = [replace(r, shift_s=s, how=how) for r, (s, how) in zip(others, shifts, strict=True)]
        needed = [g.column for g in first.guesses if g.feeds or g.place in dialogue.target.boundaries]
        whole, cut = longest_part(first, first.gap_s, needed) if window_s == (0.0, None) else (window_s, ())
        part, note = common((first, *rest), whole)
        name = test_name(first.source.file, [d.name for d in out])
        clocks = [f"{r.name}: {r.clock.doubt}" for r in (first, *rest) if r.clock.doubt]
        draft = Draft(name, _fed_once((first, *rest), dialogue.target), window_s=part, notes=(*cut, *note, *clocks))
        out.append(dialogue.completed(draft))
    return out


def _fed_once(records: Sequence[Recording], target: Target) -> tuple[Recording, ...]:
    """With inputs and boundaries that several recorders of a test give from the first of them."""
    owner: dict[str, str] = {}
    out = []
    for record in records:
        keys = [g.feeds or g.place * (g.place in target.boundaries) for g in record.guesses]
        every = [g.without(f"{owner[k]} gives {k} already") if k in owner else g for g, k in zip(record.guesses, keys)]
        owner |= {k: f"'{g.column}' of {record.name}" for g, k in zip(every, keys) if k and g.used}
        out.append(replace(record, guesses=every))
    return tuple(out)


def save_case(folder: Path, model: Model, drafts: list[Draft], tell: Progress) -> dict[str, Any]:
    """Write the case, draw its columns, read it as compare would; the document of the command.

    drafts : is empty afterwards: a large recording need not be there twice
    """
    from measured.recordings.readings import read_test
    from thermoscope.case_folder.doctor import examined
    from thermoscope.case_folder.folder import patient_of
    from thermoscope.case_folder.quantities import with_quantities
    from thermoscope.case_folder.settings import read_settings
    from validation.yardstick.first_network import learn_network

    with folder_whole(folder) as partial:
        tell("writing the case")
        warnings = first_lines(drafts)
        doubts = sentences(short_lines(drafts, bool(model.first)))
        write_case(partial, folder.name, model.put, drafts, " ".join(doubts), model.first is not None)
        settings = read_settings(partial)
        tell("drawing the columns")
        _draw(drafts[0], partial / "out" / PICTURE)
        documents = [_document(d, e.role) for d, e in zip(drafts, settings.tests, strict=True)]
        drafts.clear()
        with _as_recorded(partial, documents):
            patients = [patient_of(entry) for entry in settings.tests]
            tests = [
                read_test(entry.name, entry.role, one.samples, one.sheet, model.network, settings.sample_s).test
                for entry, one in zip(settings.tests, patients, strict=True)
            ]
        findings = [f for f in examined(patients, model.network) if not f.remark]
        if model.first:
            tell("learning a first network")
            network = with_quantities(model.network, [one.sheet for one in patients], tests)
            first = learn_network(Case(folder.name, CaseModel(network), tuple(tests)), model.first)
            model = replace(model, first=first)
            write_whole(partial / "network.toml", first.text())
            if odd := _odd_tests(documents, first.learnt):
                set_aside(partial, [d["name"] for d in odd])
            for d in odd:
                d["role"] = "validate"
    return {
        "case": folder.name,
        "folder": str(folder),
        "invented_network": model.first is not None,
        "learnt_from": list(first.learnt) if model.first else [],
        "warnings": warnings,
        "sample_s": settings.sample_s,
        "findings": [f.document() for f in findings],
        "tests": documents,
    }


def _draw(draft: Draft, png: Path) -> None:
    """The columns as a picture, a note where nothing can draw."""
    try:
        from viz.figures.curves import columns

        columns(panels(draft), f"{draft.name}: what each column was taken for", png=png)
    except ModuleNotFoundError as fault:
        notes([f"no picture of the columns: {missing_extra(fault) or fault}"])


@contextmanager
def _as_recorded(folder: Path, tests: Sequence[Mapping[str, Any]]) -> Iterator[None]:
    """What is wrong with a test that was to be written is said of the recording it comes from."""
    try:
        yield
    except InputError as fault:
        where = fault.where
        for test in tests:
            files = ", ".join(file["file"] for file in test["files"])
            for name in (f"{test['name']}.csv", f"{test['name']}.toml"):
                where = where.replace(str(folder / "tests" / name), files)
        right = f"{fault.right}; or a part of it by --from and --to, other values by --set; nothing was written"
        raise InputError(fault.what, where.replace(str(folder), "the new case"), right) from None


def _document(draft: Draft, role: str) -> dict[str, Any]:
    files = [
        {
            "file": str(r.source.file),
            "clock": r.clock.words,
            "rows": int(np.isfinite(r.clock.seconds).sum()),
            "shift_s": r.shift_s,
            "aligned_by": r.how,
            "notes": list(r.source.notes),
        }
        for r in draft.records
    ]
    return {
        "name": draft.name,
        "role": role,
        "duration_s": draft.span_s,
        "files": files,
        "notes": list(draft.notes),
        "columns": [vars(g) for g in draft.guesses],
        "inputs": dict(draft.constants),
        "boundaries": dict(draft.boundaries),
        "squares": dict(draft.squares),
    }


def panels(draft: Draft) -> "list[Panel]":
    """The columns of numbers of a test as the picture wants them."""
    from viz.figures.curves import POINTS, Panel

    out = []
    for r in draft.records:
        rows = np.arange(0, r.source.rows, max(1, r.source.rows // POINTS))
        time = r.clock.seconds[rows] + r.shift_s
        for g in (g for g in r.guesses if r.source.is_numeric(g.column)):
            values = np.where(coded(values := r.source.numbers(g.column)), np.nan, values)[rows]
            out.append(Panel(g.column, time, values, meaning(g), bool(g.place)))
    return out


def meaning(g: Guess) -> str:
    """Where a column goes, with its unit; "" where it is left out."""
    return f"{g.place or g.feeds} ({g.unit})" if g.used else ""


def new_case_summary(document: Mapping[str, Any]) -> Summary:
    """What became of each column of the first test, what was assumed, and the next command."""
    tests, folder = document["tests"], document["folder"]
    columns = sorted(tests[0]["columns"], key=lambda c: (not _goes(c), not c["doubt"]))
    count = sum(bool(_goes(c)) for c in columns)
    sentence = (
        f"{folder}: {counted(len(tests), 'test')}, {count} of {len(columns)} columns "
        "used. All of this is guessed: change it in tests/*.toml."
    )
    sentence = "\n".join(filter(None, [" ".join(sentences(document["warnings"])), sentence]))
    table = Table.of(
        "", columns, "column | *goes to=place | *unit | quantity | *doubt", place=lambda c: _goes(c) or "left out"
    )
    table = replace(table, folded="doubt")
    parts: list[Table | str] = [*_moved(tests), *_remarks(document), table, _files(tests)]
    return Summary(sentence, parts, f"picture: {folder}/out/{PICTURE}; next: thermoscope test compare {folder}")


def _goes(column: Mapping[str, Any]) -> str:
    return str(column["place"] or column["feeds"])


def _files(tests: Sequence[Mapping[str, Any]]) -> Table:
    return Table.of(
        "Files",
        [{**t, **f} for t in tests for f in t["files"]],
        "file | role | seconds=duration_s | rows | clock",
        file=lambda f: Path(f["file"]).name,
        duration_s=lambda f: round(f["duration_s"]) if f["duration_s"] >= 100 else f["duration_s"],
    )


def _moved(tests: Sequence[Mapping[str, Any]]) -> list[str]:
    return [
        f"{Path(f['file']).name} moved by {f['shift_s']:+.6g} s: {f['aligned_by']}."
        for t in tests
        for f in t["files"]
        if f["aligned_by"]
    ]


def _odd_tests(tests: Sequence[dict[str, Any]], learnt: Sequence[str]) -> list[dict[str, Any]]:
    """Tests that may be fitted and taught the first network nothing; none where it was not learnt."""
    return [t for t in tests if learnt and t["role"] != "hold-out" and t["name"] not in learnt]


def _remarks(document: Mapping[str, Any]) -> list[str]:
    """What was assumed, and what looks wrong."""
    tests = document["tests"]
    remarks = [note for t in tests for note in (*t["notes"], *(m for f in t["files"] for m in f["notes"]))]
    if document["learnt_from"]:
        remarks.append(
            "no machine and no network was given: network.toml holds the fewest links and losses that predict what was "
            "left out; how large they are together is assumed"
        )
        if odd := _odd_tests(tests, document["learnt_from"]):
            names = ", ".join(t["name"] for t in odd)
            remarks.append(
                f"not learnt from {names}: without that the others predict each other far better. It is not "
                "fitted, effects are chosen with it"
            )
    elif document["invented_network"]:
        remarks.append(
            "no machine and no network was given: network.toml is made from the columns, its numbers are "
            "orders of magnitude"
        )
    if document["findings"]:
        count = len(document["findings"])
        things = "thing looks" if count == 1 else "things look"
        remarks.append(f"{count} {things} wrong: thermoscope test doctor {document['folder']}")
    files = [Path(f["file"]).name for t in tests for f in t["files"]]
    alike: dict[str, list[str]] = {}
    for note in dict.fromkeys(
        n for n in remarks if ASSUMED_ROOM not in n and not any(w in n for w in document["warnings"])
    ):
        of = next((file for file in files if note.startswith(f"{file}: ")), "")
        alike.setdefault(re.sub(r"[\d.]+", "", note.removeprefix(f"{of}: ")), []).append(note)
    more = {what: f"; {len(notes)} tests alike" if len(notes) > 1 else "" for what, notes in alike.items()}
    return [f"Note: {notes[0]}{more[what]}." for what, notes in alike.items()]
