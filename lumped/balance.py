"""Where the heat goes: through every link and out of every source, by the scheme's own quadrature."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.compiled import Compiled, compiled
from lumped.count import count
from lumped.network import Link, Network
from lumped.simulate import Record, Run, checked_time, march
from lumped.stages import stages, work
from lumped.terms import ROWS

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Balance:
    """Heat since the start of the record (J), at every time.

    through : link -> (nt,) from its first place to its second; for a stream what it carries out of the network
    injected : source -> (nt,)
    out : (nt,) all heat that left the network;  stored : (nt,) sum of C (T - T at the start)
    """

    time: Array
    through: Mapping[str, Array]
    injected: Mapping[str, Array]
    out: Array
    stored: Array

    @property
    def residual(self) -> Array:
        """(nt,) injected - out - stored over the largest of them: rounding only."""
        total = np.sum([*self.injected.values(), np.zeros_like(self.out)], axis=0)
        scale = max(np.abs(total).max(), np.abs(self.out).max(), np.abs(self.stored).max(), 1e-300)
        return (total - self.out - self.stored) / scale

    def power(self, name: str) -> Array:
        """(nt - 1,) mean heat flow of a link or source over every step (W); 0 over a jump."""
        heat = self.through[name] if name in self.through else self.injected[name]
        dt = np.diff(self.time)
        return np.divide(np.diff(heat), dt, out=np.zeros_like(dt), where=dt > 0)


def balance(network: Network, record: Record, values: Mapping[str, float] | None = None) -> Balance:
    """Run the record and count the heat: a few times the cost of a run."""
    core = compiled(network, record.inputs, checked_time(record.time).size, values, all_terms=True)
    mean = np.array(["#" not in s for s in network.states], float)
    run = march(network, record, core, keep_states=True, keep_rates=True)
    heat, left = _counted(core, run, np.stack([_through(network, core, mean), mean[core.terms.row]]))
    assert run.z is not None
    links, n = len(network.links), len(network.states)
    return Balance(
        run.time,
        {name: heat[:, e] for e, name in enumerate(core.names[:links])},
        {name: -left[:, links + s] for s, name in enumerate(core.names[links:])},
        left[:, :links].sum(axis=1),
        (run.z[:, :n] - run.z[0, :n]) @ (core.C * mean),
    )


def _counted(core: Compiled, run: Run, through: Array) -> Array:
    """(nw, nt, n_terms) J; `through` (nw, rows of all terms) says which rows count as the heat through a term."""
    assert run.z is not None
    assert run.k is not None
    n, ne = core.C.size, core.terms.m.size
    out, u = np.zeros((len(through), run.time.size, ne)), np.ascontiguousarray(run.z[:, n:])
    arrays = stages(run.z[0, :n], u[0], core.terms), work(n, ne, 0)
    count(run.time, u, core.K0, core.terms, through, run.z, run.k, *arrays, out)
    return out


def _through(network: Network, core: Compiled, mean: Array) -> Array:
    """(rows of all terms,) +1 on the first place's rows, or -1 on the second's where the first is outside."""
    out = np.zeros(core.terms.row.size)
    for e, link in enumerate(network.links):
        span = slice(*core.terms.start[e : e + 2, ROWS])
        out[span] = mean[core.terms.row[span]] * _side(network, link)[core.terms.row[span]]
    return out


def _side(network: Network, link: Link) -> Array:
    n = len(network.states)
    if link.kind == "stream":
        return np.ones(n)
    for place, sign in zip(link.places, (1.0, -1.0), strict=True):
        states = _states(network, place)
        if states.size:
            side = np.zeros(n)
            side[states] = sign
            return side
    return np.zeros(n)


def _states(network: Network, place: str) -> NDArray[np.int64]:
    if place in network.places:
        states = network.places[place].states
        return states[states < len(network.states)]
    return np.array([i for i, s in enumerate(network.states) if s == place], np.int64)
