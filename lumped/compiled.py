"""From a Network, a set of values and the inputs of a record to the flat arrays of the kernel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError
from lumped import laws
from lumped.kernel import Rows, Tangents
from lumped.multipliers import multipliers, slopes
from lumped.network import Link, Network, Parameter, Row, Source
from lumped.terms import CONSTANT, DYNAMIC, LINEAR, POWER, RADIATION, STIFF, TABLE, Terms

Array = NDArray[np.float64]
NOTHING = Row(np.empty(0, np.int64), np.empty(0))


@dataclass(frozen=True)
class Term:
    """A link or source as a pattern over z+ = [x; u; 1] with its law, multiplier and input factor (number or (nt,))."""

    name: str
    rows: NDArray[np.int64]
    cols: NDArray[np.int64]
    vals: Array
    law: laws.Law
    hot: Row
    cold: Row
    m: float
    factor: Array

    @property
    def bends(self) -> bool:
        return not isinstance(self.law.temperature, laws.Constant)

    @property
    def steady(self) -> bool:
        return not self.bends and self.factor.ndim == 0

    def stiff(self, n: int) -> bool:
        return self.bends or bool(np.any(self.cols < n))


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
    def curved(self) -> bool:
        """Whether any dynamic term touches the matrix."""
        return bool(np.any(self.terms.kind[:, DYNAMIC] * self.terms.kind[:, STIFF]))


def checked_inputs(network: Network, inputs: Mapping[str, Array | float], nt: int) -> dict[str, Array]:
    """Every input as a finite array (nt,)."""
    out = {}
    for name, value in inputs.items():
        array = np.asarray(value, float)
        if array.shape not in ((), (nt,)):
            raise InputError(
                f"input '{name}' has shape {array.shape}", f"network '{network.name}'", f"a number or ({nt},)"
            )
        if not np.all(np.isfinite(array)):
            raise InputError(
                f"input '{name}' is not finite everywhere", f"network '{network.name}'", "fill its gaps first"
            )
        out[name] = np.broadcast_to(array, (nt,))
    return out


def _factor(item: Link | Source, inputs: Mapping[str, Array], nt: int) -> Array:
    missing = [name for name in item.law.reads if name not in inputs]
    if missing:
        known = ", ".join(sorted(inputs)) or "none"
        raise InputError(f"input '{missing[0]}' is missing", f"'{item.name}'", f"given: {known}")
    value = np.asarray(item.law.factor(inputs), float)
    if value.shape not in ((), (nt,)) or not np.all(np.isfinite(value)):
        raise InputError(
            f"the input factor is not finite or has shape {value.shape}", f"'{item.name}'", f"finite, () or ({nt},)"
        )
    constant = value.ndim == 1 and bool(np.all(value == value[0]))
    return np.asarray(value[0]) if constant else value


def _link(link: Link, m: float, factor: Array) -> Term:
    return Term(link.name, link.rows, link.cols, link.vals, link.law, link.hot, link.cold, m, factor)


def _source(source: Source, m: float, factor: Array, size: int) -> Term:
    cols = np.full(len(source.index), size, np.int64)
    return Term(source.name, source.index, cols, -source.weights, source.law, source.probe, NOTHING, m, factor)


def terms_of(network: Network, inputs: Mapping[str, Array], m: Mapping[str, float], nt: int) -> list[Term]:
    """All links, then all sources."""
    links = [_link(x, m.get(x.name, 1.0), _factor(x, inputs, nt)) for x in network.links]
    sources = [_source(x, m.get(x.name, 1.0), _factor(x, inputs, nt), network.size) for x in network.sources]
    return links + sources


def _law_code(law: laws.TemperatureLaw) -> tuple[int, float, float]:
    if isinstance(law, laws.Power):
        return POWER, law.exponent, 0.0
    if isinstance(law, laws.Radiation):
        return RADIATION, 0.0, 0.0
    if isinstance(law, laws.Linear):
        return LINEAR, law.alpha, law.reference
    return (TABLE if isinstance(law, laws.Table) else CONSTANT), 0.0, 0.0


def _table(law: laws.TemperatureLaw) -> Array:
    points = [law.difference, law.value] if isinstance(law, laws.Table) else [(), ()]
    return np.ascontiguousarray(np.array(points, float).T)


def _start(parts: Sequence[Sequence | NDArray]) -> NDArray[np.int64]:
    return np.concatenate([[0], np.cumsum([len(p) for p in parts])]).astype(np.int64)


def _floats(parts: Sequence[Sequence | NDArray]) -> Array:
    return np.concatenate([np.empty(0), *(np.asarray(p, float) for p in parts)])


def _ints(parts: Sequence[Sequence | NDArray]) -> NDArray[np.int64]:
    return np.concatenate([np.empty(0, np.int64), *(np.asarray(p, np.int64) for p in parts)])


def _columns(factors: Sequence[Array], nt: int) -> Array:
    out = np.empty((nt, len(factors)))
    for e, factor in enumerate(factors):
        out[:, e] = factor
    return out


def pack(terms: Sequence[Term], n: int, nt: int) -> Terms:
    """Flat arrays of the terms; a term stands in the constant matrix (dynamic 0) when it is steady."""
    unique = [np.unique(t.rows, return_inverse=True) for t in terms]
    tables = [_table(t.law.temperature) for t in terms]
    codes = [_law_code(t.law.temperature) for t in terms]
    rows = _start([u[0] for u in unique])
    seen = [(t.hot, t.cold) if t.bends else (NOTHING, NOTHING) for t in terms]
    at = [_ints([t.cols, hot.index, cold.index]) for t, (hot, cold) in zip(terms, seen, strict=True)]
    to = [
        np.concatenate([rows[e] + u[1], np.repeat(rows[-1] + 2 * e + np.arange(2), [x.index.size for x in s])])
        for e, (u, s) in enumerate(zip(unique, seen, strict=True))
    ]
    return Terms(
        start=np.column_stack([_start(at), rows, _start(tables)]),
        to=_ints(to),
        at=_ints(at),
        weight=_floats(
            [x for t, (hot, cold) in zip(terms, seen, strict=True) for x in (t.vals, hot.weights, cold.weights)]
        ),
        row=_ints([u[0] for u in unique]),
        kind=np.array(
            [(c[0], not t.steady, t.stiff(n), t.bends) for c, t in zip(codes, terms, strict=True)], np.int64
        ).reshape(-1, 4),
        par=np.array([c[1:] for c in codes], float).reshape(-1, 2),
        point=np.concatenate([np.empty((0, 2)), *tables]),
        m=np.array([t.m for t in terms], float),
        factor=_columns([t.factor for t in terms], nt),
    )


def constant_matrix(terms: Sequence[Term], n: int, size: int) -> Array:
    """K0 (n, size + 1): the sum of the steady terms; one without effect leaves it as it is, to the bit."""
    K0 = np.zeros((n, size + 1))
    for t in terms:
        if t.steady and t.m != 0.0:
            np.add.at(K0, (t.rows, t.cols), t.m * float(t.factor) * t.vals)
    return K0


def capacity_multipliers(network: Network, m: Mapping[str, float]) -> Array:
    groups = network.capacity_group or network.states
    return np.array([m.get(f"capacity:{g}", 1.0) for g in groups])


def pack_rows(rows: Sequence[Row]) -> Rows:
    return Rows(_start([r.index for r in rows]), _ints([r.index for r in rows]), _floats([r.weights for r in rows]))


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
    n, m = len(network.states), multipliers(network, values)
    terms = terms_of(network, checked_inputs(network, inputs, nt), m, nt)
    slope = [slopes(network, values, p) for p in tangents]
    watched = {target for d in slope for target in d}
    live = [t for t in terms if all_terms or t.name in watched or not (t.steady or t.m == 0.0)]
    names = tuple(t.name for t in live)
    return Compiled(
        network.C * capacity_multipliers(network, m),
        constant_matrix(terms, n, network.size),
        names,
        pack(live, n, nt),
        _pack_tangents(network, slope, names),
        pack_rows(rows),
    )
