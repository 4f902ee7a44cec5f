"""Input factors as sums of products of one-input functions: a form that any language evaluates in ten lines.

g(u) = sum_k c_k prod_j phi_kj(u_i)
"""

from dataclasses import dataclass, replace


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

    def times(self, *more: Function) -> "Product":
        return replace(self, functions=(*self.functions, *more))


Sum = tuple[Product, ...]
