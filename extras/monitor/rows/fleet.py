"""Recordings of a fleet, motor by motor and piece by piece: only their statistics stay in memory."""

import re
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path

import numpy as np

from extras.monitor.fleet import Statistics, UnitHistory, statistics
from extras.monitor.rows.live_rows import Rows, table_of
from thermoscope import InputError, plugin as th

PIECE = 20_000  # rows that are in memory at once: five hours at 1 Hz
LEAST = 60  # rows worth a fit
STEP_S = 20.0  # between the instants that a fit looks at, where the case does not say
DATED = re.compile(r"(?P<unit>.+)@(?P<year>\d{4})-(?P<month>\d\d)(-(?P<day>\d\d))?")


@dataclass(frozen=True)
class Recording:
    """A file of one motor.  year : its date, 0 where the name gives none"""

    file: Path
    unit: str
    year: float


@dataclass(frozen=True)
class Reader:
    """What a recording is read with.  tests : of the case, of which none is running here;  case : without them

    sheets : test -> its sheet, of those whose columns a recording may have: the first that fits
    piece : rows that are in memory at once
    """

    case: th.MeasuredCase
    tests: tuple[th.Test, ...]
    sheets: Mapping[str, th.Sheet]
    step_s: float
    piece: int = PIECE

    def statistics(self, recording: Recording) -> Statistics:
        """All pieces of a recording together."""
        total: Statistics | None = None
        network = self.case.model.network
        name, table, parts = table_of(str(recording.file), self.piece, self.sheets, network, None)
        fitting = next(test for test in self.tests if test.name == name)
        for part in parts:
            if total is None or part.rows >= LEAST:
                one = statistics(self.case, self._test(table.rows(part), recording, fitting))
                total = one if total is None else total + one
        if total is None:
            raise InputError("holds no row", str(recording.file), "rows of numbers under the header")
        return total

    def _test(self, rows: Rows, recording: Recording, fitting: th.Test) -> th.Test:
        if rows.time.size < LEAST:
            raise InputError(f"holds {rows.time.size} rows", str(recording.file), f"at least {LEAST} to fit a motor to")
        cell = np.floor((rows.time - rows.time[0]) / self.step_s)
        start = np.flatnonzero(np.diff(cell, prepend=-1.0) > 0)

        def mean(y: th.Array) -> th.Array:
            good = np.isfinite(y).astype(float)
            count = np.add.reduceat(good, start)
            with np.errstate(invalid="ignore"):
                return np.add.reduceat(np.nan_to_num(y), start) / np.where(count > 0.0, count, np.nan)

        channels = [replace(c, y=mean(rows.readings[c.name])) for c in fitting.channels if c.name in rows.readings]
        if not any(np.isfinite(c.y).any() for c in channels):
            raise InputError("no sensor of the machine", str(recording.file), "a temperature that the sheet knows")
        time = mean(rows.time)
        inputs = {n: mean(u) for n, u in rows.inputs.items()}
        inputs |= {f"{th.LAW_RUNNING}{test.name}": np.zeros(time.size) for test in self.tests}
        air = {n: mean(u) for n, u in rows.boundaries.items()}
        first = {c.place: float(c.y[np.isfinite(c.y)][0]) for c in channels if np.isfinite(c.y).any()}
        initial = first or {name: float(u[0]) for name, u in air.items()}
        return th.Test(recording.unit, "calibrate", time - time[0], inputs, air, tuple(channels), initial)


def recordings(names: Sequence[Path]) -> list[Recording]:
    """Files, and those in folders: UNIT.csv or UNIT@YEAR-MONTH[-DAY].csv."""
    files = [f for name in names for f in (_inside(name) if name.is_dir() else [name])]
    out = [_recording(file) for file in files]
    if (count := len({r.unit for r in out})) < 3:
        what = f"{'one motor is' if count == 1 else f'{count} motors are'} no fleet"
        right = "recordings of three or more, named UNIT.csv or UNIT@2026-03.csv"
        raise InputError(what, ", ".join(map(str, names)), right)
    dated = [r for r in out if r.year]
    if dated and len(dated) < len(out):
        bare = next(r for r in out if not r.year)
        raise InputError("has no date, others have", str(bare.file), "UNIT@YEAR-MONTH.csv for all, or for none")
    return out


def _inside(folder: Path) -> list[Path]:
    files = sorted(f for ending in th.SUFFIXES for f in folder.glob(f"[!.]*{ending}"))
    if not files:
        raise InputError("no recording in the folder", str(folder), "recordings named UNIT.csv or UNIT@2026-03.csv")
    return files


def _recording(file: Path) -> Recording:
    if not file.is_file():
        raise InputError("no such file", str(file), "recordings or folders of them")
    match = DATED.fullmatch(th.stem_of(file))
    if match is None:
        return Recording(file, th.stem_of(file), 0.0)
    try:
        day = date(int(match["year"]), int(match["month"]), int(match["day"] or 15))
    except ValueError:
        raise InputError("the name holds no date that exists", str(file), "UNIT@YEAR-MONTH[-DAY].csv") from None
    return Recording(file, match["unit"], day.year + (day.timetuple().tm_yday - 0.5) / 365.25)


def histories(
    files: Sequence[Recording], reader: Reader, tell: th.CaseProgress, executor: Executor | None = None
) -> list[UnitHistory]:
    """Motor by motor, in the order of their names."""
    by_unit: dict[str, list[tuple[float, Statistics]]] = {}
    for i, (one, numbers) in enumerate(zip(files, _each(files, reader, executor), strict=True)):
        tell(f"motors: {one.unit}, {i + 1} of {len(files)}")
        by_unit.setdefault(one.unit, []).append((one.year, numbers))
    return [
        UnitHistory(unit, tuple(y for y, _ in parts), tuple(s for _, s in parts))
        for unit, parts in sorted(by_unit.items())
    ]


def _each(files: Sequence[Recording], reader: Reader, executor: Executor | None) -> Iterator[Statistics]:
    if executor is None:
        yield from map(reader.statistics, files)
    else:
        yield from executor.map(reader.statistics, files)
