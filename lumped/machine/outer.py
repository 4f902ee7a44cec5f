"""Outer faces: still air, radiation, and the air a shaft fan blows along the housing.

[films.outer] in a machine file: PART = { surface = "vertical plate", size_mm = 480, emissivity = 0.03, factor = 0.8,
fan = { h_W_m2K = 40, at_rpm = 1460 } }; the part's own fan stands in the place of what [fans.cowl] gives it.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from geom.description.machine import Machine
from geom.description.roles import Role
from lumped.correlations.fins import elenbaas, heiles, mean_of_decay
from lumped.correlations.forced import flat_plate
from lumped.correlations.info import Info
from lumped.correlations.natural import churchill_chu_cylinder, churchill_chu_plate, mcadams_plate
from lumped.correlations.streams import streamed
from lumped.correlations.tabulate import film_tabulated
from lumped.declarations.films import shaft_fan
from lumped.machine.settings import Films
from lumped.machine.shapes import Extent, extent, fins_of
from lumped.schemas.reader import Table
from lumped.transfer.laws import FILMS, FilmTable, Fixed, InputPower, Law, Radiation
from lumped.transfer.properties import Fluid, air
from lumped.transfer.streamed import Streamed

SURFACES = ("horizontal cylinder", "vertical plate", "horizontal plate", "radial fins")
# A fifth apart: straight between them to 0.1 %; no frame is hotter.
STILL_AIR_K = tuple(np.concatenate([[0.0], np.geomspace(0.15, 1.0, 11)[:-1], np.geomspace(1.0, 200.0, 30)]))
BLOWN_C = 40.0  # film temperature at which ranges are checked
CROWDED = 0.8  # still air along axial fins, over the bare cylinder's film (assumed)
END_SHIELD = 0.35  # a turned body shorter than this share of its diameter is a vertical plate


@dataclass(frozen=True)
class Outer:
    """How a part meets the surroundings.

    surface : one of SURFACES;  size (m): diameter, height, or area over perimeter
    emissivity times view radiates;  factor on the film of still air;  fan : film of a shaft fan's air, if any
    """

    surface: str
    size: float
    emissivity: float
    view: float = 1.0
    factor: float = 1.0
    spacing: float = 0.0
    fan: InputPower | None = None


@dataclass(frozen=True)
class Cowl:
    """A shaft fan that blows along the housing: air speed (m/s) leaving the cowl at `at_rpm`, and what is left of it.

    end_share: at the far end of the fins; rear_share, front_share: over the end shields (of `rear` and the other
    side). Shares: Motor-CAD's defaults; turbulence: the factor of Heiles (Staton and Cavagnino 2008).
    """

    air_speed: float
    at_rpm: float
    end_share: float
    rear_share: float
    front_share: float
    turbulence: float
    rear: str


def cowl_of(machine: Machine) -> Cowl | None:
    """[fans.cowl], if the machine has one."""
    data = machine.sections.get("fans", {}).get("cowl")
    if data is None:
        return None
    t = Table(data, f"{machine.name} [fans.cowl]")
    speed, turbulence = (t.number("air_speed_m_s"), t.number("at_rpm")), t.number("turbulence", 1.7)
    shares = (t.number("end_share", 0.2), t.number("rear_share", 0.774), t.number("front_share", 0.205))
    cowl = Cowl(*speed, *shares, turbulence, t.word("rear", "left", ("left", "right")))
    t.close()
    return cowl


def outer_films(machine: Machine, part: str, films: Films) -> dict[str, Law]:
    """Mechanism -> law (W/m2/K) of a part's outer face; they act in parallel.

    Still and blown air do not add: "blown" is what is beyond still air of (h_blown^3 + h_still^3)^(1/3) (Churchill).
    """
    outer, cowl = outer_of(machine, part, films), cowl_of(machine)
    natural, radiation = Fixed(outer.factor, still_air(outer)), Fixed(outer.emissivity * outer.view, Radiation())
    laws: dict[str, Law] = {"natural": natural, "radiation": radiation}
    blown = _fan(outer.fan) if outer.fan is not None else None if cowl is None else _blown(machine, part, cowl)
    if blown is not None:  # what the fan's air adds to still air: both are one film
        still = still_air(outer)
        still = replace(still, value=tuple(outer.factor * h for h in still.value))
        laws["blown"] = replace(blown, table=replace(blown.table, still=still))
    return laws


def outer_of(machine: Machine, part: str, films: Films) -> Outer:
    """What the machine file says of a part's outer face, and for the rest what its shape suggests."""
    usual = _usual(machine, part, films)
    table = machine.sections.get("films", {}).get("outer", {})
    if part not in table and "default" not in table:
        return usual
    t = Table(table.get(part, table.get("default")), f"{machine.name} [films.outer] {part}")
    surface = t.word("surface", usual.surface, SURFACES)
    size = t.number("size_mm") / 1e3 if "size_mm" in t or surface != usual.surface else usual.size
    radiates = (t.number("emissivity", usual.emissivity), t.number("view", usual.view))
    outer = Outer(surface, size, *radiates, t.number("factor", usual.factor), usual.spacing)
    if "fan" in t:
        inner = Table(t.raw("fan"), f"{t.where} fan")
        outer = replace(outer, fan=shaft_fan(inner))
        inner.close()
    t.close()
    return outer


