"""The observer of a case. What the calibration tests teach it is learned once, and kept."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from extras.monitor.observer import Observer
from extras.monitor.observer.learning import Design, Lesson, design_of, narrowed, taught, unsettled
from extras.monitor.observer.process import bodies_of
from extras.monitor.observer.process_noise import most_doubtful, of_doubt
from extras.monitor.rows.live_rows import Rows
from thermoscope import InputError, Record
from thermoscope.plugin import (
    CLOCK,
    Array,
    Channel,
    Folder,
    cache_folder,
    case_key,
    model_of,
    one_blas_thread,
    recalled,
    store,
    suggestion,
)
from thermoscope.plugin import LAW_RUNNING as RUNNING
from thermoscope.plugin import CaseProgress as Progress

LAYOUT = 2  # of a kept file: a change here makes old ones be left alone


@one_blas_thread
def designed(folder: Folder, progress: Progress) -> Design:
    """What the calibration tests taught; from the cache where this very case was looked at before."""
    network, values = model_of(folder)
    network = narrowed(network, values, folder.case)
    tests = [t for t in folder.case.fitted if t.role == "calibrate"]
    file = cache_folder() / f"observer-{LAYOUT}-{case_key(folder)}.npz"
    cached = recalled(file, _from_cache)
    if cached is not None:
        return design_of(network, values, cached, tests, folder.case.doubt)
    progress("missing heat that the table of doubt allows")
    bodies, table = most_doubtful(bodies_of(network), of_doubt(unsettled(folder.case), tests, bodies_of(network)))
    lesson = taught(network, values, bodies, table, tests, folder.case.doubt, progress)
    out = io.BytesIO()
    np.savez_compressed(out, bodies=np.array(bodies), table=table, constants=lesson.constants)
    store(file, out.getvalue())
    return design_of(network, values, lesson, tests, folder.case.doubt)


def _from_cache(file: Path) -> Lesson:
    with np.load(file) as archive:
        return Lesson(tuple(str(b) for b in archive["bodies"]), archive["table"], archive["constants"])


def started(design: Design, sensors: Sequence[Channel], first: Rows) -> Observer:
    """An observer at its first rows."""
    readings = np.array([first.readings[c.name][0] for c in sensors])
    return design.started(sensors, readings, {n: float(u[0]) for n, u in first.boundaries.items()})


def chosen(here: Sequence[Channel], sensors: Sequence[str], where: str) -> list[Channel]:
    """The sensors that are asked for, by default all that are there."""
    names = [c.name for c in here]
    for name in sensors:
        if name not in names:
            raise InputError(f"no sensor '{name}'", "--sensor", suggestion(name, names or ["no sensor in the rows"]))
    if not here:
        raise InputError("no sensor of the machine", where, "a temperature column that the test's sheet knows")
    return [c for c in here if c.name in sensors or not sensors]


def record_of(rows: Rows, folder: Folder) -> Record:
    """What drives the network; no test of the case is running."""
    beside = {CLOCK: rows.time, **{f"{RUNNING}{t.name}": np.zeros(rows.time.size) for t in folder.case.tests}}
    return Record(rows.time, {**rows.inputs, **beside}, rows.boundaries)


def joined(before: Rows | None, now: Rows) -> Rows:
    """Rows with the last of those before in front."""
    if before is None:
        return now

    def both(a: dict[str, Array], b: dict[str, Array]) -> dict[str, Array]:
        return {n: np.concatenate([a[n][-1:], v]) for n, v in b.items()}

    return Rows(
        np.concatenate([before.time[-1:], now.time]),
        both(before.inputs, now.inputs),
        both(before.boundaries, now.boundaries),
        both(before.readings, now.readings),
    )
