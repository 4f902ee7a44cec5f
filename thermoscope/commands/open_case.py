"""Open the case a command is about."""

from __future__ import annotations

import shutil
from pathlib import Path

from geom.errors import InputError
from thermoscope.case_folder.folder import Folder, find_case, load_case
from thermoscope.case_folder.settings import read_settings
from thermoscope.console.terminal import Progress, notes

LOUD = 3  # findings that are said in full; doctor says all
PACKAGE = Path(__file__).resolve().parents[1]


def open_case(name: str, progress: Progress, untested: bool = False) -> Folder:
    """The case for reading; doubts about its data go to stderr. `untested`: one without tests will do."""
    folder = load_case(find_case(name), progress, untested=untested)
    notes([*folder.notes, *in_short(folder, name)])
    return folder


def needs_geometry(name: str) -> None:
    """Raises InputError, before anything is read or meshed, where a case has no machine to look at."""
    settings = read_settings(find_case(name))
    if settings.network is not None:
        right = f"a case with a machine; or: thermoscope show picture {settings.path} curves"
        raise InputError("has a network declared by hand, and so no geometry", settings.name, right)


def in_short(folder: Folder, name: str) -> list[str]:
    """The first things that look wrong in the files, what no law reads, and what says more."""
    unmentioned = [f for f in folder.findings if not any(f.what in note for note in folder.notes)]
    wrong = sorted(unmentioned, key=lambda f: f.remark)
    lines = [f"{', '.join(filter(None, (f.test, f.where)))}: {f.what}; {f.cure}" for f in wrong[:LOUD]]
    more = len(wrong) - LOUD
    return [*lines, *([f"{more} more such things: thermoscope test doctor {name}"] if more > 0 else [])]


def open_case_for_writing(name: str, progress: Progress, package: Path = PACKAGE) -> Folder:
    """The case for writing: one that lies inside the installed `package` is copied to the working folder first."""
    path = find_case(name)
    if package in path.resolve().parents:
        copy = Path(path.name)
        if copy.exists():
            raise InputError("is in the way of a copy of the shipped case", str(copy), "another working folder")
        load_case(path, progress)
        shutil.copytree(path, copy, ignore=shutil.ignore_patterns("out"))
        notes([f"copied the shipped case '{name}' to ./{copy}; from now on that folder is used"])
        path = copy
    if (out := path / "out").exists() and not out.is_dir():
        raise InputError("is not a folder", str(out), "a folder for results: move the file away")
    folder = load_case(path, progress)
    notes([*folder.notes, *in_short(folder, name)])
    return folder
