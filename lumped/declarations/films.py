"""Films of known surfaces by correlation, as files declare them: still air, moving air and coolant, contacts, fans."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

from geom.plugins import plugins
from lumped.correlations import Info, film_tabulated
from lumped.correlations.streams import Moving, streamed
from lumped.schemas.reader import Table
from lumped.transfer.coolant import NAMES, Coolant, DataSheet, coolant
from lumped.transfer.laws import FILMS, FilmTable, Fixed, InputPower, Law
from lumped.transfer.properties import Fluid, air
from lumped.transfer.streamed import Streamed

Still = Callable[[float, float], tuple[float, Info]]
SHEET = ("viscosity_40C_mm2_s", "viscosity_100C_mm2_s", "density_15C_kg_m3")  # of an oil
Film = Callable[[float], tuple[float, Info]]  # of |input|
Of = Callable[[float], Fluid]
EXPONENT = 0.8  # turbulent along fins and end shields (Staton and Cavagnino 2008); 0.5 laminar
TABLED = 4.0  # of the fastest that is expected: tables reach five times as far (streams.REACH)


def natural(table: Table) -> Law:
    """Still air, tabulated over the temperature difference."""
    film, factor = natural_film(table)
    return Fixed(factor, film)


def natural_film(table: Table) -> tuple[FilmTable, float]:
    """The film of still air, and the factor on it. The air's properties follow its film temperature, or, where the
    table says `fluid_degC`, are those of surfaces in air of that temperature."""
    surfaces = {**still_surfaces(), **plugins("still_air")}
    film, factor = surfaces[table.word("surface", None, surfaces)](table, film_air(table)), table.number("factor", 1.0)
    if "fluid_degC" not in table:
        return film_tabulated(film), factor
    cold = table.number("fluid_degC")
    follows = film_tabulated(lambda surface, ambient: film(cold + surface - ambient, cold))
    return replace(follows, value=follows.value[: len(follows.difference)] * FILMS), factor


def film_air(table: Table) -> Callable[[float], Fluid]:
    return partial(air, altitude_m=table.number("altitude_m", 0.0))


def _size(table: Table) -> float:
    return table.number("size_m")


def millimetres(table: Table, key: str) -> float:
    return 1e-3 * table.number(key)


@cache
def still_surfaces() -> dict[str, Callable[[Table, Of], Still]]:
    """[links.NAME.natural] surface -> its film; loaded where one is asked for."""
    from lumped.correlations import fins, natural

    def fin_array(t: Table, of: Of) -> Still:
        depth, spacing = millimetres(t, "depth_mm"), millimetres(t, "spacing_mm")
        return partial(fins.van_de_pol_tierney, depth, spacing, _size(t), of=of)

    def slender(t: Table, of: Of) -> Still:
        return partial(natural.popiel_cylinder, _size(t), millimetres(t, "diameter_mm"), of=of)

    return {
        "horizontal cylinder": lambda t, of: partial(natural.churchill_chu_cylinder, _size(t), of=of),
        "vertical plate": lambda t, of: partial(natural.churchill_chu_plate, _size(t), of=of),
        "plate facing up": lambda t, of: partial(natural.mcadams_plate, _size(t), upward=True, of=of),
        "plate facing down": lambda t, of: partial(natural.mcadams_plate, _size(t), upward=False, of=of),
        "vertical cylinder": slender,
        "vertical fins": fin_array,
        "horizontal fins": lambda t, of: partial(fins.jones_smith, millimetres(t, "spacing_mm"), of=of),
        "parallel plates": lambda t, of: partial(fins.elenbaas, millimetres(t, "spacing_mm"), _size(t), of=of),
    }


@cache
def moving_surfaces() -> dict[str, Callable[[Table, Fluid], Film]]:
    """[links.NAME.forced] surface -> its film; loaded where one is asked for."""
    from lumped.correlations import ducts, end_space, fins, forced

    def channel(t: Table, fluid: Fluid) -> Film:
        wide, decay = millimetres(t, "diameter_mm"), partial(fins.straight_decay, t.number("speed_at_end", 1.0))
        blown = partial(fins.heiles_decaying, diameter=wide, length=_size(t), decay=decay, fluid=fluid)
        return partial(blown, turbulence=t.number("turbulence", 1.7))

    def duct(t: Table, fluid: Fluid) -> Film:
        return partial(ducts.duct_film, diameter=millimetres(t, "diameter_mm"), length=_size(t), fluid=fluid)

    def helix(t: Table, fluid: Fluid) -> Film:
        inner, coil = millimetres(t, "diameter_mm"), millimetres(t, "coil_diameter_mm")
        return partial(ducts.schmidt_helical, diameter=inner, coil_diameter=coil, fluid=fluid)

    def stirred(t: Table, _: Fluid) -> Film:
        usual = zip(("k1", "k2", "k3"), end_space.SCHUBERT)
        return partial(end_space.end_space, **{key: t.number(key, value) for key, value in usual})

    return {
        "plate": lambda t, fluid: partial(forced.flat_plate, length=_size(t), fluid=fluid),
        "cylinder": lambda t, fluid: partial(forced.churchill_bernstein, diameter=_size(t), fluid=fluid),
        "fin channel": channel,
        "duct": duct,
        "helical pipe": helix,
        "end space": stirred,
    }


def read_coolant(table: Table) -> Coolant:
    """T (degC) -> Fluid of the table's key `coolant`: a name, or a table with a share of glycol, a pressure, or what
    an oil's data sheet says."""
    if isinstance(table.raw("coolant"), str):
        return coolant(table.word("coolant", None, NAMES))
    inner = Table(table.raw("coolant", {}), f"{table.where} coolant")
    name = inner.word("name", None, NAMES)
    numbers = {key: inner.number(key) for key in ("mass_percent", "volume_percent", "pressure_bar") if key in inner}
    sheet = DataSheet(*(inner.number(key) for key in SHEET)) if any(key in inner for key in SHEET) else None
    inner.close()
    return coolant(name, **numbers, sheet=sheet)


