"""The laws of a link and of a stream in network.toml; correlations of known surfaces are in declarations/films.py."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise

from geom.constants import L_MIN, M3_H, RPM
from lumped.correlations import Info
from lumped.correlations.streams import Moving
from lumped.declarations import films
from lumped.declarations.films import shaft_fan
from lumped.model.quantities import AIR, LIQUID
from lumped.schemas.reader import Table, powers
from lumped.transfer.laws import Fixed, InputPower, Law, Power, Radiation, Table as TableLaw
from lumped.transfer.properties import Fluid
from lumped.transfer.streamed import Streamed

ROTATING = ("disc", "shaft")
COEFFICIENTS = ("G_W_K", "R_K_W", "h_W_m2K")
Mechanism = tuple[str, Law, bool]
Read = tuple[Law | list[Law], bool]


def gap(table: Table) -> Streamed:
    """From rotor to stator through the air between them, over the rotor's surface."""
    from lumped.correlations.air_gap import becker_kaye, taylor_film

    radius, width = films.millimetres(table, "rotor_radius_mm"), films.millimetres(table, "gap_mm")
    taylor = table.word("law", "taylor", ("taylor", "becker-kaye")) == "taylor"

    def film(rpm: float, fluid: Fluid) -> tuple[float, Info]:
        if not taylor:
            return becker_kaye(rpm * RPM, radius, width, fluid)
        one, info = taylor_film(rpm * RPM, radius, width, fluid)
        return 0.5 * one, info

    return _over_speed(table, film, 80.0)


def rotating(table: Table) -> Streamed:
    """A disc or a shaft that turns in open air, or in a coolant of a flooded end space."""
    from lumped.correlations.rotating import levich_disc, rotating_disc, rotating_shaft

    disc, liquid = table.word("surface", None, ROTATING) == "disc", films.wet(table)
    film, size = (levich_disc if liquid else rotating_disc, 0.5) if disc else (rotating_shaft, 1.0)
    size *= films.millimetres(table, "diameter_mm")
    return _over_speed(table, lambda rpm, fluid: film(rpm * RPM, size, fluid), 50.0, liquid)


def _over_speed(table: Table, film: Moving, usual_degC: float, liquid: bool = False) -> Streamed:
    of, top = table.word("speed", "speed_rpm"), table.number("up_to_rpm", 20000.0)
    return films.moving_film(
        table, of, film, films.read_coolant(table) if liquid else films.film_air(table), usual_degC, top, liquid
    )


# Mixed convection in network.toml: still and moving air on one surface, which do not add
def mixed(table: Table) -> list[Law]:
    """(h_forced^n + h_natural^n)^(1/n) of a `natural` and a `forced` table: still air, and what moving air adds."""
    still, moving = (Table(table.raw(key, {}), f"{table.where} {key}") for key in ("natural", "forced"))
    film, factor = films.natural_film(still)
    forced, exponent = films.over(moving), table.number("exponent", 3.0, of="mixed.exponent")
    still.close()
    moving.close()
    scaled = replace(film, value=tuple(factor * h for h in film.value))
    return [Fixed(factor, film), replace(forced, table=replace(forced.table, still=scaled, exponent=exponent))]


def _coefficient(table: Table, has_area: bool) -> tuple[float, bool]:
    """The number of a mechanism and whether it is per area."""
    keys = [key for key in COEFFICIENTS if key in table]
    if len(keys) != 1:
        what = f"{' and '.join(keys)} both given" if keys else "no coefficient"
        raise table.error(what, f"one of {', '.join(COEFFICIENTS)}")
    value = table.number(keys[0])
    if keys[0] == "h_W_m2K" and not has_area:
        raise table.error("h_W_m2K without an area", "area_m2 = ... in the link, or a surface as its first end")
    return (1.0 / value if keys[0] == "R_K_W" else value), keys[0] == "h_W_m2K"


def _needs_area(table: Table, has_area: bool) -> None:
    if not has_area:
        raise table.error("this mechanism needs an area", "area_m2 = ... in the link, or a surface as its first end")


def _fixed(table: Table, has_area: bool) -> tuple[Law, bool] | None:
    keys = [key for key in COEFFICIENTS if key in table]
    coefficient, of = _coefficient(table, has_area) if keys else None, powers(table)
    if coefficient is None:
        return None
    return (InputPower(coefficient[0], of) if of else Fixed(coefficient[0])), coefficient[1]


