"""A linear black box: how much each sensor moves in a while, by ridge on all that was drive at its begin."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array, Ints, Mask, sample_columns
from validation.yardstick.free_network import loss_factors
from validation.yardstick.records import Columns, Folds, Record


@dataclass(frozen=True)
class BlackBox:
    """T(t + h) - T(t) = [T, boundaries, products of inputs over the window, 1] W.

    window : s;  steady (n_sensor,): the sensors it reads;  weights (n_feature, n_sensor)
    """

    window: float
    steady: Mask
    weights: Array

    def run(self, record: Record) -> Array:
        """(n, n_sensor) degC from the first reading on, straight lines between ends of windows; inf if it runs away."""
        ends = window_ends(len(record.time), record.rows(self.window))
        drive = driven(record, ends)
        T = np.empty((ends.size, record.T.shape[1]))
        T[0] = record.T[0]
        k = int(self.steady.sum())
        with np.errstate(over="ignore", invalid="ignore"):
            for i, row in enumerate(drive @ self.weights[k:]):
                T[i + 1] = T[i] + T[i, self.steady] @ self.weights[:k] + row
        T = np.nan_to_num(T, nan=np.inf, posinf=np.inf, neginf=np.inf)
        return sample_columns(record.time, record.time[ends], T)


def window_ends(rows: int, window: int) -> Ints:
    """First row of every window, and the last row."""
    return np.append(np.arange(0, rows - 1, window), rows - 1)


def driven(record: Record, ends: Ints) -> Array:
    """(n_window, n): what drives each window, as means over it times its share of a whole one."""
    drivers = np.column_stack([record.boundary, loss_factors(record.u)])
    size = np.diff(ends)
    means = np.add.reduceat(drivers, ends[:-1], axis=0)[: size.size] / np.append(size[:-1], size[-1] + 1)[:, None]
    return np.asarray(means, float)


@dataclass(frozen=True)
class BlackBoxLessons:
    """What each fold of records teaches: the normal equations of the black box.  AA, Ab : per fold"""

    window: float
    columns: Columns
    AA: Sequence[Array]
    Ab: Sequence[Array]

    @staticmethod
    def of(folds: Folds, columns: Columns, window: float) -> "BlackBoxLessons":
        def taught(record: Record) -> tuple[Array, Array]:
            ends = window_ends(len(record.time), record.rows(window))
            A = np.column_stack([record.T[ends[:-1]][:, columns.steady], driven(record, ends)])
            whole = slice(0, max(len(A) - 1, 1))  # the last window is short
            b = np.diff(record.T[ends], axis=0)[whole]
            return A[whole].T @ A[whole], A[whole].T @ b

        pairs = [[np.sum(part, axis=0) for part in zip(*map(taught, fold), strict=True)] for fold in folds]
        return BlackBoxLessons(window, columns, [AA for AA, _ in pairs], [Ab for _, Ab in pairs])

    def fit(self, lessons: Sequence[int], ridge: float) -> BlackBox:
        """ridge : added to the normal equations, over their diagonal"""
        AA = np.sum([self.AA[i] for i in lessons], axis=0)
        scale = np.sqrt(np.maximum(np.diag(AA), 1e-300))
        normal = AA / np.outer(scale, scale) + ridge * np.eye(len(AA))
        b = np.sum([self.Ab[i] for i in lessons], axis=0) / scale[:, None]
        return BlackBox(self.window, self.columns.steady, np.linalg.solve(normal, b) / scale[:, None])
