"""Faults of the measurement that need no model: frozen, clipped and impossible channels."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from validation.case import Channel, Test

FROZEN_SHARE = 0.25
MOVING_K = 3.0


def longest_run(y: NDArray[np.float64]) -> int:
    """Length of the longest stretch of equal readings."""
    change = np.flatnonzero(np.diff(y) != 0.0)
    edges = np.concatenate([[-1], change, [y.size - 1]])
    return int(np.max(np.diff(edges)))


def fault(test: Test, channel: Channel) -> str | None:
    """What is plainly wrong with a channel, or None."""
    y = channel.y[np.isfinite(channel.y)]
    if y.size < 8:
        return None
    if y.min() < -60.0 or y.max() > 400.0:
        return f"{channel.name} in {test.name} reads {y.min():.0f} to {y.max():.0f} degC: a wrong unit?"
    others = [np.nanmax(c.y) - np.nanmin(c.y) for c in test.channels if c is not channel and np.isfinite(c.y).any()]
    run = longest_run(y)
    moving = others and np.median(others) > MOVING_K
    if run > FROZEN_SHARE * y.size and moving:
        where = "at its limit" if y[np.argmax(y)] == stuck(y, run) and np.ptp(y) > MOVING_K else "frozen"
        return f"{channel.name} in {test.name} is {where} for {100 * run / y.size:.0f} % of the test"
    return None


def stuck(y: NDArray[np.float64], run: int) -> float:
    """The value that is held during the longest run."""
    change = np.concatenate([[-1], np.flatnonzero(np.diff(y) != 0.0), [y.size - 1]])
    return float(y[change[int(np.argmax(np.diff(change)))] + 1])


def broken_channels(tests: Iterable[Test]) -> list[str]:
    """All plain faults, in words."""
    found = [fault(test, channel) for test in tests for channel in test.channels]
    return [f for f in found if f]
