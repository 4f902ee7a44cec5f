"""Whether the films of a run stayed where they are known: what went beyond is said with its value and range."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from geom.arrays import Array, Ints
from lumped.numerics.terms import COLD, HOT, PLACE, SOURCE, Forcing
from lumped.transfer.laws import FilmTable, StreamTable, Table
from lumped.transfer.ranges import Domain, out_of_range

if TYPE_CHECKING:
    from lumped.integration.compiled import Compiled

SMALL = 1e-12  # K


class Span(NamedTuple):
    """What a table knows, of `times` hot + cold (degC), or where that is 0 of |hot - cold| (K): from low to high."""

    what: str
    times: float
    low: float
    high: float


class Furthest(NamedTuple):
    """Of a term: what its correlation follows, and its fluid's temperature (degC); outside its excess is above 1."""

    term: int
    excess: float
    size: float
    degC: float


INSIDE = Furthest(-1, 1.0, 0.0, 0.0)


class Reach:
    """What the tables of some terms, and the correlations behind them, have seen that lies furthest out."""

    def __init__(self, core: "Compiled") -> None:
        self.core, self.terms = core, core.terms
        spans, domains = dict[Any, int](), dict[Any, int]()
        for e in np.flatnonzero(self.terms.m != 0.0)[::-1].tolist():
            sides = tuple(self.terms.part[e, [HOT, COLD]].tolist())
            spans.update({(*sides, span): e for span in self._spans(e)})
            if (domain := self._domain(e)) is not None:
                domains[(*sides, int(self.terms.part[e, PLACE]), domain)] = e
        # one for all films of a face that end at the same
        self.spans = [(e, span) for (*_, span), e in reversed(spans.items())]
        self.domains = [(e, domain) for (*_, domain), e in reversed(domains.items())]
        self.low, self.high = np.full(len(spans), np.inf), np.full(len(spans), -np.inf)
        self.furthest: dict[tuple[Domain | None, str], Furthest] = {}
        self.largest: dict[int, Furthest] = {}  # difference of still air: from rest every run begins at none

    def _alone(self, e: int) -> bool:
        """Whether its law sees one temperature."""
        cold = self.terms.part[e, COLD]
        return bool(self.terms.begin[cold] == self.terms.begin[cold + 1])

    def _domain(self, e: int) -> Domain | None:
        """Of the correlation behind its table, if any."""
        return getattr(self.core.tables[e], "domain", None)

    def _spans(self, e: int) -> Iterator[Span]:
        table, alone = self.core.tables[e], self._alone(e)
        fluid = "copper" if self.terms.kind[e, SOURCE] else "coolant"
        times, of = (1.0, f"its {fluid} at {{:.4g}} degC") if alone else (0.5, "its film at {:.4g} degC")
        if isinstance(table, StreamTable):
            yield Span(of, times, times * table.total[0], times * table.total[-1])
        elif isinstance(table, Table) and alone:
            yield Span(of, times, table.difference[0], table.difference[-1])
        elif isinstance(table, Table | FilmTable):
            yield Span("{:.4g} K beside its air", 0.0, 0.0, table.difference[-1])
            if isinstance(table, FilmTable) and table.follows:
                yield Span(of, times, *table.films)

    def see(self, z: Array, forcing: Forcing, knot: Ints) -> None:
        """States and boundaries (k, n + nb), each before one of the knots (k,)."""
        for k, (e, span) in enumerate(self.spans):
            hot, cold = self._row(e, HOT, z), self._row(e, COLD, z)
            value = span.times * (hot + cold) if span.times else np.abs(hot - cold)
            self.low[k], self.high[k] = min(self.low[k], value.min()), max(self.high[k], value.max())
        for e, domain in self.domains:
            self._ask(e, domain, self._row(e, HOT, z), self._row(e, COLD, z), forcing, knot)

    def _ask(self, e: int, domain: Domain, hot: Array, cold: Array, forcing: Forcing, knot: Ints) -> None:
        """Of what lies inside the table: how far it lies outside the correlation."""
        table, share = self.core.tables[e], 1.0 if self._alone(e) else 0.5
        T, size, acts = share * (hot + cold), np.abs(hot - cold), _largest(forcing, e, knot) > 0.0
        if isinstance(table, StreamTable):
            size = _largest(forcing, int(self.terms.part[e, PLACE]), knot)
            inside = (size > 0.0) & (share * table.total[0] <= T) & (share * table.total[-1] >= T)
        else:
            assert isinstance(table, FilmTable)
            T = T if table.follows else np.full(T.shape, table.films[0])
            inside = (size <= table.difference[-1]) & (table.films[0] <= T) & (table.films[1] >= T)
        T, size = T[acts & inside], size[acts & inside]
        if not domain.degC or not T.size:
            self._keep(domain, "anywhere", e, np.full(T.size, np.inf), size, T)
            return
        coldest, warmest = domain.degC[0], domain.degC[-1]
        self._keep(domain, "cold", e, 1.0 + coldest - T, size, T)
        self._keep(domain, "warm", e, 1.0 + T - warmest, size, T)
        there = (coldest <= T) & (warmest >= T)
        T, size = T[there], size[there]
        low, high = table.ends(T, share) if isinstance(table, StreamTable) else domain.ends(T)
        self._keep(domain, "high", e, size / high, size, T)
        if isinstance(table, StreamTable):
            self._keep(domain, "low", e, low / size, size, T)
        elif T.size:
            k = int(np.argmax(size))
            largest = Furthest(e, float(low[k] / max(size[k], SMALL)), float(size[k]), float(T[k]))
            self.largest[e] = max(self.largest.get(e, INSIDE), largest, key=lambda point: point.size)

    def _keep(self, domain: Domain | None, side: str, e: int, excess: Array, size: Array, degC: Array) -> None:
        if excess.size and excess.max() > self.furthest.get((domain, side), INSIDE).excess:
            k = int(np.argmax(excess))
            self.furthest[domain, side] = Furthest(e, float(excess[k]), float(size[k]), float(degC[k]))

    def _row(self, e: int, side: int, z: Array) -> Any:
        T, row = self.terms, self.terms.part[e, side]
        some = slice(T.begin[row], T.begin[row + 1])
        return z[:, T.at[some]] @ T.weight[some]

    def tell(self) -> None:
        """A RangeWarning for each that left its table, in which it is held, or its correlation."""
        names = self.core.names
        for k, (e, (what, _, low, high)) in enumerate(self.spans):
            for extreme, outside in ((self.low[k], self.low[k] < low), (self.high[k], self.high[k] > high)):
                if outside:
                    out_of_range(f"{names[e]}: {what.format(extreme)} outside {low:g} to {high:g}")
        for e, (_, *point) in self.largest.items():
            self._keep(self._domain(e), "low", e, *(np.array([x]) for x in point))
        for e, _, size, degC in self.furthest.values():
            table = self.core.tables[e]
            assert isinstance(table, FilmTable | StreamTable)
            out_of_range(f"{names[e]}: {table.left(size, degC, 1.0 if self._alone(e) else 0.5)}")


def tell_reach(core: "Compiled", z: Array) -> None:
    """What a network at rest left, at its temperatures z (n + nb,)."""
    reach = Reach(core)
    reach.see(z[None, :], core.forcing, np.zeros(1, np.int64))
    reach.tell()


def _largest(forcing: Forcing, column: int, knot: Ints) -> Array:
    """|factor| in the interval before each knot: at its ends and in the middle."""
    last, first = forcing.factor[knot, column], forcing.factor[np.maximum(knot - 1, 0), column]
    middle = 0.5 * (first + last) + forcing.bulge[knot, column]
    return np.asarray(np.abs([first, middle, last]).max(axis=0))
