"""Run a network over a record, with exact tangents of the discrete scheme.

run = simulate(network, Record(time, inputs, boundaries, initial), values, rows, tangents)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError, ThermoscopeError
from lumped.compiled import Compiled, compiled
from lumped.kernel import integrate
from lumped.network import Network, Parameter, Row
from lumped.runaway import told
from lumped.settle import settle
from lumped.stages import Stages, Work, stages, work
from lumped.tangents import differentiate
from lumped.terms import BENDS

Array = NDArray[np.float64]
PORTION = 4096  # steps whose states are kept for their tangents


@dataclass(frozen=True)
class Record:
    """time (nt,) s; inputs and boundaries: name -> (nt,) or scalar; initial: degC everywhere or per place.

    Inputs and boundaries are linear between the times; a time given twice is a jump.
    """

    time: Array
    inputs: Mapping[str, Array]
    boundaries: Mapping[str, Array]
    initial: float | Mapping[str, float] = 20.0


@dataclass(frozen=True)
class Stand:
    """Where a run stands at its end, and another may begin: x (n_states,) degC, D (n_states, n_tangents)."""

    x: Array
    D: Array


@dataclass(frozen=True)
class Run:
    """time (nt,); z (nt, n_states + n_boundaries) degC if kept; y (nt, n_rows); dy (nt, n_rows, n_tangents).

    k : (nt, 2, n_states) K/s at both stages of the step that ends there, if kept;  end : for a run that goes on
    """

    time: Array
    z: Array | None
    y: Array
    dy: Array | None
    end: Stand
    k: Array | None = None


def checked_time(time: Array) -> Array:
    """Finite, never falling times (s)."""
    out = np.ascontiguousarray(time, float)
    if out.ndim != 1 or out.size == 0 or not np.all(np.isfinite(out)) or np.any(np.diff(out) < 0):
        raise InputError("times are not finite and rising", "record", "seconds in rising order")
    return out


def boundary_table(network: Network, boundaries: Mapping[str, Array | float], nt: int) -> Array:
    """(nt, n_boundaries) degC in the network's order."""
    out = np.empty((nt, len(network.boundaries)))
    for k, name in enumerate(network.boundaries):
        if name not in boundaries:
            raise InputError(
                f"boundary '{name}' is missing", "record", f"the network needs {', '.join(network.boundaries)}"
            )
        value = np.asarray(boundaries[name], float)
        if value.shape not in ((), (nt,)) or not np.all(np.isfinite(value)):
            raise InputError(
                f"boundary '{name}' is not finite or has shape {value.shape}", "record", f"a number or ({nt},)"
            )
        out[:, k] = value
    return out


def initial_state(network: Network, initial: float | Mapping[str, float]) -> Array:
    """Mean nodes and fluids at the given temperature, hidden shapes "PART#k" at 0 (they have no mean).

    Nodes without heat capacity then take the temperature at which they balance.

    Per place: nodes by name (or by a place on them), the others at the mean of the given ones.
    """
    hidden = np.array(["#" in s for s in network.states], bool)
    if not isinstance(initial, Mapping):
        return np.where(hidden, 0.0, float(initial))
    given: dict[int, list[float]] = {}
    for name, value in initial.items():
        node = network.places[name].part if name not in network.states and name in network.places else name
        column = network.column(node)
        if column < len(network.states):
            given.setdefault(column, []).append(float(value))
    if not given:
        raise InputError("no state has an initial temperature", "record.initial", "a number, or at least one node")
    x = np.where(hidden, 0.0, np.mean([np.mean(v) for v in given.values()]))
    for column, values in given.items():
        x[column] = np.mean(values)
    return x


def simulate(
    network: Network,
    record: Record,
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tangents: Sequence[Parameter] = (),
    keep_states: bool = False,
    begin: Stand | None = None,
) -> Run:
    """Integrate the network over the record.

    values : parameter name -> value; parameters of the network that are not listed stand at their declared value
    rows : linear outputs of z = [x; u] (sensors, before bias, gain and lag)
    tangents : parameters of the network with respect to which y is differentiated: d y / d value for
        mappings "amplitude", "relative" and "offset", d y / d log(value) for "log"
    begin : where another run of the same network, values and tangents ended, at this record's first time
    """
    time = checked_time(record.time)
    core = compiled(network, record.inputs, time.size, values, rows, tangents)
    return march(network, record, core, keep_states, begin=begin)


