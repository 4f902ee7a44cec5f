"""Open the case a command is about."""

from __future__ import annotations

import shutil
from pathlib import Path

from geom.errors import InputError
from thermoscope.folder import Folder, find_case, load_case
from thermoscope.terminal import Progress, notes

PACKAGE = Path(__file__).resolve().parents[1]


def opened(name: str, progress: Progress, untested: bool = False) -> Folder:
    """The case for reading; doubts about its data go to stderr. `untested`: one without tests will do."""
    folder = load_case(find_case(name), progress, untested=untested)
    notes(folder.notes)
    return folder


def in_short(folder: Folder, name: str) -> None:
    """How much looks wrong in the files, and what says more."""
    if count := sum(not finding.remark for finding in folder.findings):
        notes([f"{count} {'thing looks' if count == 1 else 'things look'} wrong: thermoscope doctor {name}"])


def opened_to_write(name: str, progress: Progress) -> Folder:
    """The case for writing: one that lies inside the installed package is copied to the working folder first."""
    path = find_case(name)
    if PACKAGE in path.resolve().parents:
        copy = Path(path.name)
        if copy.exists():
            raise InputError("is in the way of a copy of the shipped case", str(copy), "another working folder")
        load_case(path, progress)
        shutil.copytree(path, copy, ignore=shutil.ignore_patterns("out"))
        notes([f"copied the shipped case '{name}' to ./{copy}; from now on that folder is used"])
        path = copy
    if (out := path / "out").exists() and not out.is_dir():
        raise InputError("is no folder", str(out), "a folder for results: move the file away")
    folder = load_case(path, progress)
    notes(folder.notes)
    return folder
