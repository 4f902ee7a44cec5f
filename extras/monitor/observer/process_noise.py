"""How much heat may be missing: the covariance of a random walk in every body, from the table of doubt.

A parameter, loss, input or boundary that is off by one deviation moves the heat into every body. What that makes along
the calibration tests, by the covariance that the calibration has left, is the covariance of the missing heat.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

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
