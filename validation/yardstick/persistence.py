"""The models that know nothing: every sensor stays as it began, or keeps its usual distance from a boundary."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array
from validation.yardstick.records import Record


@dataclass(frozen=True)
class Persistence:
    """boundary : the column whose temperature the sensors follow, None where they stay;  rise (n_sensor,) K above it"""

    boundary: int | None
    rise: Array

    def run(self, record: Record) -> Array:
        """(n, n_sensor) degC"""
        if self.boundary is None:
            return np.broadcast_to(record.T[0], record.T.shape)
        return record.boundary[:, [self.boundary]] + self.rise


def usual_rise(records: Sequence[Record], boundary: int | None) -> Persistence:
    """The model of some records."""
    if boundary is None:
        return Persistence(None, np.empty(0))
    each = [np.where(r.read, r.T - r.boundary[:, [boundary]], 0.0).sum(axis=0) * r.step for r in records]
    read = [r.read.sum(axis=0) * r.step for r in records]
    return Persistence(boundary, np.sum(each, axis=0) / np.maximum(np.sum(read, axis=0), 1e-300))
