"""Films of what turns, in network.toml: the gap round the rotor, its end faces, the shaft; over the speed in 1/min."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from geom.constants import RPM
from lumped.correlations import Info
from lumped.correlations.streams import Moving
from lumped.declarations.films import film_air, millimetres, moving_film
from lumped.schemas.reader import Table
from lumped.transfer.properties import Fluid
from lumped.transfer.streamed import Streamed


def gap(table: Table) -> Streamed:
    """From rotor to stator through the air between them, over the rotor's surface."""
    radius, width = millimetres(table, "rotor_radius_mm"), millimetres(table, "gap_mm")
    law = table.word("law", "taylor", ("taylor", "becker-kaye"))
    return _over_speed(table, partial(_gap_film, law, radius, width), 80.0)


def rotating(table: Table) -> Streamed:
    """A disc or a shaft that turns in open air."""
    film = ROTATING[table.word("surface", None, ROTATING)]
    return _over_speed(table, partial(film, millimetres(table, "diameter_mm")), 50.0)


def _over_speed(table: Table, film: Moving, usual_degC: float) -> Streamed:
    of, top = table.word("speed", "speed_rpm"), table.number("up_to_rpm", 20000.0)
    return moving_film(table, of, film, film_air(table), usual_degC, top)


def _gap_film(law: str, radius: float, width: float, rpm: float, fluid: Fluid) -> tuple[float, Info]:
    from lumped.correlations.air_gap import becker_kaye, taylor_film

    if law == "becker-kaye":
        return becker_kaye(rpm * RPM, radius, width, fluid)
    one, info = taylor_film(rpm * RPM, radius, width, fluid)
    return 0.5 * one, info


def _disc_film(diameter: float, rpm: float, fluid: Fluid) -> tuple[float, Info]:
    from lumped.correlations.rotating import rotating_disc

    return rotating_disc(rpm * RPM, 0.5 * diameter, fluid)


def _shaft_film(diameter: float, rpm: float, fluid: Fluid) -> tuple[float, Info]:
    from lumped.correlations.rotating import rotating_shaft

    return rotating_shaft(rpm * RPM, diameter, fluid)


ROTATING: dict[str, Callable[[float, float, Fluid], tuple[float, Info]]] = {"disc": _disc_film, "shaft": _shaft_film}
