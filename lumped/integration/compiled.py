"""From a Network, a set of values and the inputs of a record to the flat arrays of the kernel."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from geom.arrays import Array, Ints, Mask
from lumped.integration.assembly import Assembly, InputSize, Pattern, assembly, floats, ints, starts
from lumped.integration.forcing import boundary_table, checked_time, forcing, with_boundaries
from lumped.integration.record import Record
from lumped.integration.signals import Signals
from lumped.model.multipliers import multipliers, slopes
from lumped.model.network import Network, Parameter, Row
from lumped.model.once import once
from lumped.numerics.dense import Structure
from lumped.numerics.kernel import Control, Rows
from lumped.numerics.tangents import Tangents
from lumped.numerics.terms import BENDS, DYNAMIC, STIFF, Forcing, Terms
from lumped.transfer.laws import TemperatureLaw

HOTTEST = 3000.0  # degC: beyond, no part of a machine exists
FINER = 100.0  # as exact: next to nothing is left of the error then, in 5 times the steps
SHARE = 0.03  # of what parabolas may miss: they are a third as wide then


class Precision(NamedTuple):
    """error_K, error_share : what a step may be wrong by: K, and of the range of temperatures

    every_sample : end a step at every sample, whether the inputs ask for that or not: for runs in turn, whose inputs
        change a little from one to the next
    missed : of what parabolas may miss between samples;  merged : of the largest factor between two samples, what those
        may miss that keep all integrals, where inputs were recorded more often than that
    """

    error_K: float
    error_share: float
    every_sample: bool
    missed: float = 1.0
    merged: float = 0.0

    @property
    def finer(self) -> "Precision":
        """What tells the error of this one."""
        return Precision(self.error_K / FINER, self.error_share / FINER, self.every_sample, self.missed * SHARE)


# A hundredth of a kelvin and of a per cent: a tenth of what a good sensor is sure of.
RUN = Precision(1e-2, 1e-4, False)
READINGS = RUN._replace(every_sample=True)
# A run then moves by 0.002 K (rms) at most; a quarter to a third of the steps go, of a drive cycle two thirds.
FIT = Precision(5e-2, 5e-4, True, merged=0.2)


@dataclass(frozen=True)
class Compiled:
    """What the kernel takes: capacities, constant matrix, terms (named by `names`), what drives them, ...

    elimination : looked for when a run asks, which a rest does not: 7 s of 1900 states
    tables : the temperature laws of the terms
    """

    C: Array
    K0: Array
    names: tuple[str, ...]
    terms: Terms
    forcing: Forcing
    tangents: Tangents
    rows: Rows
    control: Control
    elimination: Callable[[], tuple[Ints, Structure]]
    tables: tuple[TemperatureLaw, ...]

    @property
    def order(self) -> Ints:
        """(n,) in which the states are best eliminated."""
        return self.elimination()[0]

    @property
    def structure(self) -> Structure:
        """Of an LU in that order."""
        return self.elimination()[1]

    @property
    def stiff(self) -> Mask:
        """(ne,) which terms are dynamic and touch the matrix."""
        return self.terms.kind[:, DYNAMIC] * self.terms.kind[:, STIFF] == 1

    @property
    def curved(self) -> bool:
        """Whether any dynamic term touches the matrix."""
        return bool(np.any(self.stiff))


def reordered(core: Compiled) -> Compiled:
    """The same with its states in the order of elimination."""
    order, nz = core.order, core.K0.shape[1]
    columns = np.concatenate([order, np.arange(order.size, nz)])
    place = np.argsort(columns)
    T, S, L = core.terms, core.tangents, core.control
    return replace(
        core,
        C=core.C[order],
        K0=np.ascontiguousarray(core.K0[np.ix_(order, columns)]),
        terms=T._replace(row=place[T.row], at=place[T.at]),
        rows=core.rows._replace(at=place[core.rows.at], state=columns[:-1]),
        tangents=S._replace(state=place[S.state], first=S.first[columns[:-1]]),
        control=L._replace(unit=L.unit[order], node=L.node[order]),
    )


def capacity_multipliers(network: Network, m: Mapping[str, float]) -> Array:
    groups = network.capacity_group or network.states
    return np.array([m.get(f"capacity:{g}", 1.0) for g in groups])


def pack_rows(rows: Sequence[Row], size: int) -> Rows:
    """Outputs of a network whose states and boundaries are `size` in all."""
    at, weight = [r.index for r in rows], [r.weights for r in rows]
    return Rows(starts(at), ints(at), floats(weight), np.arange(size))


def _pack_tangents(
    network: Network, slope: Sequence[Mapping[str, float]], names: Sequence[str], shifts: Sequence[str | None]
) -> Tangents:
    triplets = [(j, names.index(t), s) for j, d in enumerate(slope) for t, s in d.items() if t in names and s != 0.0]
    dC = np.zeros((len(slope), len(network.C)))
    for j in (j for j, d in enumerate(slope) if any(t.startswith("capacity:") for t in d)):
        dC[j] = network.C * capacity_slopes(network, slope[j])
    column, state = map(np.ascontiguousarray, np.nonzero(dC))  # columns of one array: another layout compiles anew
    hidden = hidden_states(network)
    first = np.zeros((hidden.size + len(network.boundaries), len(slope) + len(shifts)))
    every = (*network.states, *network.boundaries)
    for j, name in enumerate(shifts, len(slope)):
        first[every.index(name) if name else np.flatnonzero(~hidden), j] = 1.0
    tangent, term = (np.array([x[k] for x in triplets], np.int64) for k in (0, 1))
    return Tangents(tangent, term, np.array([x[2] for x in triplets], float), state, column, dC[column, state], first)


@once
def hidden_states(network: Network) -> Mask:
    """(n,) which states are amplitudes of shapes, which have no mean."""
    return np.array(["#" in s for s in network.states], bool)


def capacity_slopes(network: Network, slope: Mapping[str, float]) -> Array:
    groups = network.capacity_group or network.states
    return np.array([slope.get(f"capacity:{g}", 0.0) for g in groups])


def compiled(
    network: Network,
    record: Record,
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tangents: Sequence[Parameter] = (),
    all_terms: bool = False,
    precision: Precision = RUN,
    shifts: Sequence[str | None] = (),
) -> Compiled:
    """The kernel's view. Terms that are steady and that no tangent moves exist in the constant matrix only."""
    time = checked_time(record.time)
    inputs, u = record.inputs, boundary_table(network, record.boundaries, time.size)
    every, signals = assembly(network), inputs if isinstance(inputs, Signals) else Signals(inputs, time.size)
    signals = signals if precision.missed == 1.0 else signals.exact(precision.missed)
    acting, slope = multipliers(network, values), slopes(network, values, tangents)
    m = np.array([acting.get(name, 1.0) for name in every.names])
    curves = [signals.curve(p.name, p.law) for p in every.patterns]
    factors = [c.value for c in curves]
    steady = ~every.bends & np.array([f.ndim == 0 for f in factors], bool)
    targets = {target for d in slope for target in d}
    live = all_terms | np.array([name in targets for name in every.names], bool) | ~(steady | (m == 0.0))
    constant = np.array([float(f) if s else 0.0 for f, s in zip(factors, steady, strict=True)])
    alive = np.flatnonzero(live)
    names, patterns = tuple(every.names[k] for k in alive), [every.patterns[k] for k in alive]
    terms = every.packed(live, steady)._replace(m=m[live])
    moving = (m[live] != 0.0) & ~steady[live]
    stiff = moving & (terms.kind[:, STIFF] == 1)
    bends = bool(np.any(terms.kind[stiff, BENDS]))
    sizes = every.input_sizes(live)
    course, others = [curves[k] for k in alive], np.zeros(len(sizes), bool)
    course += [signals.curve(x.name, x.law) for x in sizes]
    of_terms: list[Pattern | InputSize] = [*patterns, *sizes]
    moves, touches = np.append(moving, ~others), np.append(stiff, others)

    def driven() -> tuple[Forcing, Array]:
        how = (precision.every_sample, precision.merged)
        return forcing(time, u, signals, of_terms, course, moves, touches, bends, *how)

    if precision.merged:
        key = (time.tobytes(), moves.tobytes(), touches.tobytes(), bends, precision.merged)
        drive = with_boundaries(*signals.driven(key, course, driven), u)
    else:
        drive, _ = driven()
    return Compiled(
        network.C * capacity_multipliers(network, acting),
        every.matrix(m * constant),
        names,
        terms,
        drive,
        _pack_tangents(network, slope, names, shifts),
        pack_rows(rows, network.size),
        control(network, every, m, factors, precision),
        partial(every.elimination, m != 0.0),
        tuple(p.law.temperature for p in patterns),
    )


