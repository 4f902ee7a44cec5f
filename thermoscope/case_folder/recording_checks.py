"""What looks wrong in one recording by itself: units, clock, spikes, sensors that stand still or were hardly read."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from geom.arrays import Array, Mask
from geom.constants import ZERO_C
from geom.table import TableRow
from geom.text import counted
from measured.recordings.readings import START_S
from measured.recordings.sheet import Sheet
from measured.recordings.tables import Samples

FIRST = 5  # readings that say where a column starts
OFF_K = 15.0  # how near a start has to be to that of the others in another unit
OFFSET_K = 12.0  # how far it has to be as it stands
SPIKE_K, SPIKE_TIMES = 8.0, 20.0  # a reading that leaps and comes back, in K and in usual steps of its column
SLOW_S, MOVES = 120.0, 0.1  # between rows, in which a winding may warm and cool; share of a range that is a move
UNEVEN = 0.5  # of a long step of a clock, between nine in ten and one in ten of all
WARM_K = 3.0  # a test in which nothing warms by more shows nothing
LEAST_READINGS = 3  # of a sensor in a test, as of rows


@dataclass(frozen=True)
class Finding(TableRow):
    """test : "" for the case as a whole;  where : column, input or node;  cure : what to do about it

    remark : may well be as meant
    """

    test: str
    where: str
    what: str
    cure: str
    remark: bool = False


@dataclass(frozen=True)
class Patient:
    """One test as it was read."""

    name: str
    sheet: Sheet
    samples: Samples

    @property
    def temperatures(self) -> dict[str, Array]:
        return {c.name: self.samples.values[c.name] for c in self.sheet.columns if c.is_temperature}

    @property
    def inputs(self) -> dict[str, Array]:
        """Input -> its readings, of all columns that feed one."""
        return {c.feeds: self.samples.values[c.name] for c in self.sheet.columns if c.feeds}

    def finding(self, where: str, what: str, cure: str) -> Finding:
        return Finding(self.name, where, what, cure)


def first_readings(p: Patient) -> dict[str, float]:
    """Column -> what its first readings say (degC), where one is as early as a start has to be."""
    rows = int(np.sum(p.samples.time <= START_S))
    early = {n: v for n, v in p.temperatures.items() if np.isfinite(v[:rows]).any()}
    return {n: float(np.median(v[np.isfinite(v)][:FIRST])) for n, v in early.items()}


def _units(p: Patient) -> Iterator[Finding]:
    """A column that starts where the others would in kelvin or Fahrenheit; the latter only beside others at rest."""
    starts = first_readings(p)
    for name, start in starts.items():
        others = [s for n, s in starts.items() if n != name]
        usual = float(np.median(others)) if others else 20.0
        if abs(start - usual) < OFFSET_K:
            continue
        if abs(start - ZERO_C - usual) < OFF_K:
            yield p.finding(name, f"starts at {start:.0f} degC, the others at {usual:.0f}: kelvin?", 'unit = "K"')
        elif abs((start - 32.0) / 1.8 - usual) < OFF_K / 3 and np.ptp(others or [usual]) < OFFSET_K:
            what = f"starts at {start:.0f} degC, the others at {usual:.0f}: Fahrenheit?"
            yield p.finding(name, what, 'unit = "degF"')


def _sparse(p: Patient) -> Iterator[Finding]:
    """Sensors that were hardly read."""
    after = {c.name for c in p.sheet.columns if c.electrical is not None}  # one reading says the end, and is meant so
    for name, values in p.temperatures.items():
        count = int(np.isfinite(values).sum())
        if count < LEAST_READINGS and name not in after:
            what = f"was read {counted(count, 'time')} in the whole test: that says next to nothing of the model"
            yield p.finding(name, what, "readings over the test, or use = false")


def _clock(p: Patient) -> Iterator[Finding]:
    low, high = np.percentile(np.diff(p.samples.time), [10.0, 90.0])
    if high - low > UNEVEN * high:
        cure = "check the recorder's clock; readings are averaged onto the grid as they stand"
        yield p.finding("clock", f"rows come unevenly, {low:g} to {high:g} s apart", cure)
    for a, b in p.samples.gaps:
        yield p.finding("clock", f"no rows from {a:g} to {b:g} s", "split the test there if the machine ran on")


def _spikes(p: Patient) -> Iterator[Finding]:
    """Single readings that leap and come back at once."""
    for name, values in p.temperatures.items():
        finite = np.flatnonzero(np.isfinite(values))
        if finite.size < 10:
            continue
        y = values[finite]
        leap = np.minimum(np.abs(y[1:-1] - y[:-2]), np.abs(y[1:-1] - y[2:]))
        back = np.abs(y[2:] - y[:-2]) < 0.5 * leap
        between = 0.5 * (p.samples.time[finite[2:]] - p.samples.time[finite[:-2]])
        back &= (between < SLOW_S) | ~_moved(p, name)[finite[1:-1]]
        out = np.flatnonzero(back & (leap > max(SPIKE_K, SPIKE_TIMES * float(np.median(np.abs(np.diff(y)))))))
        if out.size:
            at = p.samples.time[finite[out[0] + 1]]
            what = f"{out.size} readings leap by {leap[out].max():.0f} K and come back, first at {at:g} s"
            yield p.finding(name, what, "empty those cells; look for a loose contact")


def _moved(p: Patient, name: str) -> Mask:
    """Rows (n,) at which another column of a test without inputs, or an input, leaps and comes back too."""
    out = np.full(p.samples.time.size, not p.inputs)
    for other, values in p.samples.values.items():
        step = np.diff(values)
        far = np.abs(step) > MOVES * float(np.nanmax(values) - np.nanmin(values))
        out[1:-1] |= (other != name) & far[:-1] & far[1:] & (step[:-1] * step[1:] < 0.0)
    return out


def _twins(p: Patient) -> Iterator[Finding]:
    """Columns with the very same readings."""
    values = {c.name: p.samples.values[c.name] for c in p.sheet.columns}
    for a, b in combinations(values, 2):
        x, y = values[a], values[b]
        if np.array_equal(x, y, equal_nan=True) and np.unique(x[np.isfinite(x)]).size > 2:
            yield p.finding(f"{a}, {b}", "are the same readings throughout", "one of them; check the logger's channels")


RECORDING_CHECKS = (_units, _sparse, _clock, _spikes, _twins)
