"""The thermal sections of a machine file, read into frozen settings: [contacts], [films], [losses], [fans]."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from geom.constants import ALPHA_CU
from geom.description.machine import Machine
from geom.errors import InputError
from lumped.correlations.end_space import SCHUBERT
from lumped.schemas.bounds import bounds
from lumped.schemas.reader import Table, excerpt, suggestion

K_AIR = 0.026  # W/m/K, still air in a contact gap near 30 degC

S = TypeVar("S")


@dataclass(frozen=True)
class Losses:
    """Losses at the rated point; the field's R_a + R_f follows from the ratings (eq. 1-6 of a series machine).

    Resistances (mOhm) at `reference_C`; friction and windage (W) at the rated speed, iron (W) also at rated current.
    armature_in_end_windings: share of the armature's conductor length outside the core, both ends together;
    windage_in_gap: share of the windage that heats the gap's air, the rest heats both end spaces alike.
    """

    armature_resistance_mOhm: float = 28.6
    field_resistance_mOhm: float = 19.0
    reference_C: float = 75.0
    temperature_coefficient_per_K: float = ALPHA_CU
    brush_drop_V: float = 2.0
    brush_friction_W: float = 250.0
    bearing_friction_W: float = 50.0
    windage_W: float = 60.0
    iron_W: float = 1000.0
    iron_current_exponent: float = 0.75
    iron_speed_exponent: float = 1.4
    iron_in_poles: float = 0.25
    armature_in_end_windings: float = 0.5
    windage_in_gap: float = 0.2


@dataclass(frozen=True)
class Films:
    """Surfaces and films: emissivity (1) of all outer faces, None: each by its material; the end-space set
    k1 (1 + k2 v^k3), v a share of the rotor's tip speed.

    Sets and shares: Schubert's, as collected by Staton, Boglietti and Cavagnino 2005; the channel between the poles
    is taken as half as well stirred as an end shield.
    """

    emissivity: float | None = None
    end_space_k1_W_m2K: float = SCHUBERT[0]
    end_space_k2: float = SCHUBERT[1]
    end_space_k3: float = SCHUBERT[2]
    still_wall_share: float = 0.2
    moving_wall_share: float = 1.0
    channel_wall_share: float = 0.1


@dataclass(frozen=True)
class Fan:
    """An air stream through the machine: flow (m3/h), the spaces it passes, the share that takes the air gap."""

    flow_m3_h: float = 138.0
    gap_share: float = 0.15
    air_C: float = 40.0


def read_films(machine: Machine) -> Films:
    table = {key: value for key, value in machine.sections.get("films", {}).items() if key != "outer"}
    return read(Films, table, f"{machine.name} [films]")


def read(kind: type[S], table: Mapping[str, Any], where: str) -> S:
    """A settings object from a table of the machine file; unknown keys and numbers out of bounds are refused."""
    names = [f.name for f in fields(kind)]  # type: ignore[arg-type]
    source = Table(table, where)
    values = {key: source.number(key) for key in names if key in source}
    source.close()
    return kind(**values)


def contact_coefficients(table: Mapping[str, Any], names: list[str], where: str) -> dict[str, float]:
    """Contact coefficient (W/m2/K) of every contact "a|b"; a gap in mm is taken as still air.

    table : "a|b" -> {gap_mm = ...} or {h_W_m2K = ...}; "default" holds for those not listed
    """
    for key in table:
        if key != "default" and key not in names:
            raise InputError(f"no contact '{key}'", where, suggestion(key, names, "this machine has"))
    default = {"gap_mm": 0.01}
    return {name: _coefficient(table.get(name, table.get("default", default)), f"{where} '{name}'") for name in names}


def _coefficient(entry: Any, where: str) -> float:
    if isinstance(entry, Mapping) and len(entry) == 1:
        (key, value), *_ = entry.items()
        if key in ("gap_mm", "h_W_m2K") and value != 0 and bounds(key).hold(value):
            return K_AIR / (value * 1e-3) if key == "gap_mm" else float(value)
    right = "{gap_mm = 0.03} or {h_W_m2K = 900}, a positive number"
    raise InputError(f"{excerpt(entry)} is not a contact", where, right)
