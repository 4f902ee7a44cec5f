"""thermoscope model machines"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermoscope.console.answer import Answer, Grid
from thermoscope.console.terminal import give

if TYPE_CHECKING:
    from geom.drawings.gallery import Entry


def machines(out: Path | None, target: str | None) -> int:
    """The library: a table or a document, and with a folder also a page with a thumbnail of each machine."""
    from geom import catalogue, write_library

    entries = catalogue()
    page = write_library(out) if out is not None else None
    give({"machines": [described(entry, page) for entry in entries]}, target, lambda: answer(entries, page))
    return 0


def described(entry: Entry, page: Path | None) -> dict[str, Any]:
    """One machine of the document: mass in kg, envelope in m, thumbnail if one was written."""
    fields = {
        ("mass_kg" if k == "mass" else "envelope_m" if k == "envelope" else k): v for k, v in asdict(entry).items()
    }
    return fields if page is None else {**fields, "thumbnail": page.parent / "thumbnails" / f"{entry.name}.svg"}


def answer(entries: Sequence[Entry], page: Path | None) -> Answer:
    """A row per machine."""
    rows = [
        [e.name, e.family, e.parts, e.mass, " x ".join(f"{1e3 * size:.0f}" for size in e.envelope), e.cooling, e.source]
        for e in entries
    ]
    headers = ["machine", "family", "parts", "mass (kg)", "l x w x h (mm)", "cooling", "numbers from"]
    where = f"thumbnails: {page}" if page is not None else "--out DIR for thumbnails"
    more = f"{where}; thermoscope model build MACHINE"
    return Answer(f"{len(rows)} machines come along.", [Grid("", headers, rows)], more)
