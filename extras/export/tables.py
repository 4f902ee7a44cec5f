"""The input factor of any law: exactly where its form is known, else as a table as close as TOLERANCE.

What cannot be is refused: a law of time or of the whole record, one of three inputs at once of unknown form.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import singledispatch
from itertools import product as pairs
from typing import Any

import numpy as np

from extras.export.products import Mapped, Positive, Powered, Product, Straight, Sum, Tabulated
from thermoscope import InputError, plugin as th

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
    what = f"the law {type(law).__name__} of '{name}' follows {len(reads)} inputs at once ({', '.join(reads)})"
    raise InputError(f"{what} and has no form in C", "--as", "a law of one or two inputs, or a product of such laws")


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
    what = f"the law {type(law).__name__} of '{name}' over {', '.join(reads)} is too rough for a table"
    return InputError(what, "--as", "a law without jumps over the range of its inputs")


@singledispatch
def expanded(law: th.Law) -> Sum | None:
    """The input factor of a law, exactly; None where no expansion is known: to be tabulated."""
    return None


def _eddy(law: th.EddyLoss) -> Sum:
    c0, *others = law.ac
    orders = [(c0 - 1.0, ()), *((c, (Powered(law.speed, law.speed_at, float(k)),)) for k, c in enumerate(others, 1))]
    R = law.copper.factor_ * law.copper.resistance
    return tuple(
        Product(R * c, (Powered(name, 1.0, 2.0), *ac)) for name, (c, ac) in pairs(law.copper.currents, orders) if c
    )


def _iron(law: th.IronLoss) -> Sum:
    flux = (Powered(law.excitation, law.excitation_at, law.flux_exponent),) if law.excitation else ()
    parts = ((law.hysteresis, law.frequency_exponent), (law.eddy, 2.0), (law.excess, 1.5))
    return tuple(Product(w, (Powered(law.speed, law.speed_at, e), *flux)) for w, e in parts if w)


def _brush(law: th.BrushLoss) -> Sum:
    drop = Product(law.drop, (Powered(law.current, 1.0, 1.0),))
    return (drop, Product(law.friction, (Powered(law.speed, law.speed_at, 1.0),))) if law.speed else (drop,)


def _map(law: th.MapLoss) -> Sum:
    watts = tuple(np.ravel(law.watts).tolist())
    grid = Mapped(law.speed, law.torque, law.at_speed, law.at_torque, watts, True)
    return (Product(1.0, (grid, *(Powered(*t) for t in law.powers))),)


def _stirred(law: th.Stirred) -> Sum:
    stirring = law.k1 * law.k2 * abs(law.per_rpm) ** law.k3
    return Product(law.k1), Product(stirring, (Powered("speed_rpm", 1.0, law.k3),))


def _each(base: th.Law, change: Callable[[Product], Product]) -> Sum | None:
    """What another law's expansion becomes, product by product."""
    inner = expanded(base)
    return inner and tuple(change(p) for p in inner)


def _switched(law: th.Switched) -> Sum | None:
    on = Straight(law.switch, 0.0, 1.0) if law.closed else Straight(law.switch, 1.0, -1.0)
    return _each(law.base, lambda p: p.times(on))


EXACT: dict[type[th.Law], Callable[[Any], Sum | None]] = {
    th.Fixed: lambda law: (Product(law.value),),
    th.Streamed: lambda law: (Product(law.value),),
    th.InputPower: lambda law: (Product(law.value, tuple(Powered(*t) for t in law.terms)),),
    th.PowerLoss: lambda law: tuple(Product(watts, tuple(Powered(*t) for t in powers)) for watts, powers in law.terms),
    th.CopperLoss: lambda law: tuple(
        Product(law.factor_ * law.resistance, (Powered(name, 1.0, 2.0),)) for name in law.currents
    ),
    th.EddyLoss: _eddy,
    th.LayerLoss: lambda law: expanded(law.copper),
    th.IronLoss: _iron,
    th.BrushLoss: _brush,
    th.MapLoss: _map,
    th.MeasuredLoss: lambda law: tuple(
        Product(scale, tuple(Straight(n, 0.0, 1.0) for n in names)) for scale, names in law.powers
    ),
    th.Stirred: _stirred,
    th.Scaled: lambda law: _each(law.base, lambda p: replace(p, coefficient=law.by * p.coefficient)),
    th.OneWay: lambda law: expanded(law.base),
    th.WithTemperature: lambda law: expanded(law.base),
    th.Direction: lambda law: _each(law.base, lambda p: p.times(Positive(law.column, float(law.way)))),
    th.Switched: _switched,
}
for kind, form in EXACT.items():
    expanded.register(kind, form)
