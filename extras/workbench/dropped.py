"""Recordings dropped on the page: what each column is taken for, columns dragged to other parts, a case of them."""

import re
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from uuid import uuid4

from aiohttp import BodyPartReader, MultipartReader, web

from thermoscope import InputError, Network, plugin as th

DROP_PREFIX = "thermoscope-drop-"
DROP_FOLDER = rf"{re.escape(tempfile.gettempdir())}.{DROP_PREFIX}\w+.[0-9a-f]{{32}}."  # of a file while it is read
CHUNK = 2**20  # bytes: little memory, few system calls


@dataclass(frozen=True)
class Dropped:
    """records : files with what each column is taken for;  target : what the open case's model offers

    constants : what was not recorded, input or boundary -> value
    """

    records: tuple[th.Recording, ...]
    target: th.Target
    constants: Mapping[str, float] = field(default_factory=dict)

    def moved(self, key: str, to: str) -> "Dropped":
        """With a column (its key in `rows`) at another place or input, "" to leave it out.

        Raises InputError where it cannot go there.
        """
        number, _, column = key.partition(":")
        i = int(number) if number.isdigit() else len(key)
        if i >= len(self.records) or all(g.column != column for g in self.records[i].guesses):
            raise InputError(f"no column '{column}'", "recordings", "one of those that were dropped")
        records = list(self.records)
        records[i] = replace(
            records[i], guesses=th.assigned(records[i].guesses, records[i].source, column, to, self.target)
        )
        for j, r in enumerate(self.records):
            if j != i:
                records[j] = replace(r, guesses=th.assigned(r.guesses, r.source, "", to, self.target))
        return replace(self, records=tuple(records))

    def constant(self, name: str, text: str) -> "Dropped":
        """With the value of something that was not recorded, "" for none again."""
        value = th.number(text)
        if text.strip() and value != value:
            raise InputError(f"'{text}' is not a number", name, "such as 21.5")
        rest = {k: v for k, v in self.constants.items() if k != name}
        return replace(self, constants={**rest, name: value} if text.strip() else rest)

    @property
    def rows(self) -> list[dict[str, str]]:
        """Every column as the page lists it."""
        return [
            {
                "key": f"{i}:{g.column}",
                "name": g.column,
                "file": r.name,
                "goes": g.place or g.feeds,
                "unit": g.unit,
                "quantity": g.quantity.replace("_", " "),
                "doubt": g.doubt,
            }
            for i, r in enumerate(self.records)
            for g in r.guesses
        ]

    @property
    def document(self) -> dict[str, Any]:
        """As the page's state holds it."""
        goes: dict[str, list[str]] = {}
        for row in self.rows:
            goes.setdefault(row["goes"], []).append(row["name"])
        kinds = (("part", self.target.places), ("surroundings", self.target.boundaries), ("input", self.target.inputs))
        parts = [{"name": n, "kind": kind, "columns": goes.get(n, [])} for kind, names in kinds for n in names]
        part_names = [p["name"] for p in parts]
        others = [{"name": n, "kind": "input", "columns": c} for n, c in goes.items() if n and n not in part_names]
        return {
            "files": ", ".join(f"{r.name}{r.clock.doubt and f' ({r.clock.doubt})'}" for r in self.records),
            "columns": self.rows,
            "parts": [*parts, *others],
            "missing": self.missing,
            "constants": {n: f"{v:g}" for n, v in self.constants.items()},
        }

    @property
    def missing(self) -> list[str]:
        """Inputs and boundaries of the model that no column gives."""
        draft = th.Draft("drop", self.records)
        draft = replace(draft, squares=th.squares_of(draft.guesses, self.target))
        return [*th.missing_inputs(draft, self.target), *th.missing_boundaries(draft, self.target)]


def read(files: Sequence[Path], network: Network, tell: th.Progress) -> Dropped:
    """Recordings with the guesses of `thermoscope test new`. Raises InputError for a file that is not a record."""
    target, recordings = th.target_of(network), th.read_runs(*files, tell=tell)
    return Dropped(tuple(th.Recording(s, c, th.guesses(s, c.columns, target)) for s, c in recordings), target)


def write(dropped: Dropped, settings: th.Settings, network: Network, tell: th.Progress) -> Path:
    """A new case beside the open one, with its machine or network; the folder."""
    names = [p.name for p in settings.path.resolve().parent.iterdir()]
    folder = settings.path.resolve().parent / th.test_name(dropped.records[0].source.file, names)
    dialogue = th.Dialogue(dropped.target, False, dict(dropped.constants))
    th.save_case(folder, th.model_of_case(settings, network), th.drafts_of(dropped.records, dialogue), tell)
    return folder


async def stored(parts: MultipartReader, folder: Path, largest: int) -> list[Path]:
    """The files of an upload, under their own names but nowhere else. HTTP 413 for more than `largest` bytes."""
    files, size = [], 0
    async for part in parts:
        if not isinstance(part, BodyPartReader) or not part.filename:
            continue
        plain = Path(th.file_stem(Path(part.filename).name))
        name = th.cut_short(plain.stem.lstrip(".")) + th.cut_short(plain.suffix)
        inside = folder / uuid4().hex  # two files of one name
        inside.mkdir()
        files.append(inside / name)
        with files[-1].open("wb") as out:
            while chunk := await part.read_chunk(CHUNK):
                size += len(chunk)
                if size > largest:
                    raise web.HTTPRequestEntityTooLarge(largest, size)
                out.write(chunk)
    return files
