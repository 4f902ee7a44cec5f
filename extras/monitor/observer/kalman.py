"""How much heat may be missing, and the square-root Kalman filter: no covariance loses its sign to rounding.

The time update is by QR, the measurement update one reading at a time by Potter. Sources: Kaminski, Bryson and Schmidt
1971; Bierman 1977, chapters II and V; Simon 2006, chapter 6.

Missing heat is a random walk in every body, its covariance from the table of doubt: a parameter, loss, input or
boundary that is off by one deviation moves the heat into every body. What that makes along the calibration tests, by
the covariance that the calibration has left, is the covariance of the missing heat.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from extras.monitor.observer.process import Driven, Process
from thermoscope import Network, Parameter, plugin as th, simulate

INSTANTS = 100  # of a test: heat turns slowly
MOST_BODIES = 10  # heat in small parts shows in their neighbours
REMAINS = 1e-6  # of the largest variance: keeps a covariance positive where nothing is in doubt


@dataclass(frozen=True)
class ProcessNoise:
    """Missing heat wanders with this covariance (m, m) W2 and forgets itself in time_s."""

    covariance: th.Array
    time_s: float

    @property
    def root(self) -> th.Array:
        """(m, m) lower triangular."""
        floor = REMAINS * max(float(np.diag(self.covariance).max()), 1.0)
        return np.asarray(np.linalg.cholesky(self.covariance + floor * np.eye(len(self.covariance))), float)

    @property
    def sd(self) -> th.Array:
        return np.sqrt(np.diag(self.covariance))


def of_doubt(of: th.ParameterPosterior, tests: Sequence[th.Test], bodies: Sequence[str]) -> th.Array:
    """(m, m) W2, mean over the tests."""
    return np.mean([_in_test(of, test, bodies) for test in tests], axis=0)


def _in_test(of: th.ParameterPosterior, test: th.Test, bodies: Sequence[str]) -> th.Array:
    network, free, size = th.acting(of, test)
    look = _Flows(network, of.values, test, bodies)
    beside = ("boundary", "initial")  # which `moved_boundaries` has, and what is not heat
    columns = {p.name: look.by(p) * s for p, s in zip(free, size, strict=True) if th.head(p) not in beside}
    responses = {name: look.driven(other) for name, other in th.moved_inputs(network, test, of.doubt)}
    responses |= {name: look.beside(other) for name, other in th.moved_boundaries(test, of.doubt)}
    sd = [p.prior_sd / s for p, s in zip(free, size, strict=True) if p.name in columns]
    Sigma = of.of([*columns, *responses], np.array([*sd, *np.ones(len(responses))]))
    A = np.stack([*columns.values(), *responses.values()], axis=2)
    return np.asarray(np.einsum("tik,kl,tjl->ij", A, Sigma, A) / len(A))


class _Flows:
    """Heat into the bodies along a test, term by term.

    shape (nt, ne, m) : of unit multiplier and factor;  factor (nt, ne);  m (ne,) multipliers
    """

    def __init__(self, network: Network, values: Mapping[str, float], test: th.Test, bodies: Sequence[str]) -> None:
        self.network, mine = th.heat_model(network, values)
        self.values = th.values_of(self.network, mine)
        self.test, self.columns = test, [network.column(b) for b in bodies]
        course = th.record(test, {})
        self.z = np.asarray(simulate(self.network, course, self.values, keep_states=True).z)
        self.some = np.unique(np.linspace(0, test.time.size - 1, INSTANTS).astype(int))
        self.terms = th.assembly(self.network)
        acting_now = th.multipliers(self.network, self.values)
        self.m = np.array([acting_now.get(name, 1.0) for name in self.terms.names])
        self.factor = self._factors(test)
        self.law = _laws(self.terms, self.z[self.some])
        self.shape = self._shape(self.z[self.some])
        rate = np.gradient(self.z[:, self.columns], test.time, axis=0)[self.some]
        self.stored = rate * network.C[self.columns]

    def _factors(self, test: th.Test) -> th.Array:
        with th.within_silence():  # a comparison says so
            every = [test.signals.factor(p.name, th.separated(p.law)) for p in self.terms.patterns]
        return np.stack([np.broadcast_to(f, test.time.shape) for f in every], axis=1)[self.some]

    def _shape(self, z: th.Array) -> th.Array:
        z = np.column_stack([z, np.ones(len(z))])
        out = np.zeros((len(z), len(self.terms.patterns), len(self.columns)))
        for e, p in enumerate(self.terms.patterns):
            for i, column in enumerate(self.columns):
                here = p.row[p.to] == column
                if here.any():
                    out[:, e, i] = -self.law[:, e] * (z[:, p.cols[here]] @ p.vals[here])
        return out

    def by(self, p: Parameter) -> th.Array:
        """(nt, m) change of heat by a parameter; d log(value) for mapping "log"."""
        moves, at = th.slopes(self.network, self.values, [p])[0], {n: e for e, n in enumerate(self.terms.names)}
        out = np.zeros((len(self.some), len(self.columns)))
        for target, slope in moves.items():
            if target in at:
                out += slope * self.factor[:, at[target], None] * self.shape[:, at[target]]
        return out - th.capacity_slopes(self.network, moves)[self.columns] * self.stored

    def driven(self, other: th.Test) -> th.Array:
        """(nt, m) change of heat where inputs are as in another record."""
        return np.asarray(np.einsum("te,tei->ti", self.m * (self._factors(other) - self.factor), self.shape))

    def beside(self, other: th.Test) -> th.Array:
        """(nt, m) change of heat where boundaries are as in another record, all states as they are."""
        z = self.z[self.some].copy()
        n = len(self.network.states)
        for k, name in enumerate(self.network.boundaries):
            z[:, n + k] = np.broadcast_to(np.asarray(other.boundaries[name], float), other.time.shape)[self.some]
        change = self._shape(z) - self.shape
        return np.asarray(np.einsum("te,tei->ti", self.m * self.factor, change))


def _laws(terms: th.Assembly, z: th.Array) -> th.Array:
    """(nt, ne) temperature laws of all terms."""
    out = np.ones((len(z), len(terms.patterns)))
    for e, p in enumerate(terms.patterns):
        if p.bends:
            hot, cold = z[:, p.hot.index] @ p.hot.weights, z[:, p.cold.index] @ p.cold.weights
            pairs = zip(hot, np.broadcast_to(cold, hot.shape), strict=True)
            out[:, e] = [th.turned(p.law.temperature, float(a), float(b)) for a, b in pairs]
    return out


def thinned(test: th.Test) -> th.Test:
    """The test without its finer record: a filter looks at its samples."""
    return replace(test, recorded=None)


def most_doubtful(bodies: Sequence[str], covariance: th.Array) -> tuple[tuple[str, ...], th.Array]:
    """The bodies where most heat may be missing, so that the filter stays small, with their covariance."""
    order = np.sort(np.argsort(-np.diag(covariance), kind="stable")[:MOST_BODIES])
    return tuple(bodies[i] for i in order), covariance[np.ix_(order, order)]


@dataclass
class Filter:
    """x (n,) degC, q (m,) W;  S (N, N) with S S' the covariance of slow states and heats

    error (N, h) : how far each of some hypotheses, were it true, would have led the estimate astray, per unit of it
    heats (m, h) : the constant heat that a unit of each brings;  along (n, n_slow) : fast states that follow slow ones
    """

    process: Process
    noise: ProcessNoise
    x: th.Array
    q: th.Array
    S: th.Array
    error: th.Array
    heats: th.Array
    along: th.Array

    def predict(self, by: Driven, k: int) -> None:
        """To sample k of the record from the one before."""
        self.x, path = self.process.steps(by, k, self.x, self.q)
        n, root = self.process.slow.size, self.noise.root
        wide = len(self.S)
        for step in path:
            keeps = float(np.exp(-step.h / self.noise.time_s))
            both = np.hstack([self.S, self.error])
            pushed = np.hstack([self.S[n:], self.error[n:] + self.heats])
            both[:n] = self.process.propagated(by.core, step, both[:n], pushed)
            both[n:] *= keeps
            self.error = both[:, wide:]
            new = np.vstack([np.zeros((n, wide - n)), np.sqrt(1.0 - keeps**2) * root])
            self.S = np.asarray(np.linalg.qr(np.hstack([both[:, :wide], new]).T, mode="r")).T
            self.q = keeps * self.q
        if path and self.process.fast.size:
            self.along = self.process.balance(path[-1].G)

    def gain(self, h: th.Array, variance: float) -> tuple[th.Array, float]:
        """Gain (N,) for a reading that sees h (N,), and the variance of its innovation; the covariance is updated."""
        phi = self.S.T @ h
        total = float(phi @ phi) + variance
        through = self.S @ phi
        self.S = self.S - np.outer(through, phi) / (total + np.sqrt(variance * total))
        return through / total, total

    def correct(self, change: th.Array) -> None:
        """Move the estimate by (N,) K and W."""
        n = self.process.slow.size
        self.x = self.x + self.along @ change[:n]
        self.q = self.q + change[n:]

    def restart(self, sd: float) -> None:
        """As at the start, with temperatures as they are, each uncertain by sd (K)."""
        n = self.process.slow.size
        self.q, self.S, self.error = np.zeros(self.q.size), np.zeros_like(self.S), np.zeros_like(self.error)
        self.S[:n, :n], self.S[n:, n:] = sd * np.eye(n), self.noise.root


def begun(
    process: Process, noise: ProcessNoise, x: th.Array, sd: Mapping[int, float], usual_sd: float, heats: th.Array
) -> Filter:
    """A filter at its start.  sd : column of a state -> its deviation (K), else the usual one;  heats (m, h)"""
    n, m = process.slow.size, len(process.bodies)
    S = np.zeros((n + m, n + m))
    S[:n, :n] = np.diag([sd.get(int(column), usual_sd) for column in process.slow])
    S[n:, n:] = noise.root
    return Filter(process, noise, x, np.zeros(m), S, np.zeros((n + m, heats.shape[1])), heats, process.slow_only)
