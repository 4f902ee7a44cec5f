"""Mixed convection in network.toml: still and moving air on one surface, which do not add.

The mixture depends on speed and temperature difference together, while a law is an input factor times a temperature
law. So its table over both is written as a sum of such products (singular vectors), as many as TOLERANCE asks for.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from lumped.correlations import RangeWarning
from lumped.declarations.films import POINTS, Film, FilmOver, natural_film, over
from lumped.schemas.reader import Table
from lumped.transfer.laws import CONSTANT, Array, Inputs, Law, TemperatureLaw

TOLERANCE, SMALL = 3e-3, 1.0  # relative, of a film of at least SMALL (W/m2/K)


@dataclass(frozen=True)
class Share(Law):
    """One product: `value` at `at` of |input|, times the temperature law; `film` warns for all products."""

    film: FilmOver
    at: tuple[float, ...]
    value: tuple[float, ...]
    temperature: TemperatureLaw = CONSTANT
    first: bool = False

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return self.film.reads

    def factor(self, inputs: Inputs) -> Array:
        if self.first:
            self.film.factor(inputs)
        return np.interp(np.abs(np.asarray(inputs[self.film.of], float)), self.at, self.value)


def mixed(table: Table) -> list[Law]:
    """(h_forced^n + h_natural^n)^(1/n) of a `natural` and a `forced` table, as laws that act in parallel."""
    still, moving = (Table(table.raw(key, {}), f"{table.where} {key}") for key in ("natural", "forced"))
    film, factor = natural_film(still)
    forced, exponent = over(moving), table.number("exponent", 3.0, of="mixed.exponent")
    still.close()
    moving.close()
    speeds = forced.top * np.linspace(0.0, 1.0, POINTS) ** 2
    h = _together(factor * np.array(film.value), forced.film, speeds, exponent)
    return [
        Share(forced, tuple(speeds), tuple(u), replace(film, value=tuple(w)), k == 0)
        for k, (u, w) in enumerate(_products(h))
    ]


def _together(still: Array, forced: Film, speeds: Array, n: float) -> Array:
    """h (speeds, points of the still film's table)"""
    from lumped.correlations.forced import churchill_mixed

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        blown = [forced(float(v))[0] for v in speeds]
    return np.array([[churchill_mixed(f, s, exponent=n) for s in still] for f in blown])


def _products(h: Array) -> Iterator[tuple[Array, Array]]:
    """Pairs whose products sum to h, the most important first."""
    scale = h.mean(axis=1, keepdims=True)
    U, S, V = np.linalg.svd(h / scale, full_matrices=False)
    rest = h
    for k in range(S.size):
        u, w = scale[:, 0] * U[:, k] * S[k], V[k]
        yield u, w
        rest = rest - np.outer(u, w)
        if np.all(np.abs(rest) <= TOLERANCE * np.maximum(h, SMALL)):
            return
