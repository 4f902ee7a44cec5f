"""The observer of a case. What the calibration tests teach it is learned once, and kept."""

import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from extras.monitor.observer.kalman import most_doubtful, of_doubt
from extras.monitor.observer.learning import Design, Lesson, design_of, narrowed, taught, unsettled
from extras.monitor.observer.process import bodies_of
from extras.monitor.rows.live_rows import Rows
from thermoscope import InputError, Network, Record, plugin as th, simulate

LAYOUT = 3  # of a kept file: a change here makes old ones be left alone
Model = tuple[Network, Mapping[str, float]]  # and the values of its parameters


@th.one_blas_thread
def designed(folder: th.Folder, progress: th.CaseProgress) -> Design:
    """What the calibration tests taught; from the cache where this very case was looked at before."""
    network, values = th.model_of(folder)
    network = narrowed(network, values, folder.case)
    tests = taught_tests(folder)
    file = th.cache_folder() / f"observer-{LAYOUT}-{len(network.states)}-{th.case_key(folder)}.npz"  # large or small
    cached = th.recalled(file, _from_cache)
    if cached is not None:
        return design_of(network, values, cached, tests, folder.case.doubt)
    progress("missing heat that the table of doubt allows")
    bodies, table = most_doubtful(bodies_of(network), of_doubt(unsettled(folder.case), tests, bodies_of(network)))
    lesson = taught(network, values, bodies, table, tests, folder.case.doubt, progress)
    out = io.BytesIO()
    np.savez_compressed(out, bodies=np.array(bodies), table=table, constants=lesson.constants)
    th.store(file, out.getvalue())
    return design_of(network, values, lesson, tests, folder.case.doubt)


def taught_tests(folder: th.Folder) -> list[th.Test]:
    """What an observer learns from."""
    return [t for t in folder.case.fitted if t.role == "calibrate"]


def model_gap(
    models: Sequence[Model], tests: Iterable[th.Test], rows: Sequence[Mapping[str, th.Row]]
) -> dict[str, float]:
    """Temperature -> root mean square (K) along some tests of what two models of one machine predict apart.

    rows : of each of the two models, temperature -> its row
    """
    names = [name for name in rows[0] if name in rows[1]]
    gaps = [np.zeros((0, len(names)))]
    for test in tests:
        a, b = (
            simulate(network, th.record(test, {}), values, [looks[n] for n in names]).y
            for (network, values), looks in zip(models, rows, strict=True)
        )
        gaps.append(a - b)
    every = np.concatenate(gaps)
    return dict(zip(names, np.sqrt(np.mean(every**2, axis=0)).tolist(), strict=True)) if every.size else {}


def less_sure(folder: th.Folder, gap: Mapping[str, float]) -> th.Folder:
    """The folder whose sensors are off by a gap (K rms) as well: what the filter is told of a reading's error."""

    def one(c: th.Channel) -> th.Channel:
        return replace(c, sigma_K=float(np.hypot(c.sigma_K, gap.get(f"sensor {c.name}", 0.0))))

    tests = tuple(replace(t, channels=tuple(map(one, t.channels))) for t in folder.case.tests)
    return replace(folder, case=replace(folder.case, tests=tests))


def _from_cache(file: Path) -> Lesson:
    with np.load(file) as archive:
        return Lesson(tuple(str(b) for b in archive["bodies"]), archive["table"], archive["constants"])


def chosen(here: Sequence[th.Channel], sensors: Sequence[str], where: str) -> list[th.Channel]:
    """The sensors that are asked for, by default all that are there."""
    names = [c.name for c in here]
    for name in sensors:
        if name not in names:
            raise InputError(f"no sensor '{name}'", "--sensor", th.suggestion(name, names or ["no sensor in the rows"]))
    if not here:
        raise InputError("no sensor of the machine", where, "a temperature column that the test's sheet knows")
    return [c for c in here if c.name in sensors or not sensors]


def record_of(rows: Rows, folder: th.Folder) -> Record:
    """What drives the network; no test of the case is running."""
    beside = {th.CLOCK: rows.time, **{f"{th.LAW_RUNNING}{t.name}": np.zeros(rows.time.size) for t in folder.case.tests}}
    return Record(rows.time, {**rows.inputs, **beside}, rows.boundaries)


def joined(before: Rows | None, now: Rows) -> Rows:
    """Rows with the last of those before in front."""
    if before is None:
        return now

    def both(a: dict[str, th.Array], b: dict[str, th.Array]) -> dict[str, th.Array]:
        return {n: np.concatenate([a[n][-1:], v]) for n, v in b.items()}

    pairs = ((getattr(before, n), getattr(now, n)) for n in ("inputs", "boundaries", "readings"))
    return Rows(np.concatenate([before.time[-1:], now.time]), *(both(a, b) for a, b in pairs))