def march(
    network: Network, record: Record, core: Compiled, keep_states: bool, keep_rates: bool = False,
    begin: Stand | None = None,
) -> Run:  # fmt: skip
    """Run the kernel, from rest of the states without capacity: at the start and wherever a time is given twice."""
    time, u = checked_time(record.time), boundary_table(network, record.boundaries, len(record.time))
    nt, n, nr, p = time.size, core.C.size, core.rows.start.size - 1, core.tangents.dC.shape[1]
    z, k = np.zeros((nt if keep_states else 0, network.size)), np.zeros((nt if keep_rates else 0, 2, n))
    y, dy, longest = np.zeros((nt, nr)), np.zeros((nt, nr, p)), min(nt, PORTION + 1)
    Z, K, renew = np.zeros((longest, network.size)), np.zeros((longest, 2, n)), _renewals(time, core)
    x0 = begin.x if begin else initial_state(network, record.initial)
    both, scratch = stages(x0, u[0], core.terms), work(n, core.terms.m.size, p)
    if begin:
        scratch.D[:] = begin.D
    for part in _parts(time, core.C):
        if part.start > 0 or not begin:
            _rest(network, core, time, u, part.start, both, scratch)
        for some in _portions(part):
            at, own = (time[some], u[some], core.C, core.K0), slice(0, some.stop - some.start)
            terms = core.terms._replace(factor=core.terms.factor[some])
            failed = integrate(*at, terms, core.rows, renew[some], both, scratch, Z[own], K[own], y[some])
            if failed >= 0:
                raise ThermoscopeError(_failure(network, core, time[some.start + failed], both.z[0]))
            if p:
                run = (renew[some], core.curved, Z[own], K[own])
                differentiate(*at, terms, core.tangents, core.rows, *run, both, scratch, dy[some])
            if keep_states:
                z[some] = Z[own]
            if keep_rates:
                k[some.start + 1 : some.stop] = K[1 : own.stop]
    end = Stand(both.z[0, :n].copy(), scratch.D.copy())
    return Run(time, z if keep_states else None, y, dy if p else None, end, k if keep_rates else None)


def _rest(network: Network, core: Compiled, time: Array, u: Array, at: int, both: Stages, scratch: Work) -> None:
    """Before a part of the record that starts at index `at`: boundaries there, states without capacity at balance."""
    both.z[0, core.C.size : -1] = u[at]
    if np.any(core.C == 0.0):
        factor = core.terms.factor[at]
        if not settle(core.C, core.K0, core.terms, core.tangents, factor, both, scratch):
            raise ThermoscopeError(_failure(network, core, time[at], both.z[0]))


def _portions(part: slice) -> list[slice]:
    """A part of the record in portions of so many steps, each from the end of the one before."""
    starts = range(part.start, max(part.stop - 1, part.start + 1), PORTION)
    return [slice(a, min(a + PORTION + 1, part.stop)) for a in starts]


def _renewals(time: Array, core: Compiled) -> NDArray[np.bool_]:
    """(nt,) whether the matrix of the step that ends there differs from that of the step before."""
    terms, stiff = core.terms, core.stiff & (core.terms.m != 0.0)
    if np.any(terms.kind[stiff, BENDS]):
        return np.ones(time.size, bool)
    steps = np.flatnonzero(np.diff(time) > 0.0)
    out, used = np.zeros(time.size, bool), terms.factor[np.ix_(steps, stiff)]
    out[steps[1:] + 1] = np.any(used[1:] != used[:-1], axis=1)
    return out


def _parts(time: Array, C: Array) -> list[slice]:
    """The record between its jumps, if any state has no capacity: there such states start from a new balance."""
    jumps = np.flatnonzero(np.diff(time, prepend=-np.inf) == 0.0) if np.any(C == 0.0) else np.empty(0, int)
    return [slice(a, b) for a, b in pairwise([0, *jumps, time.size])]


def _failure(network: Network, core: Compiled, t: float, z: Array) -> str:
    floating = [s for s, c, row in zip(network.states, core.C, core.K0, strict=True) if c == 0.0 and not np.any(row)]
    if floating:
        hint = f"states without capacity and constant links: {', '.join(floating)}"
        return f"network '{network.name}': no finite solution at t = {t:g} s; {hint}"
    x = np.where(np.isfinite(z[: len(network.states)]), np.abs(z[: len(network.states)]), np.inf)
    return told(network, network.states[int(np.argmax(x))], t)
