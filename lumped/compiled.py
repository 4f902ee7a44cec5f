"""From a Network, a set of values and the inputs of a record to the flat arrays of the kernel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lumped.assembly import assembly, floats, ints, starts
from lumped.kernel import Rows
from lumped.multipliers import multipliers, slopes
from lumped.network import Network, Parameter, Row
from lumped.signals import Signals
from lumped.tangents import Tangents
from lumped.terms import DYNAMIC, STIFF, Terms

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Compiled:
    """What the kernel takes: capacities, constant matrix, terms (named by `names`), tangents and rows."""

    C: Array
    K0: Array
    names: tuple[str, ...]
    terms: Terms
    tangents: Tangents
    rows: Rows

    @property
    def stiff(self) -> NDArray[np.bool_]:
        """(ne,) which terms are dynamic and touch the matrix."""
        return self.terms.kind[:, DYNAMIC] * self.terms.kind[:, STIFF] == 1

    @property
    def curved(self) -> bool:
        """Whether any dynamic term touches the matrix."""
        return bool(np.any(self.stiff))


def capacity_multipliers(network: Network, m: Mapping[str, float]) -> Array:
    groups = network.capacity_group or network.states
    return np.array([m.get(f"capacity:{g}", 1.0) for g in groups])


def pack_rows(rows: Sequence[Row]) -> Rows:
    return Rows(starts([r.index for r in rows]), ints([r.index for r in rows]), floats([r.weights for r in rows]))


def _pack_tangents(network: Network, slope: Sequence[Mapping[str, float]], names: Sequence[str]) -> Tangents:
    moved = [(j, names.index(t), s) for j, d in enumerate(slope) for t, s in d.items() if t in names and s != 0.0]
    dC = (
        np.stack([network.C * capacity_slopes(network, d) for d in slope], axis=1)
        if slope
        else np.zeros((len(network.C), 0))
    )
    return Tangents(
        np.array([x[0] for x in moved], np.int64), np.array([x[1] for x in moved], np.int64),
        np.array([x[2] for x in moved], float), np.ascontiguousarray(dC),
    )  # fmt: skip


def capacity_slopes(network: Network, slope: Mapping[str, float]) -> Array:
    groups = network.capacity_group or network.states
    return np.array([slope.get(f"capacity:{g}", 0.0) for g in groups])


def compiled(
    network: Network,
    inputs: Mapping[str, Array | float],
    nt: int,
    values: Mapping[str, float] | None = None,
    rows: Sequence[Row] = (),
    tangents: Sequence[Parameter] = (),
    all_terms: bool = False,
) -> Compiled:
    """The kernel's view. Terms that are steady and that no tangent moves exist in the constant matrix only."""
    every, signals = assembly(network), inputs if isinstance(inputs, Signals) else Signals(inputs, nt)
    acting, slope = multipliers(network, values), slopes(network, values, tangents)
    m = np.array([acting.get(name, 1.0) for name in every.names])
    factors = [signals.factor(p.name, p.law) for p in every.patterns]
    steady = ~every.bends & np.array([f.ndim == 0 for f in factors], bool)
    watched = {target for d in slope for target in d}
    live = all_terms | np.array([name in watched for name in every.names], bool) | ~(steady | (m == 0.0))
    constant = np.array([float(f) if s else 0.0 for f, s in zip(factors, steady, strict=True)])
    names = tuple(name for name, alive in zip(every.names, live, strict=True) if alive)
    factor = np.empty((nt, len(names)))
    for e, k in enumerate(np.flatnonzero(live)):
        factor[:, e] = factors[k]
    return Compiled(
        network.C * capacity_multipliers(network, acting),
        every.matrix(m * constant),
        names,
        every.packed(live, steady)._replace(m=m[live], factor=factor),
        _pack_tangents(network, slope, names),
        pack_rows(rows),
    )
