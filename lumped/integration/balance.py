"""Where the heat goes, through every link and out of every source; and is it what the losses declare?"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geom.arrays import Array, Ints
from lumped.integration.assembly import floats, starts
from lumped.integration.compiled import Compiled, compiled
from lumped.integration.record import Record
from lumped.integration.signals import Signals
from lumped.integration.simulate import Run, march
from lumped.model.multipliers import multipliers
from lumped.model.network import Link, Network, Source
from lumped.numerics.heat_integrals import count
from lumped.numerics.stages import Steps, stages, work
from lumped.numerics.terms import END, ROW
from lumped.transfer.laws import CONSTANT
from lumped.transfer.terms_value import temperature_value

# Radau's quadrature of order five over a step, which does not look at its start (Hairer and Wanner 1996, sec. IV.5)
NODES = np.array([(4.0 - np.sqrt(6.0)) / 10.0, (4.0 + np.sqrt(6.0)) / 10.0, 1.0])
WEIGHTS = np.array([(16.0 - np.sqrt(6.0)) / 36.0, (16.0 + np.sqrt(6.0)) / 36.0, 1.0 / 9.0])


@dataclass(frozen=True)
class Balance:
    """Heat since the start of the record (J), at every time.

    through : link -> (nt,) from its first place to its second; for a stream what it carries out of the network
    injected : source -> (nt,)
    out : (nt,) all heat that left the network;  stored : (nt,) sum of C (T - T at the start)
    z : (nt, n_states + n_boundaries) degC of the run
    """

    time: Array
    through: Mapping[str, Array]
    injected: Mapping[str, Array]
    out: Array
    stored: Array
    z: Array

    @property
    def residual(self) -> Array:
        """(nt,) injected - out - stored over the largest of them: what the time steps leave."""
        total = np.sum([*self.injected.values(), np.zeros_like(self.out)], axis=0)
        scale = max(np.abs(total).max(), np.abs(self.out).max(), np.abs(self.stored).max(), 1e-300)
        return (total - self.out - self.stored) / scale

    def power(self, name: str) -> Array:
        """(nt - 1,) mean heat flow of a link or source over every step (W); 0 over a jump."""
        heat = self.through[name] if name in self.through else self.injected[name]
        dt = np.diff(self.time)
        return np.divide(np.diff(heat), dt, out=np.zeros_like(dt), where=dt > 0)


def balance(network: Network, record: Record, values: Mapping[str, float] | None = None) -> Balance:
    """Run the record and count the heat along it: a few times the cost of a run.

    Stored is what the run prints. What flowed is Radau's quadrature over every step of that run, of the heat flows on
    the way: the run is gone through again in finer steps that end at the nodes. So what does not close is the error of
    the run.
    """
    core = compiled(network, record, values, all_terms=True)
    run = march(network, record, core, keep_states=True)
    return counted(network, core, run, walk(network, record, core, run))


def counted(network: Network, core: Compiled, run: Run, way: "Walk") -> Balance:
    """The balance of a run that was walked along; core with all terms."""
    mean = np.array(["#" not in s for s in network.states], float)
    assert run.z is not None
    through = np.stack([_through(network, core, mean), floats(mean[at] for at in _rows(core))])
    heat, left = _counted(core, way, through, run.time.size)
    links, n = len(network.links), len(network.states)
    through_links = {name: heat[:, e] for e, name in enumerate(core.names[:links])}
    injected = {name: -left[:, links + s] for s, name in enumerate(core.names[links:])}
    stored = (run.z[:, :n] - run.z[0, :n]) @ (core.C * mean)
    return Balance(run.time, through_links, injected, left[:, :links].sum(axis=1), stored, run.z)


@dataclass(frozen=True)
class Walk:
    """Instants of Radau's quadrature along a run.  steps : finer ones that end there;  x (ni, n) degC;  weight (ni,) s

    row (ni,) : the sample that ends the interval they lie in;  at (ni,) : their position, a sample's index plus a share
    """

    steps: Steps
    x: Array
    weight: Array
    row: Ints
    at: Array


def walk(network: Network, record: Record, core: Compiled, run: Run) -> Walk:
    """The run once more, in three steps for every one that it took."""
    forcing = core.forcing
    samples = np.repeat(np.arange(forcing.time.size), np.diff(forcing.first)) - 1.0 + forcing.share
    finer, weight, at = _nodes(run.steps, forcing.time, samples)
    x = march(network, record, core, steps=finer, keep_path=True).path
    assert x is not None
    row = np.searchsorted(samples, at)
    before = forcing.time[finer.knot - 1]
    time = before + finer.share * (forcing.time[finer.knot] - before)
    left, right = run.time[row - 1], run.time[row]
    return Walk(finer, x, weight, row, row - 1 + (time - left) / (right - left))


def _counted(core: Compiled, way: Walk, through: Array, nt: int) -> Array:
    """(nw, nt, n_terms) J; `through` (nw, rows of all terms) says which rows count as the heat through a term."""
    forcing, n, ne = core.forcing, core.C.size, core.terms.m.size
    out, u = np.zeros((len(through), nt, ne)), forcing.u
    arrays = stages(np.zeros(n), u[0], core.terms), work(n, u.shape[1], core.terms, 0)
    first = starts(_rows(core))[:-1]
    count(forcing, core.K0, core.terms, through, first, way.steps, way.x, way.weight, way.row, *arrays, out)
    return np.cumsum(out, axis=1)


def _nodes(steps: Steps, time: Array, samples: Array) -> tuple[Steps, Array, Array]:
    """Every step, cut at the samples inside it, in three that end at the nodes of Radau's quadrature; weights (s).

    samples (nt,) : the knot before each plus its share of the next interval;  last : where the pieces end, likewise
    """
    ends = steps.knot - 1.0 + steps.share
    inner = samples[(samples > 0.0) & (samples != np.floor(samples))]
    to = np.union1d(ends, inner)
    which = np.searchsorted(ends, to)
    knot, share = steps.knot[which], to - (steps.knot[which] - 1.0)
    share[np.isin(to, ends)] = steps.share
    same = np.append(False, knot[1:] == knot[:-1])
    start = np.where(same, np.append(0.0, share[:-1]), 0.0)
    width = (share - start)[:, None]
    nodes = start[:, None] + width * NODES
    nodes[:, -1] = share
    weight = width * (time[knot] - time[knot - 1])[:, None] * WEIGHTS
    return Steps(np.repeat(knot, 3), nodes.ravel(), np.repeat(steps.kind[which], 3)), weight.ravel(), np.repeat(to, 3)


def _through(network: Network, core: Compiled, mean: Array) -> Array:
    """(rows of all terms,) +1 on the first place's rows, or -1 on the second's where the first is outside."""
    rows, links = _rows(core), len(network.links)
    sides = [mean[at] * _side(network, link)[at] for at, link in zip(rows, network.links, strict=False)]
    return floats([*sides, *(np.zeros(at.size) for at in rows[links:])])


def _rows(core: Compiled) -> list[Ints]:
    """The states that every term takes from, term by term."""
    return [core.terms.row[first:end] for first, end in core.terms.part[:, [ROW, END]]]


def _side(network: Network, link: Link) -> Array:
    n = len(network.states)
    if link.kind == "stream":
        return np.ones(n)
    for place, sign in zip(link.places, (1.0, -1.0), strict=True):
        if place in network.places:
            states = network.places[place].states
            states = states[states < n]
        else:
            states = np.array([i for i, s in enumerate(network.states) if s == place], np.int64)
        if states.size:
            side = np.zeros(n)
            side[states] = sign
            return side
    return np.zeros(n)


@dataclass(frozen=True)
class Audit:
    """declared_J, injected_J : source -> heat over the record;  balance : where it went"""

    declared_J: Mapping[str, float]
    injected_J: Mapping[str, float]
    balance: Balance

    @property
    def mismatch(self) -> float:
        """Largest |injected - declared| of a source over the sum of all |declared|."""
        scale = sum(abs(x) for x in self.declared_J.values()) or 1.0
        return max((abs(self.injected_J[s] - x) / scale for s, x in self.declared_J.items()), default=0.0)

    @property
    def residual(self) -> float:
        """Largest |in - out - stored| at any time over the largest of them."""
        return float(np.abs(self.balance.residual).max())


def audit(network: Network, record: Record, values: Mapping[str, float] | None = None) -> Audit:
    """Declared: every loss law in NumPy, at the temperatures of a run and the inputs between its samples.

    Injected: what the compiled terms put into the nodes. Both by the quadrature of `balance`.
    """
    core = compiled(network, record, values, all_terms=True)
    run = march(network, record, core, keep_states=True)
    way, m = walk(network, record, core, run), multipliers(network, values)
    signals = record.inputs if isinstance(record.inputs, Signals) else Signals(record.inputs, run.time.size)
    energies = {s.name: m.get(s.name, 1.0) * _heat(s, signals, way) for s in network.sources}
    heat = counted(network, core, run, way)
    return Audit(energies, {name: float(x[-1]) for name, x in heat.injected.items()}, heat)


def _heat(source: Source, signals: Signals, way: Walk) -> float:
    factor = signals.along(source.name, source.law, way.at)
    law, over = source.law.temperature, np.ones(())
    if law != CONSTANT:
        probe = way.x[:, source.probe.index] @ source.probe.weights
        over = np.array([temperature_value(law, float(T), 0.0) for T in probe])
    return float(np.sum(way.weight * factor * over))
