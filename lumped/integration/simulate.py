"""Run a network over a record, with exact tangents of the discrete scheme.

run = simulate(network, Record(time, inputs, boundaries, initial), values, rows, tangents)
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from geom.arrays import Array, Ints
from geom.errors import InputError, NoSolution
from geom.table import Table, TableResult
from geom.text import counted
from lumped.integration.compiled import RUN, Compiled, Precision, compiled, hidden_states, reordered
from lumped.integration.reach import Reach
from lumped.integration.record import Record, instants
from lumped.integration.runaway import failure
from lumped.model.network import Network, Parameter, Row
from lumped.numerics import kernel
from lumped.numerics.dense import factored
from lumped.numerics.stages import EULER, GAMMA, Steps, stages, work
from lumped.numerics.steady_start import solve_steady_start
from lumped.numerics.tangents import differentiate
from lumped.numerics.terms import Forcing

PORTION = 4096  # steps whose states are kept for their tangents
FACTORS = 2**18  # numbers of the LU of those steps, which their tangents take too: 2 MB, what a core has for itself


@dataclass(frozen=True)
class Stand:
    """Where a run stands at its end, and another may begin: x (n_states,) degC, D (n_states + n_boundaries,
    n_tangents).

    step : the step wanted next (s);  coldest : of all so far (degC)
    """

    x: Array
    D: Array
    step: float
    coldest: float


@dataclass(frozen=True)
class Run(TableResult):
    """time (nt,); z (nt, n_states + n_boundaries) degC if kept; y (nt, n_rows); dy (nt, n_rows, n_tangents).

    end : for a run that goes on;  steps : those it took;  path : (n_steps, n_states) where each ended, if kept
    finer : of `simulate`, the same run with next to nothing left of its error
    """

    time: Array
    z: Array | None
    y: Array
    dy: Array | None
    end: Stand
    steps: Steps
    path: Array | None = None
    finer: "Callable[[], Run]" = None  # type: ignore[assignment]

    @property  # one that is cached has, before Python 3.12, one lock for all runs: threads would wait for each other
    def time_error_K(self) -> Array:
        """(n_rows,) the largest error of every output that steps and parabolas through inputs leave (K), from that run.

        It takes some three times as long as the run itself, whenever it is asked for.
        """
        return np.asarray(np.abs(self.y - self.finer().y).max(axis=0, initial=0.0))

    def tables(self) -> tuple[Table, ...]:
        """Every output over time, in the order in which they were asked for."""
        names = [f"output {j} (degC)" for j in range(self.y.shape[1])]
        rows = np.column_stack([self.time, self.y]).tolist()
        return (Table("Outputs over time", ["time (s)", *names], rows),)

    def __repr__(self) -> str:
        outputs, steps = counted(self.y.shape[1], "output"), counted(self.steps.knot.size, "step")
        return f"<Run over {instants(self.time)}; {outputs}, {steps}>"


def initial_state(network: Network, initial: float | Mapping[str, float]) -> Array:
    """Mean nodes and fluids at the given temperature, hidden shapes "PART#k" at 0 (they have no mean).

    Nodes without heat capacity then take the temperature at which they balance.

    Per place: nodes by name (or by a place on them), the others at the mean of the given ones.
    """
    hidden = hidden_states(network)
    if not isinstance(initial, Mapping):
        return np.where(hidden, 0.0, float(initial))
    by_column: dict[int, list[float]] = {}
    for name, value in initial.items():
        node = network.places[name].part if name not in network.states and name in network.places else name
        column = network.column(node)
        if column < len(network.states):
            by_column.setdefault(column, []).append(float(value))
    if not by_column:
        raise InputError("no state has an initial temperature", "record.initial", "a number, or at least one node")
    x = np.where(hidden, 0.0, np.mean([np.mean(v) for v in by_column.values()]))
    for column, values in by_column.items():
        x[column] = np.mean(values)
    return x


def start_state(network: Network, record: Record) -> Array:
    """(n_states,) degC at which a record begins."""
    x = initial_state(network, record.initial)
    for name, rise in record.above.items():
        x[network.states.index(name)] += rise
    return x


def simulate(
    network: Network,
    record: Record,
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tangents: Sequence[Parameter] = (),
    keep_states: bool = False,
    begin: Stand | None = None,
    steps: Steps | None = None,
    precision: Precision = RUN,
    shifts: Sequence[str | None] = (),
) -> Run:
    """Integrate the network over the record.

    values : parameter name -> value; parameters of the network that are not listed stand at their declared value
    rows : linear outputs of z = [x; u] (sensors, before bias, gain and lag)
    tangents : parameters of the network with respect to which y is differentiated: d y / d value for
        mappings "amplitude", "relative" and "offset", d y / d log(value) for "log"
    shifts : further tangents, by an offset (K) of these boundaries, of the start of these states, or of all (None)
    begin : where another run of the same network, values and tangents ended, at this record's first time
    steps : those of another run over the same record, to be taken here too whatever their errors are
    precision : what a step may be wrong by, and whether one ends at every sample

    Raises ThermoscopeError where a node runs away or no step keeps what physics allows.
    """
    core = compiled(network, record, values, rows, tangents, precision=precision, shifts=shifts)
    finer = partial(simulate, network, record, values, rows, begin=begin, precision=precision.finer)
    return replace(march(network, record, core, keep_states, begin, steps), finer=finer)


def march(
    network: Network,
    record: Record,
    core: Compiled,
    keep_states: bool = False,
    begin: Stand | None = None,
    steps: Steps | None = None,
    keep_path: bool = False,
    portion: int = PORTION,
) -> Run:
    """Run the kernel, from rest of the states without capacity: at the start and wherever a time is given twice.

    portion : steps whose states are in memory at once for their tangents
    """
    course = _Course(network, record, core, keep_states, begin, steps, portion)
    course.path = [] if keep_path else None
    time = core.forcing.time  # cut at its jumps, if any state has no capacity: there such states find a new balance
    jumps = np.flatnonzero(np.diff(time, prepend=-np.inf) == 0.0) if np.any(core.C == 0.0) else np.empty(0, int)
    for a, b in pairwise([0, *jumps, time.size]):
        course.over(slice(a, b), a > 0 or begin is None)
    return course.run()


class _Course:
    """A run in the making: the arrays that the kernel writes, portion after portion, in the order of elimination.

    order (n + nb,) : the state or boundary in every place;  place (n + nb,) : the other way round
    """

    def __init__(
        self,
        network: Network,
        record: Record,
        core: Compiled,
        keep_states: bool,
        begin: Stand | None,
        steps: Steps | None,
        portion: int,
    ) -> None:
        self.network, self.named, self.given, self.steps_done = network, core, steps, 0
        self.core = core = reordered(core)
        self.time = np.asarray(record.time, float)
        nt, n, nb, nr = self.time.size, core.C.size, core.forcing.u.shape[1], core.rows.start.size - 1
        self.tangents = p = core.tangents.first.shape[1]
        self.z, self.y = np.empty((nt if keep_states else 0, n + nb)), np.zeros((nt, nr))
        self.order = np.concatenate([core.order, np.arange(n, n + nb)])
        self.place = np.argsort(self.order)
        x0, u0 = (begin.x if begin else start_state(network, record))[core.order], core.forcing.u[0]
        self.both, self.scratch = stages(x0, u0, core.terms), work(n, nb, core.terms, 0)
        self.moved = (stages(x0, u0, core.terms), work(n, nb, core.terms, p)) if p else (self.both, self.scratch)
        self.dy = np.zeros((nt, nr, self.moved[1].D.shape[1]))
        most = min(core.forcing.time.size * 2 if steps is None else steps.knot.size, portion)
        self.trace = _trace(min(most, max(FACTORS // n**2, 1)) if p else most, core, nb, bool(p))
        self.position = kernel.Position(np.zeros(6, np.int64), np.array([0.0, -1.0, 1e300, 1e300]))
        self.position.clock[kernel.LOW] = np.append(x0[core.control.node == 1], u0).min()
        self.reach, self.steps = Reach(core), list[Steps]()
        self.path: list[Array] | None = None
        self.moved[1].D[:, : self.tangents] = core.tangents.first
        if begin:
            self.moved[1].D[:, : self.tangents] = begin.D[self.order, : self.tangents]
            coldest = min(begin.coldest, self.position.clock[kernel.LOW])
            self.position.clock[[kernel.NEXT, kernel.LOW]] = begin.step, coldest

    def over(self, part: slice, rests: bool) -> None:
        """The knots of a part of the record, from a balance of the states without capacity if so asked."""
        Q = self.core.forcing
        first = Q.first[part.start : part.stop + 1]
        forcing = Forcing(
            Q.time[part], Q.u[part], Q.factor[part], Q.bulge[part], Q.arch[part], Q.renew[part], first, Q.share
        )
        self.position.at[:] = 0
        self.position.at[kernel.SAMPLE] = forcing.first[0]
        self.both.z[0, self.core.C.size : -1] = forcing.u[0]
        self.position.clock[kernel.FACTORED] = -1.0
        if rests and np.any(self.core.C == 0.0):
            self._rest(forcing)
        while self._portion(forcing, part.start):
            pass

    def _rest(self, forcing: Forcing) -> None:
        core, sensitivity = self.core, self.moved[1]
        scratch = self.scratch._replace(D=sensitivity.D, R=sensitivity.R)
        if not solve_steady_start(core.C, core.K0, core.terms, core.tangents, forcing.factor[0], self.both, scratch):
            raise self._failed(forcing)

    def _failed(self, forcing: Forcing) -> NoSolution:
        self.position.at[kernel.NODE] = self.order[self.position.at[kernel.NODE]]
        return NoSolution(failure(self.network, self.named, forcing, self.position))

    def _portion(self, forcing: Forcing, first: int) -> bool:
        """As many steps as the trace holds; whether there are more."""
        core, at, sample = self.core, self.position.at, int(self.position.at[kernel.SAMPLE])
        control = core.control if self.given is None else self._follow(first)
        common = (core.rows, control, self.trace, self.position, self.both, self.scratch)
        kernel.integrate(forcing, core.C, core.K0, core.terms, *common, self.z, self.y)
        if at[kernel.STATUS] not in (0, kernel.FULL):
            raise self._failed(forcing)
        count, X = int(at[kernel.COUNT]), self.trace
        self.steps_done += count
        self.steps.append(Steps(X.knot[:count] + first, X.share[:count].copy(), X.kind[:count].copy()))
        if not self.tangents and count:
            self.reach.see(X.x[:count], forcing, X.knot[:count])
        if self.path is not None:
            self.path.append(ends(X, count)[:, self.place[: core.C.size]])
        if self.tangents:
            position = (core.rows, core.curved, X, count, sample, int(at[kernel.SAMPLE]), *self.moved, self.dy)
            differentiate(forcing, core.C, core.K0, core.terms, core.tangents, *position)
        return bool(at[kernel.STATUS] == kernel.FULL)

    def _follow(self, first: int) -> kernel.Control:
        """The next of the given steps into the trace."""
        assert self.given is not None
        some = slice(self.steps_done, self.steps_done + self.trace.h.size)
        for name, values in self.given._asdict().items():
            part = values[some] - (first if name == "knot" else 0)
            getattr(self.trace, name)[: part.size] = part
        return self.core.control._replace(follow=np.ones(1, np.int64))

    def run(self) -> Run:
        """What came of it."""
        if not self.tangents:  # of a fit, whose every run would say so
            last = np.array([self.core.forcing.time.size - 1])
            self.reach.see(self.both.z[:1, :-1], self.core.forcing, last)
            self.reach.tell()
        clock = self.position.clock
        x, D = self.both.z[0, self.place[: self.core.C.size]], self.moved[1].D[self.place, : self.tangents]
        end = Stand(x, D, float(clock[kernel.NEXT]), float(clock[kernel.LOW]))
        steps = Steps(*(np.concatenate(x) for x in zip(*self.steps, strict=True)))
        dy = np.ascontiguousarray(self.dy[:, :, : self.tangents]) if self.tangents else None
        z, path = self.z if len(self.z) else None, np.concatenate(self.path) if self.path else None
        return Run(self.time, z, self.y, dy, end, steps, path)


def ends(X: kernel.Trace, count: int) -> Array:
    """(count, n) states at the ends of the steps in a trace."""
    inner = np.where(X.kind[:count, None] == EULER, X.U[:count, 0], X.U[:count, 0] / GAMMA)
    return np.asarray(X.x[:count, : inner.shape[1]] + inner + X.U[:count, 2])


def _trace(ns: int, core: Compiled, nb: int, moves: bool) -> kernel.Trace:
    """Of ns steps;  moves : for tangents, which need the LU of every step."""
    n, slots = core.C.size, ns if moves else 1

    def whole() -> Ints:
        return np.zeros(ns, np.int64)

    return kernel.Trace(
        whole(),
        np.zeros(ns),
        np.zeros(ns),
        whole(),
        np.zeros((ns, n + nb)),
        np.zeros((ns, 3, n)),
        np.zeros(ns),
        whole(),
        factored(slots, core.structure),
        np.zeros((slots, n, nb)),
    )
