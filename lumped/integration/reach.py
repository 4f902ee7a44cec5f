"""Whether the films of a run stayed where their fluids are known: what went beyond is said with its value and range."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from geom.arrays import Array
from lumped.numerics.terms import CODE, COLD, FILM, HOT, LAST, POINT, SOURCE, STREAM, TABLE, Terms
from lumped.transfer.laws import FILMS, FIRST_C, STEP_K
from lumped.transfer.ranges import out_of_range

LAST_C = FIRST_C + STEP_K * (FILMS - 1)  # film temperature at which tables of still air end


class Span(NamedTuple):
    """What a table knows, of `times` hot + cold (degC), or where that is 0 of |hot - cold| (K): from low to high."""

    what: str
    times: float
    low: float
    high: float


class Reach:
    """The least and largest film temperature and difference (degC, K) that every table of some terms has seen."""

    def __init__(self, terms: Terms) -> None:
        self.terms = terms
        spans = {
            (*terms.part[e, [HOT, COLD]].tolist(), span): e
            for e in np.flatnonzero(terms.m != 0.0)[::-1].tolist()
            for span in self._spans(e)
        }  # one for all films of a face that end at the same
        self.spans = [(e, span) for (_, _, span), e in reversed(spans.items())]
        self.low, self.high = np.full(len(spans), np.inf), np.full(len(spans), -np.inf)

    def _spans(self, e: int) -> Iterator[Span]:
        T, (first, last), cold = self.terms, self.terms.part[e, [POINT, LAST]], self.terms.part[e, COLD]
        code, count, alone = T.kind[e, CODE], int(T.par[e, 0]), T.begin[cold] == T.begin[cold + 1]
        fluid = "copper" if T.kind[e, SOURCE] else "coolant"
        times, of = (1.0, f"its {fluid} at {{:.4g}} degC") if alone else (0.5, "its film at {:.4g} degC")
        beside = "{:.4g} K beside its air"
        if code == STREAM:
            yield Span(of, times, times * T.point[first, 0], times * T.point[first + count - 1, 0])
        elif code == TABLE and alone:
            yield Span(of, times, T.point[first, 0], T.point[last - 1, 0])
        elif code == TABLE:
            yield Span(beside, 0.0, 0.0, T.point[last - 1, 0])
        elif code == FILM:
            yield Span(beside, 0.0, 0.0, T.point[first + count - 1, 0])
            if np.ptp(T.point[first:last, 1].reshape(FILMS, count), axis=0).any():  # else its air is of one temperature
                yield Span(of, times, FIRST_C, LAST_C)

    def see(self, z: Array) -> None:
        """States and boundaries (k, n + nb)."""
        for k, (e, span) in enumerate(self.spans):
            hot, cold = self._row(e, HOT, z), self._row(e, COLD, z)
            value = span.times * (hot + cold) if span.times else np.abs(hot - cold)
            self.low[k], self.high[k] = min(self.low[k], value.min()), max(self.high[k], value.max())

    def _row(self, e: int, side: int, z: Array) -> Any:
        T, row = self.terms, self.terms.part[e, side]
        some = slice(T.begin[row], T.begin[row + 1])
        return z[:, T.at[some]] @ T.weight[some]

    def tell(self, names: Sequence[str]) -> None:
        """A RangeWarning for each that left its table, in which it is held."""
        for k, (e, (what, _, low, high)) in enumerate(self.spans):
            for extreme, outside in ((self.low[k], self.low[k] < low), (self.high[k], self.high[k] > high)):
                if outside:
                    out_of_range(f"{names[e]}: {what.format(extreme)} outside {low:g} to {high:g}")
