"""When inputs stepped: anywhere between two rows of the record, so each step of them is early or late by chance."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geom.arrays import Array
from measured.case import Recorded, Test
from measured.doubt import USUAL

STEP = 0.1  # of an input's largest value: a smaller change between two rows is a hundredth of the variance of a step
MOST = 12  # moved by themselves in a test: of more, neighbours are moved together by what they come to
MOSTLY = 0.95  # of the rows with a step: three steps in the time of a row
EDGE = 1e-3  # of the time between two rows: how long a step takes


@dataclass(frozen=True, eq=False)
class InputStep:
    """Steps next to each other.

    row (k,) before each;  share (k,) of the time between two rows by which it may be late: one for a step by itself,
    of several their squares come to one. A fall is moved the other way, so that all do the same to the heat.
    wider : than when one step falls into that time
    """

    row: NDArray[np.int64]
    share: Array
    wider: float


def recorded_inputs(test: Test) -> tuple[Array, Mapping[str, Array]]:
    """Times (n,) s and inputs (n,) in their finest steps."""
    fine = test.recorded or test
    return fine.time, fine.inputs


def input_steps(test: Test) -> list[InputStep]:
    """The steps between rows of a test's inputs and, where these are no finer, of its boundaries; none where rows are
    so close that the clock is doubted by more."""
    time, inputs = recorded_inputs(test)
    if time.size < 2 or USUAL["step in sample"] * np.median(np.diff(time)) <= USUAL["clock"]:
        return []
    size = {n: float(np.max(np.abs(u))) for n, u in inputs.items()}
    change = [np.diff(u) / max(size[n], 1e-300) for n, u in inputs.items()]
    for u in () if test.recorded else test.boundaries.values():
        u = np.broadcast_to(np.asarray(u, float), time.shape)
        change.append(np.diff(u) / max(float(np.ptp(u)), USUAL["boundary"] / STEP))
    if not change:
        return []
    first = np.argmax(np.abs(change), axis=0)
    most = np.take_along_axis(np.array(change), first[None], axis=0)[0]
    rows = np.flatnonzero(np.abs(most) > STEP)
    groups = np.array_split(rows, min(MOST, rows.size)) if rows.size else []
    # steps by chance: where most rows have one, many have another level in between that no row shows
    hidden = -np.log1p(-min(rows.size / first.size, MOSTLY))
    wider = float(np.sqrt(1.0 + hidden))
    return [InputStep(g, most[g] / float(np.linalg.norm(most[g])), wider) for g in groups]


def with_steps(test: Test, steps: Sequence[InputStep], late: Collection[InputStep] = ()) -> Test:
    """The test with its inputs stepping as early between two rows as they may, but those as late; boundaries are more,
    or less, by what that comes to."""
    time, inputs = recorded_inputs(test)
    row = np.concatenate([s.row for s in steps])
    share = np.concatenate([s.share * (0.5 if s in late else -0.5) for s in steps])
    step_s = np.diff(time)[row]
    at, edge = 0.5 * (time[row] + time[row + 1]) + (1.0 - 4.0 * EDGE) * share * step_s, EDGE * step_s

    def finer(x: Array, before: Array, after: Array) -> Array:
        return np.insert(x, np.repeat(row + 1, 2), np.column_stack([before, after]).ravel())

    def moved(u: Array) -> Array:
        u = np.broadcast_to(np.asarray(u, float), time.shape)
        less, out = 0.5 * share * np.diff(u)[row], u.copy()
        np.subtract.at(out, row, less)
        np.subtract.at(out, row + 1, less)
        return out

    fine = {n: finer(u, u[row], u[row + 1]) for n, u in inputs.items()}
    boundaries = test.boundaries if test.recorded else {n: moved(u) for n, u in test.boundaries.items()}
    recorded = Recorded(finer(time, at - edge, at + edge), fine, test.time, {n: test.inputs[n] for n in fine})
    return replace(test, recorded=recorded, boundaries=boundaries)