def _usual(machine: Machine, part: str, films: Films) -> Outer:
    emissivity = machine.material_of(part).emissivity if films.emissivity is None else films.emissivity
    fins = fins_of(machine) if part == "housing" else None
    surface, size = _stands(extent(machine.part(part)))
    if fins is None:
        return Outer(surface, size, emissivity)
    # Between fins only the envelope radiates.
    if fins.axial:
        return Outer("horizontal cylinder", 2 * fins.root, emissivity, 1 / fins.area_ratio, CROWDED)
    return Outer("radial fins", 2 * (fins.root + fins.height), emissivity, 1 / fins.area_ratio, 1.0, fins.spacing)


def _stands(e: Extent) -> tuple[str, float]:
    wide, high, long = e.size
    if e.turned:
        return ("vertical plate" if long < END_SHIELD * high else "horizontal cylinder"), high
    if high < 0.25 * min(wide, long):
        return "horizontal plate", wide * long / (2 * (wide + long))
    return "vertical plate", high


@lru_cache(256)
def still_air(outer: Outer) -> FilmTable:
    """Film of still air (W/m2/K) over difference and film temperature; none without a difference."""
    size = outer.size

    def plate(surface: float, air: float) -> tuple[float, Info]:
        down, info = mcadams_plate(size, surface, air, upward=False)  # the narrower range of both
        return 0.5 * (down + mcadams_plate(size, surface, air, upward=True)[0]), info

    of: dict[str, Callable[[float, float], tuple[float, Info]]] = {
        SURFACES[0]: lambda s, a: churchill_chu_cylinder(size, s, a),
        SURFACES[1]: lambda s, a: churchill_chu_plate(size, s, a),
        SURFACES[2]: plate,
        SURFACES[3]: lambda s, a: elenbaas(outer.spacing, size, s, a),
    }
    law = film_tabulated(of[outer.surface], STILL_AIR_K)
    each = np.reshape(law.value, (FILMS, -1))
    each[:, 0] = 0.0
    return replace(law, value=tuple(each.ravel()))


def _blown(machine: Machine, part: str, cowl: Cowl) -> Streamed | None:
    """Films of the fan's air: fin channels by Heiles, end shields and a meshed fan's blades as flat plates."""
    e, fins = extent(machine.part(part)), fins_of(machine)
    if part == "housing" and fins is not None:
        share, diameter = mean_of_decay(cowl.end_share), fins.hydraulic_diameter
        length = fins.length if fins.axial else np.pi * (fins.root + fins.height)
        return _of_speed(cowl, share, lambda v, air: heiles(v, diameter, length, cowl.turbulence, air))
    if machine.part(part).role is Role.FAN:
        return _of_speed(cowl, 1.0, lambda v, air: flat_plate(v, 0.5 * e.size[1], air))
    if e.turned and e.size[2] < END_SHIELD * e.size[1]:
        spans = [part.span for part in machine.parts if part.role in (Role.END_SHIELD, Role.HOUSING)] or [(e.z0, e.z1)]
        on_left = e.z0 + e.z1 < min(a for a, _ in spans) + max(b for _, b in spans)  # of the body's middle
        share = cowl.rear_share if on_left is (cowl.rear == "left") else cowl.front_share
        return _of_speed(cowl, share, lambda v, air: flat_plate(v, e.size[1], air))
    return None


def _of_speed(cowl: Cowl, share: float, film: Callable[[float, Fluid], tuple[float, Info]]) -> Streamed:
    """A film of the air's speed and of its film temperature, over the shaft's speed."""
    per_rpm = share * cowl.air_speed / cowl.at_rpm
    return streamed("speed_rpm", cowl.at_rpm, lambda n, fluid: film(per_rpm * n, fluid), air, BLOWN_C, liquid=False)


def _fan(law: InputPower) -> Streamed:
    """The declared film of a part's own fan."""
    ((of, at, exponent),), info = law.terms, Info("fan", "declared", {}, {})
    return streamed(of, at, lambda n, _: (law.value * abs(n / at) ** exponent, info), air, BLOWN_C, liquid=False)
