"""Standard duty types (IEC 60034-1) as load factors over time; a time given twice is a jump."""

from itertools import pairwise

import numpy as np

from geom.arrays import Array


def _blocks(edges: Array, levels: Array, step: float) -> tuple[Array, Array]:
    """Times (s) not further apart than `step`, every edge twice, and the level of each block."""
    spans = [np.linspace(a, b, max(2, int(np.ceil((b - a) / step)) + 1)) for a, b in pairwise(edges)]
    return np.concatenate(spans), np.concatenate([np.full(len(s), v) for s, v in zip(spans, levels, strict=True)])


def s1(duration: float, step: float = 10.0) -> tuple[Array, Array]:
    """Continuous: load 1 for `duration` (s)."""
    return _blocks(np.array([0.0, duration]), np.array([1.0]), step)


def s2(on: float, rest: float, step: float = 10.0) -> tuple[Array, Array]:
    """Short-time: load 1 for `on`, then at rest (s)."""
    return _blocks(np.array([0.0, on, on + rest]), np.array([1.0, 0.0]), step)


def s3(period: float, duty: float, cycles: int, step: float = 10.0, idle: float = 0.0) -> tuple[Array, Array]:
    """Intermittent periodic: load 1 for duty * period (s), `idle` for the rest, `cycles` times; duty 0 to 1."""
    starts = period * np.arange(cycles)
    edges = np.append(np.column_stack([starts, starts + duty * period]).ravel(), period * cycles)
    return _blocks(edges, np.tile([1.0, idle], cycles), step)


def s6(period: float, duty: float, cycles: int, no_load: float, step: float = 10.0) -> tuple[Array, Array]:
    """Continuous operation, periodic load: like S3, running at the share `no_load` in between."""
    return s3(period, duty, cycles, step, no_load)
