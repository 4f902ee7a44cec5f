"""Mixed convection in network.toml: still and moving air on one surface, which do not add."""

from __future__ import annotations

from dataclasses import replace

from lumped.declarations.films import natural_film, over
from lumped.schemas.reader import Table
from lumped.transfer.laws import Fixed, Law


def mixed(table: Table) -> list[Law]:
    """(h_forced^n + h_natural^n)^(1/n) of a `natural` and a `forced` table: still air, and what moving air adds."""
    still, moving = (Table(table.raw(key, {}), f"{table.where} {key}") for key in ("natural", "forced"))
    film, factor = natural_film(still)
    forced, exponent = over(moving), table.number("exponent", 3.0, of="mixed.exponent")
    still.close()
    moving.close()
    scaled = replace(film, value=tuple(factor * h for h in film.value))
    return [Fixed(factor, film), replace(forced, table=replace(forced.table, still=scaled, exponent=exponent))]
