"""The input factor of any law: exactly where its form is known, else as a table as close as TOLERANCE.

What cannot be is refused: a law of time or of the whole record, one of three inputs at once of unknown form.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from extras.export.expansion import expanded
from extras.export.products import Mapped, Product, Sum, Tabulated
from thermoscope import InputError
from thermoscope import plugin as th

Ranges = Mapping[str, tuple[float, float]]
TOLERANCE = 2e-4  # of the largest factor: a table adds as little as the parabolas of a simulation miss
FIRST, FINEST = 17, 4097  # points of a table
GRID = 65  # points from 0 along each input of a table of two
DOUBLINGS = 10  # a thousand times the level: a root of the third order has grown tenfold there
CHECKED = np.array([0.25, 0.5, 0.75])  # of every cell


def factors(name: str, law: th.Law, ranges: Ranges) -> Sum:
    """The input factor of the law of a link or source; tables of unknown laws reach over the given ranges of inputs.

    Raises InputError for a law that has no such form.
    """
    if law.looks_at_all:
        raise _refused(f"'{name}' follows the record's time, which exported code does not have")
    for one in law.reads:
        if one not in ranges:
            raise _refused(f"'{name}' follows '{one}', which belongs to one test and not to the machine")
    if isinstance(law, th.ExponentError):
        turn = _line(name, ExponentRatio(law), law.input, {law.input: saturated(law, *ranges[law.input])})
        return tuple(p.times(turn) for p in factors(name, law.base, ranges))
    expansion = expanded(law)
    return _table(name, law, ranges) if expansion is None else expansion


def saturated(law: th.ExponentError, low: float, high: float) -> tuple[float, float]:
    """The range of an input wide enough that beyond it the ratio of an exponent does not change, as far as it ever is.

    A table that ended with the tests' range would be another model beyond it.
    """
    ratio, end = ExponentRatio(law), max(abs(low), abs(high), law.reference[law.input])
    with th.within_silence():  # a table reaches beyond what correlations know; whoever runs there is told
        for _ in range(DOUBLINGS):
            if float(np.abs(ratio.factor({law.input: np.array([end])}))[0]) >= th.FARTHEST:
                break
            end *= 2.0
    return (-end if low < 0.0 else 0.0), end


def _refused(what: str) -> InputError:
    return InputError(what, "--as", "take that effect out first (thermoscope model remove), or export the workbook")


@dataclass(frozen=True)
class ExponentRatio(th.Law):
    """By what an exponent of one input moves a law, over the law itself; it depends on that input alone."""

    error: th.ExponentError

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.error.input,)

    def factor(self, inputs: th.Inputs) -> th.Array | float:
        now = np.abs(np.asarray(inputs[self.error.input], float))
        level = {k: np.full_like(now, v) for k, v in self.error.reference.items()}
        at, right = (
            np.abs(np.asarray(self.error.base.size(u), float)) for u in ({**level, self.error.input: now}, level)
        )
        return np.asarray(np.clip(np.log(np.maximum(at, 1e-12 * right) / right), -th.FARTHEST, th.FARTHEST))


def _table(name: str, law: th.Law, ranges: Ranges) -> Sum:
    reads = tuple(dict.fromkeys(law.reads))
    if len(reads) == 1:
        return (Product(1.0, (_line(name, law, reads[0], ranges),)),)
    if len(reads) == 2:
        return (Product(1.0, (_plane(name, law, reads, ranges),)),)
    raise InputError(
        f"the law {type(law).__name__} of '{name}' follows {len(reads)} inputs at once ({', '.join(reads)}) and has "
        "no form in C",
        "--as",
        "a law of one or two inputs, or a product of such laws",
    )


def _line(name: str, law: th.Law, of: str, ranges: Ranges) -> Tabulated:
    """A law of one input, its table refined until it is within TOLERANCE everywhere."""
    low, high = ranges[of]
    at = np.linspace(low, high, FIRST)
    if low < 0.0 < high:
        at = np.union1d(at, [0.0])
    while at.size <= FINEST:
        y = np.broadcast_to(np.asarray(law.factor({of: at}), float), at.shape)
        inner = (at[:-1, None] + np.diff(at)[:, None] * CHECKED).ravel()
        true = np.broadcast_to(np.asarray(law.factor({of: inner}), float), inner.shape)
        off = np.abs(np.interp(inner, at, y) - true).reshape(-1, CHECKED.size).max(axis=1)
        bad = off > TOLERANCE * max(float(np.abs(y).max()), 1e-300)
        if not bad.any():
            return Tabulated(of, tuple(at.tolist()), tuple(y.tolist()), False)
        at = np.union1d(at, 0.5 * (at[:-1] + at[1:])[bad])
    raise _coarse(name, law, [of])


def _plane(name: str, law: th.Law, reads: tuple[str, ...], ranges: Ranges) -> Mapped:
    """A law of two inputs on a grid, refused where that is not within ten times TOLERANCE in the middles."""
    x1, x2 = (_denser_at_zero(*ranges[n]) for n in reads)

    def at(a: th.Array, b: th.Array) -> th.Array:
        A, B = np.meshgrid(a, b, indexing="ij")
        flat = np.asarray(law.factor({reads[0]: A.ravel(), reads[1]: B.ravel()}), float)
        return np.broadcast_to(flat, A.size).reshape(A.shape)

    y = at(x1, x2)
    middle = at(0.5 * (x1[:-1] + x1[1:]), 0.5 * (x2[:-1] + x2[1:]))
    four = 0.25 * (y[:-1, :-1] + y[1:, :-1] + y[:-1, 1:] + y[1:, 1:])
    if float(np.abs(four - middle).max()) > 10.0 * TOLERANCE * float(np.abs(y).max()):
        raise _coarse(name, law, reads)
    return Mapped(reads[0], reads[1], tuple(x1.tolist()), tuple(x2.tolist()), tuple(y.ravel().tolist()), False)


def _denser_at_zero(low: float, high: float) -> th.Array:
    """Points along an input: films and exchangers start as roots."""
    share = np.linspace(0.0, 1.0, GRID) ** 2
    return np.unique(np.concatenate([low * share, high * share]))


def _coarse(name: str, law: th.Law, reads: Iterable[str]) -> InputError:
    return InputError(
        f"the law {type(law).__name__} of '{name}' over {', '.join(reads)} is too rough for a table",
        "--as",
        "a law without jumps over the range of its inputs",
    )
