"""The network between two samples, with missing heat at its bodies, and its linearisation on the slow states.

    C dx/dt = F(x, u) + E q ,     dq/dt = -q / tau + white noise

x: states (degC), q: missing heat of the bodies (W). The mean goes by a Rosenbrock method of order two, L-stable
(Hairer and Wanner 1996, IV.7); its linearisation by implicit Euler on the reduced model: temperatures of nodes with
heat capacity, shapes and nodes without any at their balance.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from math import ceil, sqrt

import numpy as np
from scipy.linalg import get_lapack_funcs

from thermoscope import Network, Record, plugin as th

GAMMA = 1.0 - sqrt(0.5)  # L-stable
LONGEST_S = 20.0  # of an inner step: a fraction of the time constants that windings have


def bodies_of(network: Network) -> tuple[str, ...]:
    """Nodes and parts with heat capacity: where heat may be missing."""
    solid = (p for p in network.places.values() if p.kind in ("node", "part") and p.name in network.states)
    return tuple(p.name for p in solid if network.C[network.column(p.name)] > 0.0)


@dataclass(frozen=True)
class Driven:
    """A record as the network is driven by it.  time (nt,);  factor (nt, ne), u (nt, nb) at its samples"""

    core: th.Compiled
    time: th.Array
    factor: th.Array
    u: th.Array


@dataclass(frozen=True)
class Linear:
    """G (n, n) = -dF/dx at the start of a step of h seconds."""

    G: th.Array
    h: float


@dataclass(frozen=True)
class Process:
    """A network at some values of its parameters.  bodies : nodes or parts whose missing heat is a state of its own"""

    network: Network
    values: Mapping[str, float]
    bodies: tuple[str, ...]

    @cached_property
    def slow(self) -> th.Ints:
        """The states of the reduced model."""
        visible = np.array(["#" not in s for s in self.network.states], bool)
        return np.flatnonzero(visible & (self.network.C > 0.0))

    @cached_property
    def fast(self) -> th.Ints:
        """The others: shapes, and nodes without capacity."""
        return np.setdiff1d(np.arange(len(self.network.states)), self.slow)

    @cached_property
    def E(self) -> th.Array:
        """(n, m) which state the heat of a body enters."""
        out = np.zeros((len(self.network.states), len(self.bodies)))
        for i, name in enumerate(self.bodies):
            out[self.network.column(name), i] = 1.0
        return out

    @property
    def size(self) -> int:
        """Of the reduced model with its heats."""
        return self.slow.size + len(self.bodies)

    def state(self, c: th.Channel) -> int:
        """Of the place where a sensor sits."""
        places = self.network.places
        return self.network.column(places[c.place].part if c.place in places else c.place)

    def driven(self, record: Record) -> Driven:
        with th.within_silence():  # a comparison says so once; here it would be every row
            core = th.compiled(self.network, record, self.values, precision=th.READINGS)
        at = core.forcing.first[1:] > core.forcing.first[:-1]
        return Driven(core, np.asarray(record.time, float), core.forcing.factor[at], core.forcing.u[at])

    def steps(self, by: Driven, k: int, x: th.Array, q: th.Array) -> tuple[th.Array, list[Linear]]:
        """States at sample k from those at the sample before it; the linearisations of the steps on the way."""
        path = []
        for share, h in self.inner(float(by.time[k] - by.time[k - 1])):
            f = by.factor[k - 1] + share * (by.factor[k] - by.factor[k - 1])
            u = by.u[k - 1] + share * (by.u[k] - by.u[k - 1])
            x, G = self.stepped(partial(self._at, by.core, u=u, f=f), by.core.C, x, q, h)
            path.append(Linear(G, h))
        return x, path

    @staticmethod
    def inner(seconds: float) -> Iterator[tuple[float, float]]:
        """The steps of a sample: how far (share of it) the middle of each lies, and how long (s) it is."""
        count = max(ceil(seconds / LONGEST_S - 1e-9), 1)
        for i in range(count if seconds > 0.0 else 0):
            yield (i + 0.5) / count, seconds / count

    def stepped(
        self, heat: Callable[[th.Array], tuple[th.Array, th.Array]], C: th.Array, x: th.Array, q: th.Array, h: float
    ) -> tuple[th.Array, th.Array]:
        """States after a step, and G at its start.  heat : x -> F (n,) and G;  C (n,) J/K"""
        F, G = heat(x)
        missing, lu = self.E @ q, _Factored(np.diag(C) + GAMMA * h * G)
        first = lu.solve(F + missing)
        second = lu.solve(heat(x + h * first)[0] + missing - 2.0 * C * first)
        return x + h * (1.5 * first + 0.5 * second), G

    def _at(self, core: th.Compiled, x: th.Array, u: th.Array, f: th.Array) -> tuple[th.Array, th.Array]:
        T, n = core.terms, x.size
        tau = np.zeros((T.m.size, 9))
        tau[:, 0] = 1.0
        F, G = np.empty(n), np.empty((n, n))
        z = np.concatenate([x, u, [1.0]])
        th.instant(T, core.K0, z, np.ascontiguousarray(f), tau, np.empty(T.begin.size - 1), F, G)
        return F, G

    def propagated(self, core: th.Compiled, step: Linear, X: th.Array, heat: th.Array) -> th.Array:
        """Columns X (n_slow, k) of deviations after a step, driven by heat (m, k)."""
        C = np.zeros(core.C.size)
        C[self.slow] = core.C[self.slow]
        right = step.h * (self.E @ heat)
        right[self.slow] += C[self.slow, None] * X
        return _Factored(np.diag(C) + step.h * step.G).solve(right)[self.slow]

    def balance(self, G: th.Array) -> th.Array:
        """(n, n_slow) all states that follow the slow ones at once."""
        out = self.slow_only
        if self.fast.size:
            out[self.fast] = -np.linalg.solve(G[np.ix_(self.fast, self.fast)], G[np.ix_(self.fast, self.slow)])
        return out

    @property
    def slow_only(self) -> th.Array:
        """(n, n_slow) the slow states alone: where nothing follows them yet."""
        out = np.zeros((len(self.network.states), self.slow.size))
        out[self.slow, np.arange(self.slow.size)] = 1.0
        return out

    def sensed(self, row: th.Row, along: th.Array) -> th.Array:
        """(n_slow,) what a sensor sees of the slow states."""
        inside = row.index < along.shape[0]
        return np.asarray(row.weights[inside] @ along[row.index[inside]])


class _Factored:
    """LU of a matrix; scipy's own check of every argument costs as much as the work."""

    def __init__(self, A: th.Array) -> None:
        factor, self._solve = get_lapack_funcs(("getrf", "getrs"), (A,))
        self._lu, self._pivot, _ = factor(A)

    def solve(self, b: th.Array) -> th.Array:
        return np.asarray(self._solve(self._lu, self._pivot, b)[0])
