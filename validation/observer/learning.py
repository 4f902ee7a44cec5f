"""The process noise, calibrated on the calibration tests alone.

    W <- (k W0 + n <q q'>) / (k + n)

W0: from the table of doubt, worth k draws; <q q'>: second moment of the missing heat that a smoother under W finds with
all sensors of the tests, its own uncertainty included; n: time constants that the tests last. Sources: Shumway and
Stoffer 1982 (expectation, maximisation); inverse Wishart prior.

What heat a sensor at one place tells of another place may be chance. So each test is also run with the sensors at hand
alone, under the covariance of the other tests, and the covariance that predicts the withheld readings best is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from validation.case import Channel, Test
from validation.comparison.predict import record
from validation.observer.observer import Observer, Sample, observer
from validation.observer.process import Process
from validation.observer.process_noise import ProcessNoise, thinned

Array = NDArray[np.float64]
Progress = Callable[[str], None]
TIMES_S = (300.0, 600.0, 1200.0, 2400.0)  # from a winding's time constant to a machine's
ROUNDS = 3  # each brings the covariance three times closer


@dataclass(frozen=True)
class Moments:
    """Of each test: second moment of its missing heat (t, m, m) W2, and how many time constants it lasts (t,)."""

    moment: Array
    count: Array

    def without(self, i: int | None, table: Array) -> Array:
        """The covariance from all tests but one."""
        n = self.count.copy()
        if i is not None:
            n[i] = 0.0
        k = len(table) + 2.0
        return np.asarray((k * table + np.einsum("t,tij->ij", n, self.moment)) / (k + n.sum()))


def calibrated_noise(
    process: Process, tests: Sequence[Test], table: Array, at_hand: Sequence[str], progress: Progress
) -> ProcessNoise:
    """at_hand : names of the sensors that will be there. Without tests: the table, and a usual time constant."""
    best, least = ProcessNoise(table, TIMES_S[2]), np.inf
    for time_s in TIMES_S if tests else ():
        progress(f"process noise of {time_s:g} s")
        found = learned(process, tests, table, time_s)
        places = {c.place for t in tests for c in t.channels if c.name in at_hand}
        seen = np.array([b in places for b in process.bodies], bool)
        of_tests = [found.without(i, table) for i in range(len(tests))]
        all_tests = found.without(None, table)
        for each, whole in (
            ([table] * len(tests), table),
            (of_tests, all_tests),
            ([_apart(W, seen) for W in of_tests], _apart(all_tests, seen)),
        ):
            error = _withheld(process, tests, [ProcessNoise(W, time_s) for W in each], at_hand)
            if error < least:
                best, least = ProcessNoise(whole, time_s), error
    return best


def _apart(W: Array, seen: NDArray[np.bool_]) -> Array:
    """Heat where no sensor is at hand tells nothing of other heat."""
    both = np.outer(seen, seen)
    return np.where(both | np.eye(len(W), dtype=bool), W, 0.0)


def learned(process: Process, tests: Sequence[Test], table: Array, time_s: float) -> Moments:
    """Moments that have settled."""
    W = table
    for _ in range(ROUNDS):
        parts = [_moment(process, ProcessNoise(W, time_s), t, tests) for t in tests]
        lasts = np.array([float(t.time[-1] - t.time[0]) for t in tests])
        found = Moments(np.array(parts), lasts / (2.0 * time_s))
        W = found.without(None, table)
    return found


def _moment(process: Process, noise: ProcessNoise, test: Test, tests: Sequence[Test]) -> Array:
    n = process.slow.size
    _, samples = over(process, noise, test, [c.name for c in test.channels], usual_rise(tests), smooths=True)
    seconds = np.gradient(test.time)
    parts = [dt * (np.outer(x[n:], x[n:]) + P[n:, n:]) for dt, (x, P) in zip(seconds[::-1], smoothed(samples))]
    return np.asarray(np.sum(parts, axis=0) / seconds.sum())


def smoothed(samples: Sequence[Sample]) -> Iterator[tuple[Array, Array]]:
    """Mean (N,) and covariance (N, N) by all readings, the last sample first (Rauch, Tung and Striebel 1965)."""
    last = samples[-1]
    x, P = last.mean, last.S @ last.S.T
    yield x, P
    for here, after in zip(samples[-2::-1], samples[:0:-1], strict=True):
        mean, root = after.predicted
        own, ahead = here.S @ here.S.T, root @ root.T
        gain = np.linalg.solve(ahead, after.transition @ own).T
        x, P = here.mean + gain @ (x - mean), own + gain @ (P - ahead) @ gain.T
        yield x, P


def _withheld(process: Process, tests: Sequence[Test], noise: Sequence[ProcessNoise], at_hand: Sequence[str]) -> float:
    """Mean square error (K2) at the sensors that are not at hand; where all are, of the predicted next readings."""
    square: list[Array] = []
    for test, own in zip(tests, noise, strict=True):
        one, samples = over(process, own, test, at_hand, usual_rise(tests))
        rest = [c for c in test.channels if c.name not in at_hand]
        square += [(c.y - _at(c, samples)) ** 2 for c in rest] or [np.array([-one.likelihood / test.time.size])]
    return float(np.nanmean(np.concatenate(square)))


def _at(c: Channel, samples: Sequence[Sample]) -> Array:
    return np.array([s.at(c.row)[0] for s in samples])


def over(
    process: Process, noise: ProcessNoise, test: Test, at_hand: Sequence[str], rise_K: float, smooths: bool = False
) -> tuple[Observer, list[Sample]]:
    """An observer after a test, and its samples."""
    test = thinned(test)
    given, sensors = record(test, {}), [c for c in test.channels if c.name in at_hand]
    y = np.column_stack([c.y for c in sensors]) if sensors else np.empty((test.time.size, 0))
    around = {b: float(np.asarray(u, float).flat[0]) for b, u in given.boundaries.items()}
    one = observer(process, noise, noise.sd, sensors, y[0], around, rise_K)
    one.filter.smooths = smooths
    return one, list(one.follow(given, y))


def usual_rise(tests: Sequence[Test]) -> float:
    """Root mean square (K) of what the sensors of some tests read above the surroundings."""
    rises = list(_rises(tests))
    return float(np.sqrt(np.nanmean(np.concatenate(rises) ** 2))) if rises else 0.0


def _rises(tests: Sequence[Test]) -> Iterator[Array]:
    for t in tests:
        around = np.mean([np.broadcast_to(u, t.time.shape) for u in t.boundaries.values()], axis=0)
        for c in t.channels:
            yield c.y - around
