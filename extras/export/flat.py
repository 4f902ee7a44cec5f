"""Sums of products as flat arrays, for languages without objects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from extras.export.products import Function, Mapped, Positive, Powered, Straight, Sum
from thermoscope import plugin as th

POWERED, STRAIGHT, POSITIVE, TABULATED, MAPPED = range(5)


@dataclass(frozen=True)
class Flat:
    """Products product_start[e]:product_start[e + 1] make up factor e, functions function_start[k]:... product k.

    function (nf, 8) : kind, input, other input, first of x, points along x1 and x2, first of y, whether of the size
    parameters (nf, 2) : (at, exponent), (offset, slope) or (way, 0);  x, y : of all tables
    """

    product_start: th.Ints
    coefficient: th.Array
    function_start: th.Ints
    function: th.Ints
    parameters: th.Array
    x: th.Array
    y: th.Array


def flat(factors: Sequence[Sum], signals: Sequence[str]) -> Flat:
    """All factors, with inputs by their place among the signals."""
    products = [p for total in factors for p in total]
    functions = [f for p in products for f in p.functions]
    xs = [_points(f)[0] for f in functions]
    ys = [_points(f)[1] for f in functions]
    at_x, at_y = th.starts(xs), th.starts(ys)
    table = [_integers(f, signals, at_x[i], at_y[i]) for i, f in enumerate(functions)]
    return Flat(
        th.starts(factors),
        np.array([p.coefficient for p in products]),
        th.starts([p.functions for p in products]),
        np.array(table, np.int64).reshape(-1, 8),
        np.array([_numbers(f) for f in functions], float).reshape(-1, 2),
        np.concatenate([np.empty(0), *xs]),
        np.concatenate([np.empty(0), *ys]),
    )


def _points(f: Function) -> tuple[tuple[float, ...], tuple[float, ...]]:
    if isinstance(f, Powered | Straight | Positive):
        return (), ()
    return ((*f.x1, *f.x2) if isinstance(f, Mapped) else f.x), f.y


def _integers(f: Function, signals: Sequence[str], x: int, y: int) -> list[int]:
    of = signals.index(f.input)
    if isinstance(f, Mapped):
        return [MAPPED, of, signals.index(f.other), x, len(f.x1), len(f.x2), y, f.size]
    if isinstance(f, Powered | Straight | Positive):
        kind = POWERED if isinstance(f, Powered) else STRAIGHT if isinstance(f, Straight) else POSITIVE
        return [kind, of, 0, 0, 0, 0, 0, 0]
    return [TABULATED, of, 0, x, len(f.x), 0, y, f.size]


def _numbers(f: Function) -> tuple[float, float]:
    if isinstance(f, Powered):
        return f.at, f.exponent
    if isinstance(f, Straight):
        return f.offset, f.slope
    return (f.way, 0.0) if isinstance(f, Positive) else (0.0, 0.0)
