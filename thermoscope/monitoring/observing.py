"""The observer of a case. Its process noise is calibrated once for the sensors at hand, and kept."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geom.disk_cache import recalled
from geom.errors import InputError
from lumped.integration.record import Record
from lumped.schemas.reader import known
from lumped.transfer.laws import CLOCK
from thermoscope.bands import case_key, posterior_of
from thermoscope.caches import cache_folder
from thermoscope.case_folder.files import write_whole
from thermoscope.case_folder.folder import Folder, Progress
from thermoscope.monitoring.live_rows import Rows
from thermoscope.verification.error_budget import model_of
from validation.case import RUNNING, Channel
from validation.observer import Observer, ProcessNoise, observer
from validation.observer.learning import calibrated_noise, usual_rise
from validation.observer.process import Process, bodies_of
from validation.observer.process_noise import most_doubtful, of_doubt
from validation.threads import one_blas_thread

Array = NDArray[np.float64]
LAYOUT = 1  # of a kept file: a change here makes old ones be left alone


@dataclass(frozen=True)
class ObserverDesign:
    """Everything an observer is made of but its first readings.  table_sd (m,) W;  rise_K : usual rise of the tests"""

    process: Process
    noise: ProcessNoise
    table_sd: Array
    rise_K: float

    def started(self, sensors: Sequence[Channel], first: Rows) -> Observer:
        readings = np.array([first.readings[c.name][0] for c in sensors])
        around = {n: float(u[0]) for n, u in first.boundaries.items()}
        return observer(self.process, self.noise, self.table_sd, sensors, readings, around, self.rise_K)


@one_blas_thread
def designed(folder: Folder, at_hand: Sequence[str], progress: Progress) -> ObserverDesign:
    """For some sensors; from the cache where this very case was looked at before."""
    network, values = model_of(folder)
    tests = [t for t in folder.case.tests if t.role == "calibrate"]
    file = cache_folder() / f"noise-{_key(folder, at_hand)}.npz"
    held = recalled(file, _from_cache)
    if held is None:
        posterior = posterior_of(folder, progress)
        progress("missing heat that the table of doubt allows")
        bodies, table = most_doubtful(bodies_of(network), of_doubt(posterior, tests, bodies_of(network)))
        process = Process(network, values, bodies)
        noise = calibrated_noise(process, tests, table, at_hand, progress)
        held = bodies, noise, np.sqrt(np.diag(table))
        out = io.BytesIO()
        np.savez_compressed(out, bodies=np.array(bodies), covariance=noise.covariance, time_s=noise.time_s, sd=held[2])
        write_whole(file, out.getvalue())
    bodies, noise, sd = held
    return ObserverDesign(Process(network, values, bodies), noise, sd, usual_rise(tests))


def _from_cache(file: Path) -> tuple[tuple[str, ...], ProcessNoise, Array]:
    with np.load(file) as held:
        noise = ProcessNoise(held["covariance"], float(held["time_s"]))
        return tuple(str(b) for b in held["bodies"]), noise, held["sd"]


def _key(folder: Folder, at_hand: Sequence[str]) -> str:
    return hashlib.sha256(repr((LAYOUT, case_key(folder), sorted(at_hand))).encode()).hexdigest()[:20]


def chosen(here: Sequence[Channel], given: Sequence[str], where: str) -> list[Channel]:
    """The sensors that are asked for, by default all that are there."""
    names = [c.name for c in here]
    for name in given:
        if name not in names:
            raise InputError(f"no sensor '{name}'", "--sensor", known(name, names or ["no sensor in the rows"]))
    if not here:
        raise InputError("no sensor of the machine", where, "a temperature column that the test's sheet knows")
    return [c for c in here if c.name in given or not given]


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
        np.concatenate([before.time[-1:], now.time]), both(before.inputs, now.inputs),
        both(before.boundaries, now.boundaries), both(before.readings, now.readings),
    )  # fmt: skip
