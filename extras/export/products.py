"""Input factors as sums of products of one-input functions: a form that any language evaluates in ten lines.

g(u) = sum_k c_k prod_j phi_kj(u_i)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from thermoscope.plugin import Array, Ints


@dataclass(frozen=True)
class Powered:
    """|u / at| ** exponent."""

    input: str
    at: float
    exponent: float


@dataclass(frozen=True)
class Straight:
    """offset + slope u."""

    input: str
    offset: float
    slope: float


@dataclass(frozen=True)
class Positive:
    """1 where way u > 0, else 0."""

    input: str
    way: float


@dataclass(frozen=True)
class Tabulated:
    """Piecewise linear in u, or in |u| where `size`; flat outside."""

    input: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    size: bool


@dataclass(frozen=True)
class Mapped:
    """Bilinear in two inputs, or in their sizes where `size`; flat outside.  y : row by row, (x1, x2)"""

    input: str
    other: str
    x1: tuple[float, ...]
    x2: tuple[float, ...]
    y: tuple[float, ...]
    size: bool


Function = Powered | Straight | Positive | Tabulated | Mapped


@dataclass(frozen=True)
class Product:
    """coefficient * prod of functions."""

    coefficient: float
    functions: tuple[Function, ...] = ()

    def times(self, *more: Function) -> Product:
        return replace(self, functions=(*self.functions, *more))


Sum = tuple[Product, ...]


def value(total: Sum, inputs: Mapping[str, Array]) -> Array | float:
    """The factor again, in NumPy: what the exported forms compute."""
    out: Array | float = 0.0
    for p in total:
        one: Array | float = p.coefficient
        for f in p.functions:
            one = one * _value(f, inputs)
        out = out + one
    return out


def _value(f: Function, inputs: Mapping[str, Array]) -> Array:
    u = np.asarray(inputs[f.input], float)
    if isinstance(f, Powered):
        return np.asarray(np.abs(u / f.at) ** f.exponent)
    if isinstance(f, Straight):
        return np.asarray(f.offset + f.slope * u)
    if isinstance(f, Positive):
        return np.asarray(f.way * u > 0.0, float)
    u = np.abs(u) if f.size else u
    if isinstance(f, Tabulated):
        return np.interp(u, f.x, f.y)
    v = np.asarray(inputs[f.other], float)
    i, a = _cell(u, f.x1)
    j, b = _cell(np.abs(v) if f.size else v, f.x2)
    Y = np.reshape(f.y, (len(f.x1), len(f.x2)))
    low, high = (1 - b) * Y[i, j] + b * Y[i, j + 1], (1 - b) * Y[i + 1, j] + b * Y[i + 1, j + 1]
    return np.asarray((1 - a) * low + a * high)


def _cell(u: Array, x: tuple[float, ...]) -> tuple[Ints, Array]:
    grid = np.asarray(x)
    k = np.clip(np.searchsorted(grid, u, side="right") - 1, 0, grid.size - 2)
    return k, np.clip((u - grid[k]) / (grid[k + 1] - grid[k]), 0.0, 1.0)
