"""The last diagnosis of a case, kept in its out/ so that a report or an added effect can refer to it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from thermoscope.commands.opened import PACKAGE
from thermoscope.files import write_whole
from thermoscope.folder import Folder
from thermoscope.terminal import plain

NAME = "diagnosis.json"


def fingerprint(case: Path) -> str:
    """Of everything a result depends on: all files of the case outside out/."""
    digest = hashlib.sha256()
    for path in sorted(p for p in case.rglob("*") if p.is_file() and "out" not in p.relative_to(case).parts):
        digest.update(str(path.relative_to(case)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def save_diagnosis(folder: Folder, document: Mapping[str, Any]) -> None:
    """Keep it, unless the case lies inside the installed package."""
    if PACKAGE in folder.settings.path.resolve().parents:
        return
    kept = {**document, "fingerprint": fingerprint(folder.settings.path)}
    write_whole(folder.settings.out / NAME, json.dumps(plain(kept), indent=1))


def saved_diagnosis(folder: Folder) -> dict[str, Any] | None:
    """The kept diagnosis, if nothing in the case has changed since."""
    kept = last_diagnosis(folder)
    return kept if kept and kept.get("fingerprint") == fingerprint(folder.settings.path) else None


def last_diagnosis(folder: Folder) -> dict[str, Any] | None:
    """The kept diagnosis, of whatever model it was."""
    path = folder.settings.out / NAME
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None
