"""Residuals and Jacobians of all tests, channel by channel, averaged to a few hundred instants."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.network import Network, Parameter
from validation.case import Channel, Test
from validation.predict import predict

Array = NDArray[np.float64]
INSTANTS = 180
MODEL_SHARE = 0.02  # a model within 4 % of the rise counts as good: that is two standard deviations
NUMBERS = 2**25  # of a Jacobian held at once: 270 MB
WORTH_A_THREAD = 3000  # states times instants below which starting threads costs more than it saves


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
    def weight(self) -> float:
        """How large a residual may be expected here (K), relative to the same channel in other tests."""
        return float(np.hypot(self.sigma_K, self.model_K))


def groups(nt: int, instants: int = INSTANTS) -> NDArray[np.int64]:
    """Start of each block when `nt` samples are averaged to at most `instants`."""
    return np.arange(0, nt, max(1, -(-nt // instants)))


def block_mean(a: Array, weight: Array, start: NDArray[np.int64]) -> tuple[Array, NDArray[np.bool_]]:
    """Weighted means of the blocks of a (n, ...), and which blocks hold at least half their samples."""
    w = weight.reshape(-1, *(1,) * (a.ndim - 1))
    total = np.add.reduceat(weight, start)
    full = total >= 0.5 * np.add.reduceat(np.ones_like(weight), start)
    mean = np.add.reduceat(np.where(w > 0, a, 0.0), start, axis=0)[full]
    return mean / total[full].reshape(-1, *(1,) * (a.ndim - 1)), full


def segments(
    network: Network,
    tests: Sequence[Test],
    values: Mapping[str, float],
    tangents: Sequence[Parameter] = (),
    instants: int = INSTANTS,
) -> list[Segment]:
    """Every channel of every test with residual and derivatives; tests run side by side (the kernel frees the GIL)."""

    def look(test: Test) -> list[Segment]:
        return _of_test(network, test, values, tangents, instants)

    if len(tests) < 2 or len(tests[0].time) * network.size < WORTH_A_THREAD:
        return [s for test in tests for s in look(test)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return [s for found in pool.map(look, tests) for s in found]


def _of_test(
    network: Network, test: Test, values: Mapping[str, float], tangents: Sequence[Parameter], instants: int
) -> list[Segment]:
    columns: list[list[Array]] = [[] for _ in test.channels]
    start = groups(len(test.time), instants)
    for k, some in enumerate(portions(tangents, len(test.time) * max(len(test.channels), 1))):
        seen = predict(network, test, values, some)
        for j, c in enumerate(test.channels):
            own = (
                [seen.J[:, j]] if k else [np.column_stack([test.time, np.nan_to_num(c.y) - seen.y[:, j]]), seen.J[:, j]]
            )
            columns[j] += [block_mean(a, np.isfinite(c.y).astype(float), start)[0] for a in own]
    read = [(c, np.column_stack(a)) for c, a in zip(test.channels, columns, strict=True) if np.isfinite(c.y).sum() >= 3]
    return [Segment(test.name, c.name, m[:, 0], m[:, 1], m[:, 2:], c.sigma_K, allowed(c)) for c, m in read]


def portions(tangents: Sequence[Parameter], each: int) -> list[Sequence[Parameter]]:
    """Tangents in portions that fit into memory, however long the record; `each` numbers are kept per tangent."""
    size = max(1, NUMBERS // max(each, 1))
    return [tangents[i : i + size] for i in range(0, len(tangents), size)] or [()]


def allowed(c: Channel) -> float:
    """Slow misfit (K) that a model of this kind may have at a channel: the sensor's own, or what the case says, and a
    share of the rise."""
    seen = c.y[np.isfinite(c.y)]
    return float(np.hypot(max(c.model_K, c.sigma_K), MODEL_SHARE * np.max(np.abs(seen - seen[0]))))


def stacked(parts: Sequence[Segment]) -> Array:
    """All residuals one after the other."""
    return np.concatenate([s.r for s in parts]) if parts else np.zeros(0)


def rmse(parts: Sequence[Segment]) -> float:
    """Root mean square residual (K) over all channels and tests."""
    return float(np.sqrt(np.mean(stacked(parts) ** 2))) if parts else float("nan")