def wet(table: Table) -> bool:
    """Does it name a liquid?"""
    return "coolant" in table and table.raw("coolant") != "air"


def over(table: Table) -> Streamed:
    """Air, or a coolant, moving over a known surface; its speed is `m_s_per_unit` times an input."""
    liquid = wet(table)
    surfaces = {**moving_surfaces(), **plugins("moving_air")}
    film, scale = surfaces[table.word("surface", None, surfaces)], table.number("m_s_per_unit", 1.0)
    fluid, usual = (read_coolant(table), 40.0) if "coolant" in table else (film_air(table), 30.0)
    of, top = table.word("speed"), table.number("up_to_m_s", 50.0) / scale
    return moving_film(table, of, lambda v, x: film(table, x)(scale * v), fluid, usual, top, liquid)


def moving_film(
    table: Table, of: str, film: Moving, fluid: Of, usual_degC: float, top: float, liquid: bool = False
) -> Streamed:
    """A film over |input|: its properties hold at `fluid_degC` where the table says so, else they follow."""
    if "fluid_degC" in table:
        properties = fluid(table.number("fluid_degC"))
        return streamed(of, top / TABLED, film, lambda _: properties, usual_degC, liquid)
    return streamed(of, top / TABLED, film, fluid, usual_degC, liquid)


def contact(table: Table) -> Law:
    """A joint: an effective gap of still air, a gap from the table of joints, or a pair of pressed materials."""
    from lumped.correlations.contacts import GAPS, PRESSED, contact_film, gap_film

    if "gap_mm" in table:
        return Fixed(gap_film(millimetres(table, "gap_mm")))
    if "pair" in table:
        return Fixed(contact_film(table.word("pair", None, PRESSED))[0])
    return Fixed(gap_film(GAPS[table.word("joint", None, GAPS)]))


def shaft_fan(table: Table) -> InputPower:
    """Faces that stand still in the air of a fan on the shaft: of a link, and of a part in [films.outer].

    fan = { h_W_m2K = 40, at_rpm = 1460, exponent = 0.8, speed = "speed_rpm" } is h = h0 |n / n0|^m (W/m2/K): the fan's
    air goes with the speed n (affinity), its film with Re^m.
    """
    h, at = table.number("h_W_m2K"), table.number("at_rpm", low=1e-9)
    exponent = table.number("exponent", EXPONENT, low=0.5, high=1.0)
    return InputPower(h, ((table.word("speed", "speed_rpm"), at, exponent),))
