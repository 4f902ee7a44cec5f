"""Accepted events as columns beside the test they held in: tests/NAME.derived.csv, never the recording itself.

The file follows the model: it is written anew after every step, and goes when no effect of the model holds for a while.
"""

import csv
from collections.abc import Sequence
from pathlib import Path

from geom.errors import InputError
from geom.escapes import csv_lines
from geom.storage import write_whole
from measured.recordings.formats import stem_of
from thermoscope.case_folder.folder import Folder
from thermoscope.case_folder.settings import Entry
from validation.effects import effect
from validation.effects.during import During
from validation.effects.time_window import event, holds

TIME = "time_s"


def write_columns(folder: Folder, effects: Sequence[str]) -> list[Path]:
    """A column of 0 to 1 for each event of some effects, beside each test it held in."""
    conditions = [one.condition for name in effects if isinstance(one := effect(name), During) and one.event]
    tests, paths = {t.name: t for t in folder.case.tests}, []
    for entry in folder.settings.tests:
        file, test = _file(entry), tests[entry.name]
        test_conditions = [
            condition
            for condition in dict.fromkeys(conditions)
            if (condition_event := event(condition)) and test.name in condition_event.spans
        ]
        ours(file)
        if test_conditions:
            columns = [test.time, *(holds(condition, test) for condition in test_conditions)]
            rows = ([f"{x:.10g}" for x in row] for row in zip(*columns, strict=True))
            paths.append(write_whole(file, csv_lines([[TIME, *test_conditions], *rows])))
        elif file.exists():
            file.unlink()
    return paths


def checked_columns(folder: Folder) -> None:
    """InputError where one of these files would go over something else: to be asked before a step is written."""
    for entry in folder.settings.tests:
        ours(_file(entry))


def _file(entry: Entry) -> Path:
    return entry.file.with_name(f"{stem_of(entry.file)}.derived.csv")


def ours(file: Path) -> None:
    """A file of that name is one of these, or it stays."""
    if not file.exists():
        return
    if not file.is_file():
        raise InputError("is not a file", str(file), "another name for it")
    with file.open(encoding="utf-8", errors="replace", newline="") as lines:
        header = next(csv.reader(lines), [])
    if header[:1] != [TIME] or not all(event(name) for name in header[1:]):
        raise InputError("is there already and is not a column of an event: it stays", str(file), "another name for it")
