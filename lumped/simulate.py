"""Run a network over a record, with exact tangents of the discrete scheme.

run = simulate(network, Record(time, inputs, boundaries, initial), values, rows, tangents)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError, ThermoscopeError
from lumped.compiled import Compiled, compiled
from lumped.network import Network, Parameter, Row

Array = NDArray[np.float64]


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
class Run:
    """time (nt,); z (nt, n_states + n_boundaries) degC if kept; y (nt, n_rows); dy (nt, n_rows, n_tangents).

    heat : (nt, n_terms) J that went through every link and source since the start, if counted (see balance.py)
    """

    time: Array
    z: Array | None
    y: Array
    dy: Array | None
    heat: Array | None = None


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
) -> Run:
    """Integrate the network over the record.

    values : parameter name -> value; parameters of the network that are not listed stand at their declared value
    rows : linear outputs of z = [x; u] (sensors, before bias, gain and lag)
    tangents : parameters of the network with respect to which y is differentiated: d y / d value for
        mappings "amplitude", "relative" and "offset", d y / d log(value) for "log"
    """
    time = checked_time(record.time)
    core = compiled(network, record.inputs, time.size, values, rows, tangents)
    return march(network, record, core, np.zeros(core.terms.row.size), keep_states)


def march(
    network: Network, record: Record, core: Compiled, through: Array, keep_states: bool, count: bool = False
) -> Run:
    """Run the kernel; `through` (rows of all terms,) says which rows count as the heat through a term."""
    from lumped.kernel import integrate, stages, work

    time = checked_time(record.time)
    nt, nr, p = time.size, core.rows.start.size - 1, core.tangents.dC.shape[1]
    z, heat = np.zeros((nt if keep_states else 0, network.size)), np.zeros((nt if count else 0, len(core.names)))
    y, dy = np.zeros((nt, nr)), np.zeros((nt, nr, p))
    scratch = work(core.C.size, core.terms.m.size, p)
    u, x0 = boundary_table(network, record.boundaries, nt), initial_state(network, record.initial)
    failed = integrate(
        time, u, core.C, core.K0, core.terms, core.tangents, core.rows, through,
        core.curved, bool(np.any(core.C == 0.0)),
        stages(x0, u[0], core.terms), scratch, z, y, dy, heat,
    )  # fmt: skip
    if failed >= 0:
        raise ThermoscopeError(_failure(network, core, time[failed]))
    return Run(time, z if keep_states else None, y, dy if p else None, heat if count else None)


def _failure(network: Network, core: Compiled, t: float) -> str:
    floating = [s for s, c, row in zip(network.states, core.C, core.K0, strict=True) if c == 0.0 and not np.any(row)]
    hint = (
        f"states without capacity and constant links: {', '.join(floating)}" if floating else "check the links' signs"
    )
    return f"network '{network.name}': no finite solution at t = {t:g} s; {hint}"
