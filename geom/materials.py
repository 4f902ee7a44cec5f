"""What things are made of: one table, every value with its source and spread."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from geom.errors import InputError

TABLE = Path(__file__).parent / "materials.toml"


@dataclass(frozen=True)
class Material:
    """Thermal properties near 60 degC.

    k_plane, k_axial : conductivity across and along the machine's axis (W/m/K)
    rho : density (kg/m3); cp : specific heat (J/kg/K); emissivity : of its usual surface, 0 to 1
    spread : relative 1-sigma of the conductivity as found in practice
    """

    name: str
    k_plane: float
    k_axial: float
    rho: float
    cp: float
    emissivity: float
    spread: float
    source: str


@cache
def material_table() -> Mapping[str, Material]:
    """The whole table by name."""
    table = tomllib.loads(TABLE.read_text(encoding="utf-8"))
    return {name: _read(name, values) for name, values in table.items()}


def material(name: str) -> Material:
    """One material; InputError names the known ones."""
    if name not in material_table():
        raise InputError(f"unknown material {name!r}", "[materials]", f"known: {', '.join(sorted(material_table()))}")
    return material_table()[name]


def _read(name: str, values: Mapping[str, float | str]) -> Material:
    numbers = {key: value for key, value in values.items() if key not in ("mixture", "note")}
    if "mixture" in values:
        numbers |= _mixture(**values["mixture"])  # type: ignore[arg-type]
    return Material(name=name, **numbers)  # type: ignore[arg-type]


def winding_conductivity(fill: float, k_conductor: float, k_resin: float) -> tuple[float, float]:
    """Conductivity of a bundle of wires in resin, across and along the wires (W/m/K).

    Across: Hashin and Shtrikman 1962, lower bound for parallel round fibres,
    k = k_r ((1 + v) k_c + (1 - v) k_r) / ((1 - v) k_c + (1 + v) k_r); along: the volume average.
    fill : share v of conductor in the cross-section, 0 to 1.

    >>> round(winding_conductivity(0.5, 385.0, 0.2)[0], 3)
    0.599
    """
    if not 0.0 <= fill < 1.0:
        raise InputError(f"fill {fill} is not possible", "winding", "from 0 to below 1")
    c, r = k_conductor, k_resin
    across = r * ((1 + fill) * c + (1 - fill) * r) / ((1 - fill) * c + (1 + fill) * r)
    return across, fill * c + (1 - fill) * r


def _mixture(fill: float, k_resin: float, along: float = 1.0, k_conductor: float = 385.0) -> dict[str, float]:
    """Copper wires in resin; `along` is the share of their length that runs along the axis."""
    across, lengthwise = winding_conductivity(fill, k_conductor, k_resin)
    return {
        "k_plane": across,
        "k_axial": along * lengthwise + (1 - along) * across,
        "rho": fill * 8930.0 + (1 - fill) * 1350.0,
        "cp": (fill * 8930.0 * 390.0 + (1 - fill) * 1350.0 * 1500.0) / (fill * 8930.0 + (1 - fill) * 1350.0),
    }
