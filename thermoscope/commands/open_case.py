"""The case a command is about, and its last diagnosis, kept in its out/ for a report or an added effect."""

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geom.errors import InputError
from geom.limits import BYTES
from geom.storage import write_whole
from thermoscope.case_folder.folder import Folder, find_case, load_case
from thermoscope.case_folder.settings import read_settings
from thermoscope.console.terminal import Progress, notes, plain
from thermoscope.files import checked_result

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


NAME = "diagnosis.json"
SEAL = "sha256"


def fingerprint(case: Path, but: str = "") -> str:
    """Of everything a result depends on: all files of the case outside out/, but one."""
    digest = hashlib.sha256()
    for path in sorted(p for p in case.rglob("*") if p.is_file() and "out" not in p.relative_to(case).parts):
        if path.name == but or path.name.startswith(".") or path.stat().st_size > BYTES.most:
            continue  # a hidden file is what a killed process left; what is larger is not an input
        with path.open("rb") as file:
            content = hashlib.file_digest(file, "sha256").digest()
        digest.update(os.fsencode(path.relative_to(case)) + b"\0" + content)
    return digest.hexdigest()


def plan_of(case: Path) -> str:
    """Fingerprint of machine and tests, whatever the model's history."""
    return fingerprint(case, "model.toml")


def model_of(folder: Folder) -> str:
    """Fingerprint of the model as it stands and of what the user answered, however it came about."""
    last = folder.history.last
    return hashlib.sha256(
        repr((last.effects, sorted(last.values.items()), *sorted(last.answers.items()))).encode()
    ).hexdigest()


def store(path: Path, document: Mapping[str, Any]) -> None:
    """Write a document that `kept` can tell from a damaged one."""
    content = plain(document)
    write_whole(path, json.dumps({**content, SEAL: _sealed(content)}, indent=1))


def stored(path: Path) -> dict[str, Any] | None:
    """A document as it was written; None, with a note, where the file is not what was written."""
    if not checked_result(path).is_file():
        return None
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        seal = document.pop(SEAL)
        whole = bool(seal == _sealed(document))
    except (OSError, ValueError, RecursionError, AttributeError, KeyError, TypeError):
        whole = False
    if not whole:
        notes([f"{path} is damaged and is not used; the next result replaces it"])
        return None
    return dict(document)


def _sealed(content: Mapping[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def checked_diagnosis(folder: Folder) -> Path:
    """Where the diagnosis will be kept; refused before minutes are spent where no file can stand."""
    return checked_result(folder.settings.out / NAME)


def save_diagnosis(folder: Folder, document: Mapping[str, Any]) -> None:
    """Keep it, unless the case lies inside the installed package."""
    if PACKAGE in folder.settings.path.resolve().parents:
        return
    path = folder.settings.path
    store(folder.settings.out / NAME, {**document, "model": model_of(folder), "plan": plan_of(path)})


def current_diagnosis(folder: Folder) -> dict[str, Any] | None:
    """The kept diagnosis, if it is of these tests and this model: also after a step that was undone."""
    last = last_diagnosis(folder)
    same = last and last.get("model") == model_of(folder) and last.get("plan") == plan_of(folder.settings.path)
    return last if same else None


def last_diagnosis(folder: Folder) -> dict[str, Any] | None:
    """The kept diagnosis, of whatever model it was."""
    return stored(folder.settings.out / NAME)
