"""Bands around what a case's model predicts; what the calibration left unsure is kept by the content of the case."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.constants import NORMAL_95
from geom.disk_cache import recalled, stored
from geom.storage import cache_folder
from lumped.integration.signals import Signals
from lumped.integration.simulate import Record
from lumped.model.network import Network, Row
from lumped.transfer.laws import CLOCK
from measured.case import RUNNING, Recorded, Test
from thermoscope.case_folder.content import case_key
from thermoscope.case_folder.folder import Folder, Progress
from thermoscope.case_folder.runs import named_rows
from validation.bands import Bands, ParameterPosterior, Place, at_end, band_stretches, bands, parameter_posterior
from validation.bands.posterior import rows_read
from validation.comparison.error_budget import model_of
from validation.comparison.predict import record
from validation.threads import counted

SMALL = 40  # states up to which bands cost less than a run's other work
JUMP_S = 1e-6  # far below any step, far above the rounding of a day in seconds
LAYOUT = 3  # of a kept file: a change here makes old ones be left alone


def bands_requested(network: Network, requested: bool | None) -> bool:
    """Whether bands are made: as asked, else where they cost little."""
    return len(network.states) <= SMALL if requested is None else requested


def posterior_of(folder: Folder, progress: Progress) -> ParameterPosterior:
    """Of the model as it stands, from the cache where this very case was looked at before."""
    file = cache_folder() / f"belief-{LAYOUT}-{case_key(folder)}.npz"
    cached = recalled(file, lambda path: _from_cache(folder, path))
    if cached is not None:
        return cached
    posterior = parameter_posterior(folder.case, progress)
    if posterior.fitted:
        names = json.dumps([posterior.names, posterior.fitted])
        with stored(file) as partial:
            np.savez_compressed(partial, covariance=posterior.covariance, offset=posterior.offset, said=names)
    return posterior


def _from_cache(folder: Folder, file: Path) -> ParameterPosterior:
    with np.load(file) as archive:
        names, tests = json.loads(str(archive["said"]))
        bare = replace(folder.case, model=replace(folder.case.model, revision=0))
        arrays = {name: archive[name] for name in ("covariance", "offset")}
    read = rows_read([t for t in folder.case.tests if t.name in tests])
    return replace(parameter_posterior(bare), names=tuple(names), fitted=tuple(tests), read=read, **arrays)


def predicted_bands(of: ParameterPosterior, name: str, record: Record, rows: Mapping[str, Row]) -> Bands:
    """Temperatures along a record and how sure they are."""
    return bands(of, _test_of(name, record), _places(rows))


def _places(rows: Mapping[str, Row]) -> list[Place]:
    return [Place(name, row) for name, row in rows.items()]


def full_columns(name: str, values: Mapping[str, Array | float], record: Record) -> dict[str, Array]:
    """Inputs or boundaries of a record as columns (n_time,), without its clock and the mark of the test of a name."""
    each = {n: u for n, u in values.items() if n not in (CLOCK, f"{RUNNING}{name}")}
    return {n: np.broadcast_to(np.asarray(u, float), record.time.shape) for n, u in each.items()}


def _test_of(name: str, record: Record) -> Test:
    """A test without sensors, of a record."""
    inputs, air = full_columns(name, record.inputs, record), full_columns(name, record.boundaries, record)
    # The times, where one is given twice (a jump) a microsecond apart: rates of change are taken of them
    time = record.time + JUMP_S * np.cumsum(np.diff(record.time, prepend=-np.inf) == 0.0)
    source = record.inputs.source if isinstance(record.inputs, Signals) else None
    fine = Recorded(source.time, {n: source.signals[n] for n in inputs}, time, inputs) if source else None
    return Test(name, "hold-out", time, inputs, air, (), record.initial, recorded=fine)


def field_half95(folder: Folder, test: Test, parts: Sequence[str], progress: Progress) -> Array:
    """(n_nodes,) half the width of the 95 % band (K) on the parts' own nodes at the end of a test.

    The network needs a recovery. What a good model is off by counts with the rise since the start.
    """
    of = posterior_of(folder, progress)
    progress(f"uncertainty at the end of {test.name}")
    first, last, R = at_end(of, test)
    there, rise = (of.network.on_parts(parts, x) for x in (R, last - first))
    return NORMAL_95 * np.sqrt(np.sum(there**2, axis=1) + (of.doubt["slow"] * rise) ** 2)


def documents(bands: Bands) -> dict[str, dict[str, Any]]:
    """Place -> the fields of its band: at its largest temperature, at the end, and where it is widest."""
    out = {}
    for k, name in enumerate(bands.names):
        hottest = int(np.argmax(bands.y[:, k]))
        out[name] = {
            "max_ci95": interval(bands, hottest, k),
            "end_ci95": interval(bands, -1, k),
            "widest_ci95_K": float(2.0 * bands.half95[:, k].max()),
        }
    return out


def test_bands(folder: Folder, progress: Progress) -> list[dict[str, Any]]:
    """Test by test and place by place the width of the band; for a sensor also how much of its record is inside.

    The readings' own uncertainty (1 sigma of the sheet) counts with it.
    """
    of, places = posterior_of(folder, progress), _places(named_rows(model_of(folder)[0], folder))
    out = []
    for test in counted("bands around the model", folder.case.tests, len(folder.case.tests)):
        out += _widths(test, band_stretches(of, _test_of(test.name, record(test, {})), places))
    return out


def _widths(test: Test, stretches: Iterator[Bands]) -> list[dict[str, Any]]:
    """Place by place, looking at every stretch once."""
    sensors, start = {f"sensor {c.name}": c for c in test.channels}, 0
    total, widest = np.zeros(1), np.zeros(1)
    inside = dict.fromkeys(sensors, 0)
    for part in stretches:
        half95 = part.half95
        total, widest = total + half95.sum(axis=0), np.maximum(widest, half95.max(axis=0))
        for k, c in ((k, sensors[name]) for k, name in enumerate(part.names) if name in sensors):
            off = np.abs(c.y[start : start + len(half95)] - part.y[:, k])
            close = off <= np.hypot(half95[:, k], NORMAL_95 * c.sigma_K)  # no reading that is missing
            inside[part.names[k]] += int(close.sum())
        start += len(half95)
    rows = zip(part.names, (2.0 * total / start).tolist(), (2.0 * widest).tolist(), strict=True)
    out: list[dict[str, Any]] = [
        {"test": test.name, "place": name, "mean_ci95_K": mean, "widest_ci95_K": most} for name, mean, most in rows
    ]
    for row in (row for row in out if row["place"] in sensors):
        read = int(np.isfinite(sensors[row["place"]].y).sum())
        row["inside"] = inside[row["place"]] / read if read else float("nan")
    return out


def interval(bands: Bands, at: int, k: int) -> list[float]:
    """Central 95 % (degC)."""
    half = float(bands.half95[at, k])
    return [float(bands.y[at, k]) - half, float(bands.y[at, k]) + half]
