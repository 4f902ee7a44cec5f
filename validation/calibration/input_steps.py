"""When inputs stepped: anywhere between two rows of the record, so each step of them is early or late by chance."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geom.arrays import Array, Ints
from measured.case import Recorded, Test
from measured.doubt import USUAL

STEP = 0.1  # of an input's largest value: a smaller change between two rows is a hundredth of the variance of a step
MOST = 48  # moved by themselves in a test, and so many hidden ones: of more, neighbours are moved together
FEW, LARGE = 8, 30  # so many in a network of more states than that: each costs a run of the model
MOSTLY = 0.95  # of the rows with a step: three steps in the time of a row
EDGE = 1e-3  # of the time between two rows: how long a step takes


@dataclass(frozen=True, eq=False)
class InputStep:
    """Steps next to each other that show, or what an input may have been between two rows without a trace.

    row (k,) before each;  share (k,) of the time between two rows by which it may be late: one for a step by itself,
    of several their squares come to one. A fall is moved the other way, so that all do the same to the heat.
    hidden : an input of which nothing shows;  share is then what it may have been more, in its unit
    """

    row: Ints
    share: Array
    hidden: str = ""

    @property
    def what(self) -> str:
        """In words."""
        return f"{self.hidden} between rows" if self.hidden else "input steps"


def recorded_inputs(test: Test) -> tuple[Array, Mapping[str, Array]]:
    """Times (n,) s and inputs (n,) in their finest steps."""
    fine = test.recorded or test
    return fine.time, fine.inputs


def input_steps(test: Test, states: int = 0) -> list[InputStep]:
    """The steps between rows of a test's inputs and, where these are no finer, of its boundaries; none where rows are
    so close that the clock is doubted by more.

    states : of the network that is run for each
    """
    time, inputs = recorded_inputs(test)
    if time.size < 2 or USUAL["step in sample"] * np.median(np.diff(time)) <= USUAL["clock"]:
        return []
    largest = {n: max(float(np.max(np.abs(u))), 1e-300) for n, u in inputs.items()}
    change = {n: np.diff(u) / largest[n] for n, u in inputs.items()}
    around = {}
    for n, u in {} if test.recorded else test.boundaries.items():
        u = np.broadcast_to(np.asarray(u, float), time.shape)
        around[n] = np.diff(u) / max(float(np.ptp(u)), USUAL["boundary"] / STEP)
    every = np.array([*change.values(), *around.values()])
    if not every.size:
        return []
    first = np.argmax(np.abs(every), axis=0)
    most = np.take_along_axis(every, first[None], axis=0)[0]
    rows = np.flatnonzero(np.abs(most) > STEP)
    hidden = {n: size for n, d in change.items() if (size := _hidden_size(d)) > STEP}
    limit = FEW if states > LARGE else MOST
    each = max(limit // max(len(hidden), 1), FEW)
    groups = np.array_split(rows, min(limit, rows.size)) if rows.size else []
    between = np.array_split(np.arange(time.size - 1), min(each, time.size - 1))
    return [
        *(InputStep(g, most[g] / float(np.linalg.norm(most[g]))) for g in groups),
        *(
            InputStep(g, np.full(g.size, largest[n] * size / np.sqrt(g.size)), n)
            for n, size in hidden.items()
            for g in between
        ),
    ]


def _hidden_size(change: Array) -> float:
    """What an input may have been more between two rows, of its largest value, as its changes between rows are.

    Where steps come by chance, a row that shows one has more, as of a Poisson process. Where they keep a distance, that
    is where fewer than by chance are next to each other, they have fewer.
    """
    stepped = np.abs(change) > STEP
    often = float(np.mean(stepped))
    if stepped.size < 2 or often == 0.0:
        return 0.0
    side = float(np.mean(stepped[1:] & stepped[:-1]))
    more = -float(np.log1p(-min(often, MOSTLY))) * min(1.0, side / often**2)
    return float(np.sqrt(more * np.mean(np.where(stepped, change, 0.0) ** 2)))


def with_steps(test: Test, steps: Sequence[InputStep], late: Collection[InputStep] = ()) -> Test:
    """The test with its inputs stepping as early between two rows as they may, but those as late; boundaries are more,
    or less, by what that comes to."""
    row = np.concatenate([s.row for s in steps])
    share = np.concatenate([s.share * (0.5 if s in late else -0.5) for s in steps])
    time, inputs = recorded_inputs(test)

    def moved(u: Array) -> Array:
        u = np.broadcast_to(np.asarray(u, float), time.shape)
        less, out = 0.5 * share * np.diff(u)[row], u.copy()
        np.subtract.at(out, row, less)
        np.subtract.at(out, row + 1, less)
        return out

    at = 0.5 * (time[row] + time[row + 1]) + (1.0 - 4.0 * EDGE) * share * np.diff(time)[row]
    edge = EDGE * np.diff(time)[row]
    between = {n: (u[row], u[row + 1]) for n, u in inputs.items()}
    boundaries = test.boundaries if test.recorded else {n: moved(u) for n, u in test.boundaries.items()}
    return replace(_finer(test, row, (at - edge, at + edge), between), boundaries=boundaries)


def with_more(test: Test, step: InputStep) -> Test:
    """The test with more of an input between two rows than both of them show."""
    time, inputs = recorded_inputs(test)
    before, after = time[step.row], time[step.row + 1]
    at = before + EDGE * (after - before), after - EDGE * (after - before)
    between = {n: (u[step.row], u[step.row + 1]) for n, u in inputs.items()}
    between[step.hidden] = tuple(u + step.share for u in between[step.hidden])  # type: ignore[assignment]
    return _finer(test, step.row, at, between)


def _finer(test: Test, row: Ints, at: tuple[Array, Array], between: Mapping[str, tuple[Array, Array]]) -> Test:
    """The test with two more instants (s) behind some rows, and what its inputs are there."""
    time, inputs = recorded_inputs(test)

    def finer(x: Array, new: tuple[Array, Array]) -> Array:
        return np.insert(x, np.repeat(row + 1, 2), np.column_stack(new).ravel())

    fine = {n: finer(u, between[n]) for n, u in inputs.items()}
    recorded = Recorded(finer(time, at), fine, test.time, {n: test.inputs[n] for n in fine})
    return replace(test, recorded=recorded)
