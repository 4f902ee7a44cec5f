"""Films of known surfaces in network.toml by correlation: still air, moving air and coolant, contacts."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from geom.plugins import plugins
from lumped.correlations import Info, film_tabulated, tabulated
from lumped.correlations.streams import Moving, streamed
from lumped.schemas.reader import Table
from lumped.transfer.laws import FILMS, FilmTable, Fixed, Law
from lumped.transfer.properties import Fluid, air
from lumped.transfer.streamed import Streamed

Still = Callable[[float, float], tuple[float, Info]]
Film = Callable[[float], tuple[float, Info]]  # of |input|
Of = Callable[[float], Fluid]
TABLED = 4.0  # of the fastest that is expected: tables reach five times as far (streams.REACH)


def natural(table: Table) -> Law:
    """Still air, tabulated over the temperature difference."""
    film, factor = natural_film(table)
    return Fixed(factor, film)


def natural_film(table: Table) -> tuple[FilmTable, float]:
    """The film of still air, and the factor on it. The air's properties follow its film temperature, or, where the
    table says `fluid_degC`, are those of surfaces in air of that temperature."""
    surfaces = {**NATURAL, **plugins("still_air")}
    film, factor = surfaces[table.word("surface", None, surfaces)](table, film_air(table)), table.number("factor", 1.0)
    if "fluid_degC" not in table:
        return film_tabulated(film), factor
    held = tabulated(film, fluid_temperature=table.number("fluid_degC"))
    return FilmTable(held.difference, held.value * FILMS), factor


def film_air(table: Table) -> Callable[[float], Fluid]:
    return partial(air, altitude_m=table.number("altitude_m", 0.0))


def _size(table: Table) -> float:
    return table.number("size_m")


def millimetres(table: Table, key: str) -> float:
    return 1e-3 * table.number(key)


def _cylinder(table: Table, of: Of) -> Still:
    from lumped.correlations.natural import churchill_chu_cylinder

    return partial(churchill_chu_cylinder, _size(table), of=of)


def _plate(table: Table, of: Of) -> Still:
    from lumped.correlations.natural import churchill_chu_plate

    return partial(churchill_chu_plate, _size(table), of=of)


def _level(upward: bool, table: Table, of: Of) -> Still:
    from lumped.correlations.natural import mcadams_plate

    return partial(mcadams_plate, _size(table), upward=upward, of=of)


def _upright(table: Table, of: Of) -> Still:
    from lumped.correlations.natural import popiel_cylinder

    return partial(popiel_cylinder, _size(table), millimetres(table, "diameter_mm"), of=of)


def _vertical_fins(table: Table, of: Of) -> Still:
    from lumped.correlations.fins import van_de_pol_tierney

    depth, spacing = millimetres(table, "depth_mm"), millimetres(table, "spacing_mm")
    return partial(van_de_pol_tierney, depth, spacing, _size(table), of=of)


def _horizontal_fins(table: Table, of: Of) -> Still:
    from lumped.correlations.fins import jones_smith

    return partial(jones_smith, millimetres(table, "spacing_mm"), of=of)


def _plates(table: Table, of: Of) -> Still:
    from lumped.correlations.fins import elenbaas

    return partial(elenbaas, millimetres(table, "spacing_mm"), _size(table), of=of)


NATURAL: dict[str, Callable[[Table, Of], Still]] = {
    "horizontal cylinder": _cylinder,
    "vertical plate": _plate,
    "plate facing up": partial(_level, True),
    "plate facing down": partial(_level, False),
    "vertical cylinder": _upright,
    "vertical fins": _vertical_fins,
    "horizontal fins": _horizontal_fins,
    "parallel plates": _plates,
}


def _duct(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.ducts import duct_film

    return partial(duct_film, diameter=millimetres(table, "diameter_mm"), length=_size(table), fluid=fluid)


def _fin_channel(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.fins import heiles_decaying, straight_decay

    decay, turbulence = partial(straight_decay, table.number("speed_at_end", 1.0)), table.number("turbulence", 1.7)
    return partial(
        heiles_decaying,
        diameter=millimetres(table, "diameter_mm"),
        length=_size(table),
        decay=decay,
        turbulence=turbulence,
        fluid=fluid,
    )


def _flat(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.forced import flat_plate

    return partial(flat_plate, length=_size(table), fluid=fluid)


def _across(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.forced import churchill_bernstein

    return partial(churchill_bernstein, diameter=_size(table), fluid=fluid)


def _end_space(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.end_space import SCHUBERT, end_space

    return partial(end_space, **{k: table.number(k, usual) for k, usual in zip(("k1", "k2", "k3"), SCHUBERT)})


def _helix(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.ducts import schmidt_helical

    inner, coil = millimetres(table, "diameter_mm"), millimetres(table, "coil_diameter_mm")
    return partial(schmidt_helical, diameter=inner, coil_diameter=coil, fluid=fluid)


FORCED: dict[str, Callable[[Table, Fluid], Film]] = {
    "plate": _flat,
    "cylinder": _across,
    "fin channel": _fin_channel,
    "duct": _duct,
    "helical pipe": _helix,
    "end space": _end_space,
}


def over(table: Table) -> Streamed:
    """Air, or a coolant, moving over a known surface; its speed is `m_s_per_unit` times an input."""
    liquid = "coolant" in table and table.raw("coolant") != "air"
    surfaces = {**FORCED, **plugins("moving_air")}
    film, scale = surfaces[table.word("surface", None, surfaces)], table.number("m_s_per_unit", 1.0)
    fluid, usual = (_coolant(table), 40.0) if "coolant" in table else (film_air(table), 30.0)
    of, top = table.word("speed"), table.number("up_to_m_s", 50.0) / scale
    return moving_film(table, of, lambda v, x: film(table, x)(scale * v), fluid, usual, top, liquid)


def moving_film(
    table: Table, of: str, film: Moving, fluid: Of, usual_degC: float, top: float, liquid: bool = False
) -> Streamed:
    """A film over |input|: its properties hold at `fluid_degC` where the table says so, else they follow."""
    if "fluid_degC" in table:
        held = fluid(table.number("fluid_degC"))
        return streamed(of, top / TABLED, film, lambda _: held, usual_degC, liquid)
    return streamed(of, top / TABLED, film, fluid, usual_degC, liquid)


def _coolant(table: Table) -> Of:
    from lumped.declarations.coolant import read_coolant

    return read_coolant(table)


def contact(table: Table) -> Law:
    """A joint: an effective gap of still air, a gap from the table of joints, or a pair of pressed materials."""
    from lumped.correlations.contacts import GAPS, PRESSED, contact_film, gap_film

    if "gap_mm" in table:
        return Fixed(gap_film(millimetres(table, "gap_mm")))
    if "pair" in table:
        return Fixed(contact_film(table.word("pair", None, PRESSED))[0])
    return Fixed(gap_film(GAPS[table.word("joint", None, GAPS)]))
