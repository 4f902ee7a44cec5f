"""Two recorders, two clocks: by what both recorded, or by the instant at which something begins to change in each."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.errors import InputError
from measured.recordings.data_table import Column, DataTable

AGREE = 0.8  # correlation below which the records do not show the same thing
EARLY, LATER = 0.05, 0.10  # of a column's range; the line through both crossings tells where the change began
NOISE_TIMES = 6.0  # in standard deviations of the noise: a change, not a wobble
STILL = 5  # readings that say where a column starts
EMPTY: Mapping[str, Any] = {"f": np.nan, "M": "NaT", "m": "NaT"}  # of what kinds a column may be; others hold None


def clock_shift(time: Array, values: Array, other_time: Array, other: Array, limit_s: float, where: str) -> float:
    """Seconds to add to the other clock, at most `limit_s` either way: the best correlation, refined by a parabola.

    Raises InputError where no shift makes the two agree, or the best lies at the limit.
    """
    keep, theirs = np.isfinite(values), np.isfinite(other)
    time, values, other_time, other = time[keep], values[keep], other_time[theirs], other[theirs]
    if time.size < 8 or other_time.size < 8 or np.ptp(values) == 0 or np.ptp(other) == 0:
        raise InputError("too few or constant readings", where, "a quantity that both recorders saw change")
    step = max(float(np.median(np.diff(time))), float(np.median(np.diff(other_time))))
    shifts = np.arange(-np.ceil(limit_s / step), np.ceil(limit_s / step) + 1) * step
    score = np.array([_agreement(time, values, other_time + s, other) for s in shifts])
    best = int(np.argmax(score))
    if not score[best] > AGREE:
        raise InputError(
            f"the records agree with a correlation of {score[best]:.2f} at best",
            where,
            "the same quantity in both, or shift_s = ...",
        )
    if best in (0, shifts.size - 1):
        raise InputError(f"the clocks differ by {limit_s:g} s or more", where, "limit_s = ... larger, or shift_s = ...")
    left, middle, right = score[best - 1 : best + 2]
    bend = left - 2 * middle + right
    return float(shifts[best] + (0.5 * (left - right) / bend * step if bend < 0 else 0.0))


def _agreement(time: Array, values: Array, other_time: Array, other: Array) -> float:
    """Correlation where the records overlap, 0 where they overlap by less than a third."""
    inside = (time >= other_time[0]) & (time <= other_time[-1])
    if inside.sum() < max(4, time.size / 3):
        return 0.0
    a, b = values[inside], np.interp(time[inside], other_time, other)
    return float(np.corrcoef(a, b)[0, 1]) if np.ptp(a) and np.ptp(b) else 0.0


def column_onset(time: Array, values: Array) -> float | None:
    """Where a column leaves its first readings (s); None where it never does, or was moving from the start."""
    finite = np.flatnonzero(np.isfinite(values) & np.isfinite(time))
    t, y = time[finite], values[finite]
    if y.size < 4 * STILL:
        return None
    away = np.abs(y - np.median(y[:STILL]))
    noise = 1.4826 * float(np.median(np.abs(np.diff(y)))) / np.sqrt(2.0)
    reach = float(away.max())
    if reach <= NOISE_TIMES * noise or reach == 0.0:
        return None
    early, later = (_crossing(t, away, max(share * reach, NOISE_TIMES * noise)) for share in (EARLY, LATER))
    if early <= t[STILL - 1]:
        return None
    return max(float(t[0]), early - max(0.0, later - early) * EARLY / (LATER - EARLY))


def _crossing(t: Array, away: Array, level: float) -> float:
    """The first instant at which a column is beyond a level; between two readings by a line, unless it jumps."""
    i = int(np.flatnonzero(away >= level)[0])
    if i == 0:
        return float(t[0])
    share = (level - away[i - 1]) / (away[i] - away[i - 1])
    return float(t[i - 1] + share * (t[i] - t[i - 1]))


def merged(table: DataTable, time: str, others: Mapping[str, tuple[DataTable, str, float]], where: str) -> DataTable:
    """The main table with those of other recorders beside it, on all instants (in the main clock).

    others : recorder -> (table, its time column, seconds to add to its clock); columns that exist already are refused
    """
    clocks = {name: other[clock] + shift for name, (other, clock, shift) in others.items()}
    instants = np.unique(np.concatenate([table[time], *clocks.values()]))
    cells = {time: instants, **{c: _at(instants, table[time], table[c]) for c in table.columns if c != time}}
    for name, (other, clock, _) in others.items():
        for column in other.columns:
            if column in cells and column != clock:
                raise InputError(
                    f"column '{column}' is recorded twice", f"{where} [recorders.{name}]", "columns of other names"
                )
        cells |= {c: _at(instants, clocks[name], other[c]) for c in other.columns if c != clock}
    return DataTable(cells)


def _at(instants: Array, time: Array, column: Column) -> Column:
    """A column on all instants, empty where it was not sampled."""
    kind = column.dtype.kind
    out = np.full(instants.size, EMPTY.get(kind), column.dtype if kind in EMPTY else object)
    out[np.searchsorted(instants, time)] = column
    return out
