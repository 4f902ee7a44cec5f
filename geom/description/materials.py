"""What things are made of: one table, every value with its source and spread; and a steady colour for each."""

import colorsys
import csv
import hashlib
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

from geom.errors import InputError

K_AIR = 0.028  # W/m/K at 60 degC
TABLE = Path(__file__).parent / "materials.toml"


@dataclass(frozen=True)
class Mixture:
    """Wires in resin: share of conductor in the cross-section, conductivities (W/m/K) of it and of what is between.

    along : share of wire length along the axis;  shape : of the wires, "round" or "flat", or "bar": a single one, what
    insulates it being a contact
    """

    fill: float
    k_conductor: float
    k_between: float
    along: float
    shape: str


@dataclass(frozen=True)
class Material:
    """Thermal properties near 60 degC.

    k_plane, k_axial : conductivity across and along the machine's axis (W/m/K)
    rho : density (kg/m3); cp : specific heat (J/kg/K); emissivity : of its usual surface, 0 to 1
    spreads, sources : of each of these by its name: relative 1-sigma as found in practice, and where from
    mixture : what a winding is made of; its conductivities here are those of the formula, see fem.matrices.winding
    """

    name: str
    k_plane: float
    k_axial: float
    rho: float
    cp: float
    emissivity: float
    spreads: Mapping[str, float] = field(hash=False)
    sources: Mapping[str, str] = field(hash=False)
    mixture: Mixture | None = None

    @property
    def spread(self) -> float:
        """Relative 1-sigma of the conductivity across the axis: what fill, resin and voids move."""
        return self.spreads["k_plane"]

    @property
    def source(self) -> str:
        """Where that conductivity is from."""
        return self.sources["k_plane"]


Properties = tuple[tuple[str, float, str], ...]  # of a part: name, value, source, where not as in the table
LIMITS = {  # from aerogel to diamond; of cp from heavy metals to wet stuffing
    "k": (0.005, 2500.0),
    "k_plane": (0.005, 2500.0),
    "k_axial": (0.005, 2500.0),
    "rho": (1.0, 25000.0),
    "cp": (50.0, 6000.0),
    "emissivity": (0.0, 1.0),
}
CONDUCTOR = {"k_conductor": 385.0, "rho_conductor": 8930.0, "cp_conductor": 390.0}  # copper, of windings


def in_limits(key: str, value: float) -> bool:
    """Has a solid such a value of this property of Material, or a conductor of this one of CONDUCTOR?"""
    low, high = LIMITS[key.removesuffix("_conductor")]
    return low <= value <= high


def read_entry(entry: Any, usual: str, where: str) -> tuple[str, Properties]:
    """What [materials] says of a part: a name of the table, or {like = NAME, k = ..., source = "..."}.

    usual : the name where the entry has no `like`.  k is both conductivities.
    Returns the name, and (property, value, source) of what is not as in the table. Of a winding only the conductor has
    values, k_conductor (W/m/K), rho_conductor and cp_conductor: the rest follows from fill and impregnation.
    Raises InputError for an unknown name or property, and for a value that no solid has.
    """
    if not isinstance(entry, Mapping):
        return material(entry, where).name, ()
    name = material(entry.get("like", usual), where).name
    source = entry.get("source", "the machine file")
    if not isinstance(source, str):
        raise InputError(f"source = {str(source)[:40]} is not text", where, "words in quotes")
    numbers = {key: value for key, value in entry.items() if key not in ("like", "source")}
    wound = material_table()[name].mixture is not None
    right = f"one of: like, {', '.join(CONDUCTOR if wound else LIMITS)}, source"
    for key, value in numbers.items():
        if wound and key in LIMITS:
            raise InputError(f"{key} of a winding", where, f"fill and impregnation in [geometry], or {right}")
        if key not in (CONDUCTOR if wound else LIMITS):
            raise InputError(f"unknown key {key!r}", where, right)
        if isinstance(value, bool) or not isinstance(value, int | float) or not in_limits(key, value):
            right = "a number from {:g} to {:g}".format(*LIMITS[key.removesuffix("_conductor")])
            raise InputError(f"{key} = {str(value)[:40]} is not possible", where, right)
    return name, tuple((key, float(value), source) for key, value in _each(numbers).items())


def entry_of(name: str, properties: Properties) -> str | dict[str, Any]:
    """What `read_entry` reads as this material."""
    if not properties:
        return name
    return {"like": name, **{key: value for key, value, _ in properties}, "source": properties[0][2]}