def _film(read: Callable[[Table], Law | list[Law]], table: Table, has_area: bool) -> Read:
    """A mechanism per area."""
    _needs_area(table, has_area)
    return read(table), True


def _radiation(table: Table, has_area: bool) -> tuple[Law, bool]:
    _needs_area(table, has_area)
    return Fixed(table.number("emissivity") * table.number("view_factor", 1.0), Radiation()), True


def _forced(table: Table, has_area: bool) -> Read:
    if "surface" in table:
        _needs_area(table, has_area)
        return films.over(table), True
    coefficient, of = _coefficient(table, has_area), powers(table)
    if not of:
        right = 'surface = ... with speed = "INPUT", or of = { input = "speed_rpm", at = 1000, exponent = 0.8 }'
        raise table.error("forced without an input", right)
    return InputPower(coefficient[0], of), coefficient[1]


def _power(table: Table, has_area: bool) -> tuple[Law, bool]:
    coefficient, law = _coefficient(table, has_area), Power(table.number("exponent", 0.25, of="power.exponent"))
    return InputPower(coefficient[0], powers(table), law), coefficient[1]


def _tabled(table: Table, has_area: bool) -> tuple[Law, bool]:
    difference, per_area = table.numbers("difference_K"), "h_W_m2K" in table
    value = table.numbers("h_W_m2K", of="W_m2K") if per_area else table.numbers("G_W_K", of="W_K")  # zero at rest
    rising = all(b > a for a, b in pairwise(difference))
    if len(value) != len(difference) or not rising or not value:
        raise table.error("difference_K and its values do not match", "two lists of one length, differences rising")
    if per_area:
        _needs_area(table, has_area)
    return InputPower(1.0, powers(table), TableLaw(difference, value)), per_area


MECHANISMS: dict[str, Callable[[Table, bool], Read]] = {
    "natural": partial(_film, films.natural),
    "radiation": _radiation,
    "forced": _forced,
    "gap": partial(_film, gap),
    "rotating": partial(_film, rotating),
    "contact": partial(_film, films.contact),
    "fan": partial(_film, shaft_fan),
    "power": _power,
    "table": _tabled,
    "mixed": partial(_film, mixed),
}


def mechanisms(table: Table, has_area: bool) -> list[Mechanism]:
    """(suffix of the link's name, law, whether in W/m2/K) for every mechanism of a link; they act in parallel."""
    fixed = _fixed(table, has_area)
    out: list[Mechanism] = [] if fixed is None else [("", *fixed)]
    for word, read in MECHANISMS.items():
        if word in table:
            inner = Table(table.raw(word), f"{table.where} {word}")
            out += _named(f":{word}", *read(inner, has_area))
            inner.close()
    if not out:
        table.raw("prior_sd")
        table.close()
        raise table.error("a link without a mechanism", f"G_W_K, R_K_W, h_W_m2K, {', '.join(MECHANISMS)}")
    return out


def _named(suffix: str, laws: Law | list[Law], per_area: bool) -> list[Mechanism]:
    """A film that is a sum of laws has their numbers in the names, but for the first, which has the film's own."""
    several = laws if isinstance(laws, list) else [laws]
    return [(f"{suffix}:{k + 1}" if k else suffix, law, per_area) for k, law in enumerate(several)]


FLOW_INPUTS = {"flow_l_min_input": L_MIN, "flow_m3_h_input": M3_H}


def flow_column(table: Table, measures: Callable[[str], str]) -> str | None:
    """The input that carries a stream's flow with its direction; a fan on a shaft blows one way however it turns."""
    of = [name for name, _, exponent in powers(table) if exponent == 1.0 and measures(name) in (AIR, LIQUID)]
    return next((table.word(key) for key in FLOW_INPUTS if key in table), of[0] if len(of) == 1 else None)


def flow_law(table: Table) -> Law:
    """Heat capacity rate (W/K) of a stream: fixed, or proportional to a flow input."""
    if "mcp_W_K" in table:
        return InputPower(table.number("mcp_W_K"), powers(table))
    rate = table.number("density_kg_m3") * table.number("cp_J_kgK")
    if "flow_l_min" in table:
        return Fixed(rate * table.number("flow_l_min") * L_MIN)
    for key, scale in FLOW_INPUTS.items():
        if key in table:
            return InputPower(rate * scale, ((table.word(key), 1.0, 1.0),))
    raise table.error(
        "no flow", "mcp_W_K, or density_kg_m3 and cp_J_kgK with flow_l_min, flow_l_min_input or flow_m3_h_input"
    )
