"""thermoscope model machines"""

from collections.abc import Sequence
from dataclasses import asdict
from difflib import get_close_matches
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer

from geom.errors import InputError
from geom.storage import write_whole
from geom.table import Table
from thermoscope.console.options import Json, Out
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give

if TYPE_CHECKING:
    from geom.drawings.gallery import Entry


def machines(
    copied: Annotated[
        str | None, typer.Option("--copy", metavar="NAME", help="Write NAME.toml here, to change it.")
    ] = None,
    out: Out = None,
    target: Json = None,
) -> int:
    """The machines that come along; with --out also a page with a thumbnail of each. --copy takes the file of one."""
    from geom import catalogue, library, write_library

    if copied is not None:
        if copied not in library():
            near = ", ".join(get_close_matches(copied, library(), cutoff=0.0))
            raise InputError(f"no machine {copied!r} comes along", "--copy", f"for example {near}")
        file = write_machine_file(copied, library()[copied].read_bytes(), out or Path())
        summary = Summary(f"{file}: yours to change.", [], f"Next: thermoscope model build {quote(str(file))}")
        give({"machine": copied, "file": file}, target, lambda: summary)
        return 0
    entries = catalogue()
    page = write_library(out) if out is not None else None
    give({"machines": [described(entry, page) for entry in entries]}, target, lambda: machines_summary(entries, page))
    return 0


def write_machine_file(name: str, text: str | bytes, folder: Path) -> Path:
    """A machine file in a folder, whole or not at all. InputError where one of that name lies there."""
    target = folder / f"{name}.toml"
    if target.exists():
        raise InputError("is there already: it stays", str(target), "another folder: --out DIR")
    folder.mkdir(parents=True, exist_ok=True)
    return write_whole(target, text)


def described(entry: "Entry", page: Path | None) -> dict[str, Any]:
    """One machine of the document: mass in kg, envelope in m, thumbnail if one was written."""
    fields = {
        ("mass_kg" if k == "mass" else "envelope_m" if k == "envelope" else k): v for k, v in asdict(entry).items()
    }
    return fields if page is None else {**fields, "thumbnail": page.parent / "thumbnails" / f"{entry.name}.svg"}


def machines_summary(entries: "Sequence[Entry]", page: Path | None) -> Summary:
    """A row per machine."""
    table = Table.of(
        "",
        entries,
        "machine=name | family | parts | mass (kg)=mass | l x w x h (mm)=envelope | cooling | numbers from=source",
        envelope=lambda e: " x ".join(f"{1e3 * size:.0f}" for size in e.envelope),
    )
    where = f"thumbnails: {page}" if page is not None else "--out DIR for thumbnails"
    next_step = f"{where}; --copy NAME for the file of one; thermoscope model build MACHINE"
    return Summary(f"{len(table.rows)} machines come along.", [table], next_step)
