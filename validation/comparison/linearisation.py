"""Residuals and Jacobians of all tests, channel by channel, averaged to a few hundred instants."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array, Numbers
from lumped.integration.compiled import FIT
from lumped.model.network import Network, Parameter
from lumped.model.once import once
from measured.case import Channel, Test, seconds_read
from measured.doubt import USUAL
from measured.sensors.blocks import INSTANTS, Blocks, groups
from validation.comparison.predict import Watch
from validation.threads import run_by_run

NUMBERS = 2**22  # of a Jacobian looked at together: 34 MB, and some copies
SHORTEST = 500  # samples of a stretch


@dataclass(frozen=True)
class Segment:
    """One channel of one test.

    time : (n,) s;  r : (n,) measured minus predicted (K);  J : (n, p) d predicted / d parameter
    """

    test: str
    channel: str
    time: Array
    r: Array
    J: Array
    sigma_K: float
    model_K: float = 0.0

    @property
    def seconds(self) -> float:
        """The time that its readings stand for."""
        return seconds_read(self.time)

    @property
    def weight(self) -> float:
        """How large a residual may be expected here (K), relative to the same channel in other tests."""
        return float(np.hypot(self.sigma_K, self.model_K))


def segments(
    network: Network,
    tests: Sequence[Test],
    values: Numbers,
    tangents: Sequence[Parameter] = (),
    instants: int = INSTANTS,
    numbers: int = NUMBERS,
) -> list[Segment]:
    """Every channel of every test with residual and derivatives, as precise as a fit needs them.

    numbers : of a Jacobian in memory at once
    Tests run side by side, the longest first (the kernel frees the GIL).
    """

    def look(test: Test) -> list[Segment]:
        return _of_test(network, test, values, tangents, instants, numbers)

    return [s for each in run_by_run(look, tests, network.size) for s in each]


def _of_test(
    network: Network, test: Test, values: Numbers, tangents: Sequence[Parameter], instants: int, numbers: int
) -> list[Segment]:
    n, length = len(test.time), stretch(len(test.channels), len(tangents), numbers)
    watch, start = Watch(network, test, values, tangents, FIT), groups(n, instants)
    start = start if test.blocks is None else test.blocks
    means = [Blocks(start, 2 + len(tangents)) for _ in test.channels]
    for first in range(0, n, length):
        rows = slice(first, min(first + length, n))
        model = watch.until(rows.stop)
        for j, c in enumerate(test.channels):
            r = np.nan_to_num(c.y[rows]) - model.y[:, j]
            means[j].add(
                first, np.column_stack([test.time[rows], r, model.J[:, j]]), np.isfinite(c.y[rows]).astype(float)
            )
        del model  # before the next stretch takes as much
    read = [(c, b.means()) for c, b in zip(test.channels, means, strict=True) if np.isfinite(c.y).sum() >= 3]
    return [Segment(test.name, c.name, m[:, 0], m[:, 1], m[:, 2:], c.sigma_K, allowed(c)) for c, m in read]


def stretch(channels: int, tangents: int, numbers: int = NUMBERS) -> int:
    """Samples looked at together, so that a long test needs no more memory than a short one."""
    return int(max(numbers // (max(channels, 1) * (tangents + 1)), SHORTEST))


@once
def allowed(c: Channel) -> float:
    """Slow misfit (K) that a model of this kind may have at a channel: what the sensor wanders, or what the case says,
    and a share of the rise."""
    return float(np.hypot(max(c.model_K, USUAL["wander"] * c.sigma_K), USUAL["slow"] * largest_rise(c)))


def largest_rise(c: Channel) -> float:
    """How far (K) a channel's readings ever are from the first."""
    first = c.y[np.argmax(np.isfinite(c.y))]
    return max(float(np.nanmax(c.y) - first), float(first - np.nanmin(c.y)))


def stacked(parts: Sequence[Segment]) -> Array:
    """All residuals one after the other."""
    return np.concatenate([s.r for s in parts]) if parts else np.zeros(0)


def reach(parts: Sequence[Segment]) -> Array:
    """(p,) largest change of any reading (K) by one unit of each parameter."""
    return np.asarray(np.max([np.max(np.abs(s.J), axis=0) for s in parts], axis=0))


def rmse(parts: Sequence[Segment]) -> float:
    """Root mean square residual (K) of all channels and tests, each counted by the time that it was read."""
    squares = [np.mean(s.r**2) for s in parts]
    return float(np.sqrt(np.average(squares, weights=[s.seconds for s in parts]))) if parts else float("nan")
