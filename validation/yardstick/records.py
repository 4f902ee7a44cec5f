"""Tests as plain tables on one list of sensors: what a model that knows no machine can learn from."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array, Mask
from measured.case import Test, seconds_read

MOST_ROWS = 40_000  # of all tests together: twice as many teach little more and double the wait
MOST_WORK = 1e11  # multiplications of all fits together: some 20 s on one core
FEWEST_ROWS = 2_000  # of all tests together: fewer would not show what happens within a test
FEW_SENSORS = 10  # with more of them fewer inputs are looked at: terms grow as their product
MOST_INPUTS, FEW_INPUTS = 8, 5
FITS = 9.0  # of every sensor, counted in the longest of them: eight laws, and windows that overlap less and less
MIDDLE = 40  # windows of a test over which an input is held against how fast sensors move


@dataclass(frozen=True)
class Columns:
    """What stands in the columns of every table.

    sensors : names of the channels;  steady : (n_sensor,) those that every test reads: they may drive others
    boundaries, inputs : names;  scale : (n_input,) largest size of each input in the tests that may be learnt from
    """

    sensors: tuple[str, ...]
    steady: Mask
    boundaries: tuple[str, ...]
    inputs: tuple[str, ...]
    scale: Array


@dataclass(frozen=True)
class Record:
    """One test, or a stretch of one, as a table.

    time (n,) s;  T (n, n_sensor) degC with gaps filled, and read (n, n_sensor): where something was read
    boundary (n, n_boundary) degC;  u (n, n_input) the inputs over their scale
    """

    name: str
    time: Array
    T: Array
    read: Mask
    boundary: Array
    u: Array

    @property
    def step(self) -> float:
        """Usual time between its rows (s): what each counts beside those of other tests."""
        return seconds_read(self.time) / len(self.time)

    def rows(self, window: float) -> int:
        """Rows of a window (s): at least one, and at most a third of all."""
        return int(np.clip(round(window / self.step), 1, max((len(self.time) - 1) // 3, 1)))

    def stretch(self, begin: int, end: int) -> "Record":
        """The rows from begin to end as a record of their own."""
        rows = slice(begin, end)
        return Record(self.name, self.time[rows], self.T[rows], self.read[rows], self.boundary[rows], self.u[rows])


Folds = Sequence[Sequence[Record]]  # what is left out at a time


def table_columns(fitted: Sequence[Test], every: Sequence[Test]) -> Columns:
    """The columns of the tests that may be learnt from; a sensor that some test lacks drives no other."""
    sensors = tuple(dict.fromkeys(c.name for t in fitted for c in t.channels if np.isfinite(c.y).any()))
    read = [{c.name for c in t.channels if np.isfinite(c.y).any()} for t in every]
    steady = np.array([all(name in names for names in read) for name in sensors], bool)
    boundaries = _in_all([t.boundaries for t in every])
    most = MOST_INPUTS if len(sensors) <= FEW_SENSORS else FEW_INPUTS
    present = [n for n in _in_all([t.inputs for t in every]) if any(np.any(t.inputs[n]) for t in fitted)]
    inputs = _telling(present, fitted, most)
    scale = np.array([max(float(np.max(np.abs(t.inputs[n]))) for t in fitted) for n in inputs])
    return Columns(sensors, steady, boundaries, inputs, scale)


def _telling(names: Sequence[str], tests: Sequence[Test], most: int) -> tuple[str, ...]:
    """Of many inputs those that say most of how fast the sensors move, each beside those that were chosen before it.

    Three columns of one current say no more than one of them; the speed beside it does.
    """
    if len(names) <= most:
        return tuple(names)
    sizes: dict[str, list[Array]] = {name: [] for name in names}
    rates = []
    for test in tests:
        ends = np.unique(np.linspace(0, test.time.size - 1, MIDDLE + 1).astype(int))
        y = np.column_stack([_filled(test.time, c.y)[ends] for c in test.channels if c.name in _read(tests)])
        rates.append(np.diff(y, axis=0))
        for name in names:
            size = np.abs(np.asarray(test.inputs[name], float))
            sizes[name].append(np.diff(np.cumsum(np.column_stack([size, size**2]), axis=0)[ends], axis=0))
    left = _standard(np.concatenate(rates))
    columns = {name: _standard(np.concatenate(u)) for name, u in sizes.items()}
    selection: list[str] = []
    for _ in range(most):
        gains = {}
        for name in (n for n in names if n not in selection):
            q, r = np.linalg.qr(columns[name])
            alive = np.abs(np.diag(r)) > 1e-9 * max(float(np.abs(r).max()), 1e-300)
            gains[name] = float(np.sum((q[:, alive].T @ left) ** 2))
        best = max(gains, key=lambda name: gains[name])
        q, _ = np.linalg.qr(columns[best])
        left = left - q @ (q.T @ left)
        columns = {name: u - q @ (q.T @ u) for name, u in columns.items()}
        selection.append(best)
    return tuple(name for name in names if name in selection)


def _read(tests: Sequence[Test]) -> set[str]:
    """Sensors that all tests have."""
    return set.intersection(*({c.name for c in t.channels} for t in tests))


def _standard(table: Array) -> Array:
    """Columns of mean 0 and standard deviation 1; 0 where nothing moves."""
    centred = table - table.mean(axis=0)
    return centred / np.maximum(centred.std(axis=0), 1e-300)


def _in_all(tables: Sequence[Iterable[str]]) -> tuple[str, ...]:
    return tuple(name for name in tables[0] if all(name in table for table in tables))


def row_step(tests: Sequence[Test], columns: Columns) -> int:
    """How many rows become one, so that all tests together stay below MOST_ROWS and all fits below MOST_WORK."""
    inputs, sensors = len(columns.inputs), len(columns.sensors)
    links = (int(columns.steady.sum()) + len(columns.boundaries)) * (1 + 2 * inputs)
    terms = links + 1 + 2 * inputs + 2 * inputs * (inputs - 1)
    affordable = max(MOST_WORK / (2.0 * FITS * sensors * terms**2), FEWEST_ROWS)
    return -(-sum(t.time.size for t in tests) // int(min(affordable, MOST_ROWS)))


def table_record(test: Test, columns: Columns, step: int = 1) -> Record:
    """A test as a table, every `step` rows averaged into one."""
    n = test.time.size // step * step
    by_name = {c.name: c.y for c in test.channels}
    absent = np.full(test.time.size, np.nan)
    y = np.column_stack([by_name.get(name, absent) for name in columns.sensors])
    full = np.column_stack([_filled(test.time, column) for column in y.T])
    around = [np.broadcast_to(np.asarray(test.boundaries[b], float), test.time.shape) for b in columns.boundaries]
    inputs = [np.asarray(test.inputs[i], float) / s for i, s in zip(columns.inputs, columns.scale, strict=True)]

    def mean(table: Array) -> Array:
        return table[:n].reshape(n // step, step, *table.shape[1:]).mean(axis=1)

    empty = np.empty((test.time.size, 0))
    boundary, u = np.column_stack([empty, *around]), np.column_stack([empty, *inputs])
    read = np.isfinite(y)[:n].reshape(n // step, step, y.shape[1]).any(axis=1)
    return Record(test.name, mean(test.time), mean(full), read, mean(boundary), mean(u))


def _filled(time: Array, y: Array) -> Array:
    """Readings with straight lines over their gaps; all zero where there are none."""
    read = np.isfinite(y)
    return np.interp(time, time[read], y[read]) if read.any() else np.zeros_like(time)
