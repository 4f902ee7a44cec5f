"""thermoscope model machines"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geom.table import Table
from thermoscope.console.options import Json, Out
from thermoscope.console.summary import Summary
from thermoscope.console.terminal import give

if TYPE_CHECKING:
    from geom.drawings.gallery import Entry


def machines(out: Out = None, target: Json = None) -> int:
    """The machines that come along; with --out also a page with a thumbnail of each."""
    from geom import catalogue, write_library

    entries = catalogue()
    page = write_library(out) if out is not None else None
    give({"machines": [described(entry, page) for entry in entries]}, target, lambda: machines_summary(entries, page))
    return 0


def described(entry: Entry, page: Path | None) -> dict[str, Any]:
    """One machine of the document: mass in kg, envelope in m, thumbnail if one was written."""
    fields = {
        ("mass_kg" if k == "mass" else "envelope_m" if k == "envelope" else k): v for k, v in asdict(entry).items()
    }
    return fields if page is None else {**fields, "thumbnail": page.parent / "thumbnails" / f"{entry.name}.svg"}


def machines_summary(entries: Sequence[Entry], page: Path | None) -> Summary:
    """A row per machine."""
    table = Table.of(
        "",
        entries,
        "machine=name | family | parts | mass (kg)=mass | l x w x h (mm)=envelope | cooling | numbers from=source",
        envelope=lambda e: " x ".join(f"{1e3 * size:.0f}" for size in e.envelope),
    )
    where = f"thumbnails: {page}" if page is not None else "--out DIR for thumbnails"
    return Summary(f"{len(table.rows)} machines come along.", [table], f"{where}; thermoscope model build MACHINE")
