"""Samples onto the analysis grid: averages around each instant, gaps kept as gaps."""

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from geom.limits import INSTANTS
from measured.recordings.tables import Samples

LEAST = 3  # instants
LONGEST_S = 3.2e7  # a year
COARSE = 10.0  # times sample_s
ROUNDING = 1e-6  # of a time: minutes with twelve digits are off by less, and no instant at an edge may come or go


def grid_of(samples: Samples, step: float, where: str) -> tuple[Array, list[str]]:
    """Instants 0, step, 2 step, ... (s) that lie inside the record, never finer than the record itself; notes.

    Raises InputError for a test too short to compare or too long to be one: mostly a wrong time unit.
    """
    usual, span = float(np.median(np.diff(samples.time))), float(samples.time[-1])
    interval = max(step, usual)
    count = span / interval + 1
    if not LEAST <= count <= INSTANTS.most or span > LONGEST_S:
        raise InputError(
            f"the test lasts {span:.4g} s with a row every {usual:.4g} s: {count:.3g} instants of {interval:.4g} s",
            where,
            f"{LEAST} to {INSTANTS.most:,} instants ({INSTANTS.variable}) and "
            "at most a year: is time_unit right, and sample_s of case.toml?",
        )
    coarse = usual > COARSE * step
    note = f"{samples.file.name}: rows are {usual:g} s apart, sample_s is {step:g} s; is time_unit in {where} right?"
    return np.arange(0.0, span + ROUNDING * interval, interval), [note] if coarse else []


def averaged(time: Array, values: Array, grid: Array) -> Array:
    """Mean of the readings within half a step of each instant, NaN where there is none.

    A reading halfway between two instants counts half for each, so that no mean is early or late; alone it is none.
    """
    if grid.size < 2:
        return np.full(grid.size, np.nanmean(values))
    at = np.round(time / (grid[1] - grid[0]), 9)
    count, total = np.zeros(grid.size), np.zeros(grid.size)
    for cell in (np.ceil(at - 0.5).astype(np.int64), np.floor(at + 0.5).astype(np.int64)):
        inside = np.isfinite(values) & (cell >= 0) & (cell < grid.size)
        count += np.bincount(cell[inside], minlength=grid.size)
        total += np.bincount(cell[inside], values[inside], minlength=grid.size)
    return np.where(count > 1, total / np.maximum(count, 1), np.nan)


def read(time: Array, values: Array, grid: Array) -> Array:
    """Readings on the grid: means around the instants; at an end around which there is but half, the one there."""
    out, half = averaged(time, values, grid), 0.5 * (grid[1] - grid[0])
    for end in (0, -1):
        near = int(np.argmin(np.abs(time - grid[end])))
        alone = end == 0 or time[-1] < grid[-1] + 0.99 * half
        if alone and abs(time[near] - grid[end]) < half:
            out[end] = values[near]
    return out


def rms(time: Array, values: Array, grid: Array) -> Array:
    """Root mean square with the sign of the mean: a current whose heat is that of the record."""
    return np.copysign(np.sqrt(averaged(time, values**2, grid)), averaged(time, values, grid))


def bridged(grid: Array, values: Array, max_gap_s: float, where: str) -> Array:
    """An input or boundary with short holes drawn straight across; a longer one is refused."""
    finite = np.flatnonzero(np.isfinite(values))
    if finite.size == grid.size:
        return values
    edges = np.concatenate([[0.0], grid[finite], [grid[-1]]])
    worst = int(np.argmax(np.diff(edges)))
    if edges[worst + 1] - edges[worst] > max(max_gap_s, 2 * (grid[1] - grid[0])):
        raise InputError(
            f"nothing known from {edges[worst]:g} s to {edges[worst + 1]:g} s",
            where,
            f"gaps of {max_gap_s:g} s at most: split the test there, or raise max_gap_s in its sheet",
        )
    return np.interp(grid, grid[finite], values[finite])