def with_properties(usual: Material, properties: Properties) -> Material:
    """The material, or a winding's conductor, with other values; their spreads stay as the table has them."""
    values: dict[str, Any] = {key: value for key, value, _ in properties}
    sources = {**usual.sources, **{key: source for key, _, source in properties}}
    if values and usual.mixture is not None:
        conductor, fill = {**CONDUCTOR, "k_conductor": usual.mixture.k_conductor, **values}, usual.mixture.fill
        mixture = replace(usual.mixture, k_conductor=conductor["k_conductor"])
        mass = conductor["rho_conductor"]
        rho = usual.rho + fill * (mass - CONDUCTOR["rho_conductor"])
        copper = CONDUCTOR["rho_conductor"] * CONDUCTOR["cp_conductor"]
        heat = usual.rho * usual.cp + fill * (mass * conductor["cp_conductor"] - copper)
        k_plane, k_axial = _bundle(mixture)
        values = {"mixture": mixture, "k_plane": k_plane, "k_axial": k_axial, "rho": rho, "cp": heat / rho}
    return replace(usual, **values, sources=sources) if values else usual


@cache
def material_table() -> Mapping[str, Material]:
    """The whole table by name."""
    return {name: _read(name, values) for name, values in _table().items()}


def material(name: str, where: str = "[materials]") -> Material:
    """One material; InputError names the known ones."""
    if not isinstance(name, str) or name not in material_table():
        raise InputError(f"unknown material {name!r}", where, f"known: {', '.join(sorted(material_table()))}")
    return material_table()[name]


def filled(name: str, fill: float, impregnation: float, along: float | None = None) -> Material:
    """A winding material at another fill and impregnation; a material that is not a mixture stays as it is.

    fill : share of conductor in the cross-section; impregnation : share of the rest that resin fills, air the remainder
    along : share of wire length along the axis, None for the material's
    """
    values = _table()[name]
    if "mixture" not in values:
        return material(name)
    changed = {"fill": fill, "impregnation": impregnation, **({} if along is None else {"along": along})}
    return _read(name, {**values, "mixture": {**values["mixture"], **changed}})


@cache
def _table() -> Mapping[str, Any]:
    return tomllib.loads(TABLE.read_text(encoding="utf-8"))


def _read(name: str, values: Mapping[str, Any]) -> Material:
    numbers = {key: values[key] for key in ("k_plane", "k_axial", "rho", "cp", "emissivity") if key in values}
    numbers |= _mixed(**values["mixture"]) if "mixture" in values else {}
    return Material(name=name, **numbers, spreads=_each(values["spread"]), sources=_each(values["source"]))


def _each(table: Mapping[str, Any]) -> dict[str, Any]:
    """The table with "k" given to both conductivities."""
    both = dict.fromkeys(("k_plane", "k_axial"), table["k"]) if "k" in table else {}
    return {**both, **{key: value for key, value in table.items() if key != "k"}}


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


def _mixed(
    fill: float,
    k_resin: float,
    along: float = 1.0,
    k_conductor: float = CONDUCTOR["k_conductor"],
    impregnation: float = 1.0,
    shape: str = "round",
) -> dict[str, Any]:
    """Copper wires in resin, with air where the resin is missing."""
    # Conductivity of resin with air, the resin dispersed in it (W/m/K): Hashin and Shtrikman's lower bound
    k_between = k_resin if impregnation >= 1.0 else winding_conductivity(impregnation, k_resin, K_AIR)[0]
    mixture = Mixture(fill, k_conductor, k_between, along, shape)
    k_plane, k_axial = _bundle(mixture)
    copper, resin = fill * CONDUCTOR["rho_conductor"], (1 - fill) * impregnation * 1350.0
    cp = (copper * CONDUCTOR["cp_conductor"] + resin * 1500.0) / (copper + resin)
    return {"k_plane": k_plane, "k_axial": k_axial, "rho": copper + resin, "cp": cp, "mixture": mixture}


def _bundle(mixture: Mixture) -> tuple[float, float]:
    """Conductivity of a winding across and along the axis (W/m/K)."""
    across, lengthwise = winding_conductivity(mixture.fill, mixture.k_conductor, mixture.k_between)
    across = lengthwise if mixture.shape == "bar" else across
    return across, mixture.along * lengthwise + (1 - mixture.along) * across


with Path(__file__).with_name("palette.csv").open(encoding="utf-8", newline="") as _file:
    _, *_rows = csv.reader(_file)
_COLOURS = {word: (float(red), float(green), float(blue)) for word, red, green, blue in _rows}


def colour(material: str) -> tuple[float, float, float]:
    """Red, green, blue (0 to 1): copper is copper, what is not listed gets a pale hue from its name."""
    for word, rgb in _COLOURS.items():
        if word in material:
            return rgb
    hue = int(hashlib.sha256(material.encode()).hexdigest()[:4], 16) / 65535
    return colorsys.hsv_to_rgb(hue, 0.15, 0.75)