def control(
    network: Network, every: Assembly, m: Array, factors: Sequence[Array], precision: Precision = RUN
) -> Control:
    """What a step has to pass. The maximum principle holds where every acting link has positive coefficients alone."""
    hidden = hidden_states(network)
    acts = [(p, x, f) for p, x, f in zip(every.patterns, m.tolist(), factors, strict=True) if x != 0.0 and not p.heats]
    holds = not hidden.any() and all(p.monotone and x * _extreme(f, x > 0.0) >= 0.0 for p, x, f in acts)
    units, limits = state_units(network), np.array([precision.error_K, precision.error_share])
    visible, holding = (~hidden).astype(np.int64), np.array([holds], np.int64)
    return Control(units, visible, limits, holding, np.array([HOTTEST]), np.zeros(1, np.int64))


def _extreme(f: Array, least: bool) -> float:
    """The least or the largest of a factor; a number needs no search."""
    return float(f) if f.ndim == 0 else float(f.min() if least else f.max())


@once
def state_units(network: Network) -> Array:
    """(n,) K that a unit of every state makes: for a shape the largest mean square over the faces it touches."""
    hidden = hidden_states(network)
    out = np.where(hidden, 0.0, 1.0)
    for place in network.places.values() if hidden.any() else ():
        inside = place.states < hidden.size
        mean_square = np.diag(place.K) / (place.area if place.kind == "surface" and place.area else 1.0)
        at = place.states[inside]
        out[at] = np.where(hidden[at], np.maximum(out[at], np.sqrt(np.maximum(mean_square[inside], 0.0))), out[at])
    return out
