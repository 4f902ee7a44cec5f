"""Rows as they come, on the disk before anything is made of them: a test of the case, and a journal beside it."""

import fcntl
import json
import math
import os
from collections.abc import Mapping
from io import TextIOWrapper
from pathlib import Path
from typing import Any

from thermoscope import InputError, plugin as th

Row = dict[str, float]


class BenchError(InputError):
    """What ends a run: the bench is set safe before it is said."""


class Store:
    """tests/NAME.csv of a case, held for one writer, and tests/NAME.jsonl.  sync : on the disk row by row

    last : the last row of an earlier run
    """

    def __init__(self, case: Path, name: str, sheet: str, sync: bool = True) -> None:
        self.case, self.name, self.sheet, self.sync = case, name, sheet, sync
        self.path, self.journal_path = case / "tests" / f"{name}.csv", case / "tests" / f"{name}.jsonl"
        self.done_path = self.path.with_suffix(".done")
        self.path.parent.mkdir(exist_ok=True)
        self.rows = self._locked(self.path)
        self.header, self.last = self._resumed()
        self.journal: TextIOWrapper = self.journal_path.open("a", encoding="utf-8")  # type: ignore[assignment]

    def _locked(self, path: Path) -> TextIOWrapper:
        file = path.open("a+", encoding="utf-8", newline="")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            file.close()
            raise InputError("is written by another run", str(path), "one writer: end the other run first") from None
        return file  # type: ignore[return-value]

    def _resumed(self) -> tuple[list[str], Row | None]:
        """Header and last row of what is there; a last line that a killed run left half written is dropped."""
        whole = self.path.read_bytes()
        end = whole.rfind(b"\n") + 1
        if end < len(whole):
            self.rows.truncate(end)
        if not end:
            return [], None
        first, last = whole[: whole.index(b"\n")], whole[whole.rfind(b"\n", 0, end - 1) + 1 : end - 1]
        header, cells = (line.decode("utf-8").split(",") for line in (first, last))
        if cells == header:
            return header, None
        return header, {name: float(cell or "nan") for name, cell in zip(header, cells, strict=True)}

    def append(self, row: Mapping[str, float]) -> None:
        """One row under the header of the first; what it lacks stays empty."""
        if not self.header:
            self.header = list(row)
            self.rows.write(th.csv_lines([self.header]))
        if extra := next((n for n in row if n not in self.header), None):
            right = f"the columns of the first row: {', '.join(self.header)}"
            raise BenchError(f"column '{extra}' is new", str(self.path), right)
        cells = (row.get(n, math.nan) for n in self.header)
        self.rows.write(",".join("" if math.isnan(v) else f"{v:.10g}" for v in cells) + "\n")
        self._flush(self.rows)

    def note(self, event: Mapping[str, Any]) -> None:
        """A line of the journal: what was set, what was thought, why it ended."""
        self.journal.write(json.dumps(event) + "\n")
        self._flush(self.journal)

    def _flush(self, file: TextIOWrapper) -> None:
        file.flush()
        if self.sync:
            os.fsync(file.fileno())

    def events(self) -> list[Mapping[str, Any]]:
        """The journal so far."""
        return th.journal(self.journal_path)

    def hears_done(self) -> bool:
        """Whether tests/NAME.done was put there since it was last asked: what a page says instead of typing."""
        there = self.done_path.exists()
        self.done_path.unlink(missing_ok=True)
        return there

    def listed(self) -> None:
        """The test's table in case.toml, where it has none yet."""
        file = self.case / "case.toml"
        text = file.read_text(encoding="utf-8")
        if f"[tests.{self.name}]" not in text:
            sheet = th.toml_value(self.sheet)
            th.write_whole(file, f'{text.rstrip()}\n\n[tests.{self.name}]\nrole = "calibrate"\nsheet = {sheet}\n')

    def close(self) -> None:
        self.rows.close()
        self.journal.close()
