"""Films of known surfaces in network.toml: still air, moving air, the rotor's gap, contacts; by correlation."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from lumped.correlations import Info, RangeWarning, tabulated
from lumped.laws import Array, Fixed, Inputs, Law
from lumped.properties import Fluid, air
from lumped.reader import Table

RPM = math.pi / 30.0
POINTS = 97
Film = Callable[[float], tuple[float, Info]]


@dataclass(frozen=True)
class FilmOver(Law):
    """A film (W/m2/K) over |input|, tabulated from `film` up to `top`; warns where the correlation itself would.

    The grid is denser towards 0, where films start as roots; above `top` the film is held and the warning says so.
    """

    of: str
    film: Film
    top: float

    @property
    def reads(self) -> tuple[str, ...]:  # type: ignore[override]
        return (self.of,)

    def factor(self, inputs: Inputs) -> Array:
        x = np.abs(np.asarray(inputs[self.of], float))
        largest = float(x.max(initial=0.0))
        self.film(min(largest, self.top))
        if largest > self.top:
            said = f"film over {self.of}: {self.of} = {largest:.4g} outside 0 to {self.top:g}"
            warnings.warn(said, RangeWarning, stacklevel=2)
        at = self.top * np.linspace(0.0, 1.0, POINTS) ** 2
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            return np.interp(x, at, [self.film(v)[0] for v in at])


def natural(table: Table) -> Law:
    """Still air, tabulated over the temperature difference at one temperature of the air."""
    at, of = table.number("fluid_degC", 20.0, low=-60.0, high=200.0), _air(table)
    surface = table.word("surface", None, NATURAL)
    film = NATURAL[surface](table, of)
    return Fixed(table.number("factor", 1.0), tabulated(film, fluid_temperature=at))


def _air(table: Table) -> Callable[[float], Fluid]:
    return partial(air, altitude_m=table.number("altitude_m", 0.0, high=9000.0))


def _size(table: Table) -> float:
    return table.number("size_m", low=1e-4, high=100)


def _millimetres(table: Table, key: str) -> float:
    return 1e-3 * table.number(key, low=1e-3)


Still = Callable[[float, float], tuple[float, Info]]
Of = Callable[[float], Fluid]


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

    return partial(popiel_cylinder, _size(table), _millimetres(table, "diameter_mm"), of=of)


def _vertical_fins(table: Table, of: Of) -> Still:
    from lumped.correlations.fins import van_de_pol_tierney

    depth, spacing = _millimetres(table, "depth_mm"), _millimetres(table, "spacing_mm")
    return partial(van_de_pol_tierney, depth, spacing, _size(table), of=of)


def _horizontal_fins(table: Table, of: Of) -> Still:
    from lumped.correlations.fins import jones_smith

    return partial(jones_smith, _millimetres(table, "spacing_mm"), of=of)


def _plates(table: Table, of: Of) -> Still:
    from lumped.correlations.fins import elenbaas

    return partial(elenbaas, _millimetres(table, "spacing_mm"), _size(table), of=of)


NATURAL: dict[str, Callable[[Table, Of], Still]] = {
    "horizontal cylinder": _cylinder, "vertical plate": _plate, "plate facing up": partial(_level, True),
    "plate facing down": partial(_level, False), "vertical cylinder": _upright, "vertical fins": _vertical_fins,
    "horizontal fins": _horizontal_fins, "parallel plates": _plates,
}  # fmt: skip


def _duct(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.ducts import duct_film

    return partial(duct_film, diameter=_millimetres(table, "diameter_mm"), length=_size(table), fluid=fluid)


def _fin_channel(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.fins import heiles_decaying

    end, turbulence = table.number("speed_at_end", 1.0, high=1.0), table.number("turbulence", 1.7)
    return partial(
        heiles_decaying, diameter=_millimetres(table, "diameter_mm"), length=_size(table), decay=partial(_line, end),
        turbulence=turbulence, fluid=fluid,
    )  # fmt: skip


def _line(end: float, x: float) -> float:
    return 1.0 + (end - 1.0) * x


def _flat(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.forced import flat_plate

    return partial(flat_plate, length=_size(table), fluid=fluid)


def _across(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.forced import churchill_bernstein

    return partial(churchill_bernstein, diameter=_size(table), fluid=fluid)


def _end_space(table: Table, fluid: Fluid) -> Film:
    from lumped.correlations.end_space import end_space

    return partial(end_space, k1=table.number("k1", 15.0), k2=table.number("k2", 0.4), k3=table.number("k3", 0.9))


FORCED: dict[str, Callable[[Table, Fluid], Film]] = {
    "plate": _flat, "cylinder": _across, "fin channel": _fin_channel, "duct": _duct, "end space": _end_space,
}  # fmt: skip


def over(table: Table) -> Law:
    """Moving air over a known surface; its speed is `m_s_per_unit` times an input."""
    fluid = _air(table)(table.number("fluid_degC", 30.0, low=-60.0, high=200.0))
    film = FORCED[table.word("surface", None, FORCED)](table, fluid)
    scale = table.number("m_s_per_unit", 1.0, low=1e-12)
    return FilmOver(table.word("speed"), partial(_scaled, film, scale), table.number("up_to_m_s", 50.0) / scale)


def _scaled(film: Film, scale: float, x: float) -> tuple[float, Info]:
    return film(scale * x)


def gap(table: Table) -> Law:
    """From rotor to stator through the air between them, over the rotor's surface; speed in 1/min."""
    radius, width = _millimetres(table, "rotor_radius_mm"), _millimetres(table, "gap_mm")
    fluid = _air(table)(table.number("fluid_degC", 80.0, low=-60.0, high=200.0))
    law = table.word("law", "taylor", ("taylor", "becker-kaye"))
    film = partial(_gap_film, law, radius, width, fluid)
    return FilmOver(table.word("speed", "speed_rpm"), film, table.number("up_to_rpm", 20000.0, low=1.0))


def _gap_film(law: str, radius: float, width: float, fluid: Fluid, rpm: float) -> tuple[float, Info]:
    from lumped.correlations.air_gap import becker_kaye, taylor_film

    if law == "becker-kaye":
        return becker_kaye(rpm * RPM, radius, width, fluid)
    one, info = taylor_film(rpm * RPM, radius, width, fluid)
    return 0.5 * one, info


def contact(table: Table) -> Law:
    """A joint: an effective gap of still air, a gap from the table of joints, or a pair of pressed materials."""
    from lumped.correlations.contacts import GAPS, PRESSED, contact_film, gap_film

    if "gap_mm" in table:
        return Fixed(gap_film(_millimetres(table, "gap_mm")))
    if "pair" in table:
        return Fixed(contact_film(table.word("pair", None, PRESSED))[0])
    return Fixed(gap_film(GAPS[table.word("joint", None, GAPS)]))
