"""Mixed convection in network.toml: still and moving air on one surface, which do not add.

The mixture depends on speed, temperature difference and film temperature together: separated.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from lumped.correlations.forced import churchill_mixed
from lumped.declarations.films import natural_film, over
from lumped.declarations.separated import FilmOver, Share, film_degC, over_grid, products, weights
from lumped.schemas.reader import Table
from lumped.transfer.laws import Array, FilmTable, Law
from lumped.transfer.terms_value import temperature_value


def mixed(table: Table) -> list[Law]:
    """(h_forced^n + h_natural^n)^(1/n) of a `natural` and a `forced` table, as laws that act in parallel."""
    still, moving = (Table(table.raw(key, {}), f"{table.where} {key}") for key in ("natural", "forced"))
    film, factor = natural_film(still)
    forced, exponent = over(moving), table.number("exponent", 3.0, of="mixed.exponent")
    still.close()
    moving.close()
    one, blown = _tabled(forced)
    at, natural = one.at, factor * np.array(film.value)
    follows = isinstance(film, FilmTable)
    columns = blown.repeat(len(film.difference), axis=1) if follows else blown[:, :1]
    weight = weights(np.array(film_degC())).repeat(len(film.difference)) if follows else None
    h = churchill_mixed(columns, natural[None, :], exponent=exponent)
    return [
        Share(one, tuple(at), tuple(u), replace(film, value=tuple(w)), k == 0)
        for k, (u, w) in enumerate(products(h, weight))
    ]


def _tabled(laws: Sequence[Law]) -> tuple[FilmOver, Array]:
    """What warns, and the film (speeds, film temperatures)."""
    degC = film_degC()
    if isinstance(laws[0], FilmOver):
        return laws[0], np.repeat(over_grid(laws[0].film, laws[0].at)[:, None], len(degC), axis=1)
    shares = [law for law in laws if isinstance(law, Share)]
    each = [np.outer(x.value, [temperature_value(x.temperature, T, T) for T in degC]) for x in shares]
    return shares[0].film, np.sum(each, axis=0)
