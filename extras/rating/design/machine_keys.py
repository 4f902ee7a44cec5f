"""Numbers of a machine file that a design may change, by their keys with dots: geometry.jacket.height_mm."""

import copy
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from extras.rating.optimisation.electrics import FAN
from extras.rating.optimisation.space import Variable
from thermoscope import InputError, plugin as th

GEOMETRY = "geometry"
FLOWS = {"cooling.flow_L_per_min": th.FLOW, "fans.flow_m3_h": FAN}  # key -> the input of the network that it rates
# Key -> how far below and above its value a design goes where nothing else is said: halves and doubles of what moves
# by itself, less of what has to be cast or milled.
USUAL = {
    "cooling.flow_L_per_min": (0.5, 2.0),
    "fans.flow_m3_h": (0.5, 2.0),
    "geometry.jacket.channels": (0.5, 1.5),
    "geometry.jacket.turns": (0.5, 2.0),
    "geometry.jacket.height_mm": (0.6, 1.6),
    "geometry.jacket.rib_mm": (0.6, 1.6),
    "geometry.housing.turns": (0.5, 2.0),
    "geometry.housing.channel_mm": (0.6, 1.6),
    "geometry.housing.rib_mm": (0.6, 1.6),
    "geometry.housing.fins": (0.6, 1.5),
    "geometry.housing.fin_height_mm": (0.5, 2.0),
    "geometry.housing.fin_thickness_mm": (0.5, 1.5),
}


@dataclass(frozen=True)
class MachineFile:
    """sections : the tables of a machine file, from `where`;  machine : what they describe"""

    sections: Mapping[str, Any]
    where: str
    machine: th.MachineDescription

    @classmethod
    def read(cls, file: Path) -> "MachineFile | None":
        """By its path or the name of a machine that comes along; None for a STEP file, which has no keys."""
        path = file if file.exists() else th.library()[file.name.removesuffix(".toml")]
        if path.suffix != ".toml":
            return None
        sections = th.completed(th.read_toml(path, "a machine file with [machine] and [geometry]"), path.name)
        return cls(sections, path.name, th.machine_from(sections, path.name))

    @cached_property
    def parameters(self) -> dict[str, th.GeometryParameter]:
        """Key -> geometric parameter of the family."""
        return {f"{GEOMETRY}.{p.key}": p for p in th.families()[self.machine.family].parameters if not p.choices}

    def value(self, key: str) -> float:
        """As it stands, in the key's own unit; 0 where the file has no such number."""
        if key in self.parameters:
            p = self.parameters[key]
            return float(getattr(getattr(self.machine.geometry, p.group), p.attribute)) / th.GEOMETRY_UNITS.get(
                p.unit, 1.0
            )
        section, _, name = key.partition(".")
        return float(self.sections.get(section, {}).get(name, 0.0))

    def tables(self, values: Mapping[str, float]) -> dict[str, Any]:
        """The tables with some numbers replaced."""
        out = copy.deepcopy(dict(self.sections))
        for key, value in values.items():
            *groups, name = key.split(".")
            table = out
            for group in groups:
                table = table.setdefault(group, {})
            table[name] = round(value) if self._whole(key) else value
        return out

    def at(self, values: Mapping[str, float]) -> th.MachineDescription:
        """The machine with some numbers replaced; InputError where that is none."""
        return th.machine_from(self.tables({k: v for k, v in values.items() if self.knows(k)}), self.where)

    def knows(self, key: str) -> bool:
        return key in self.parameters or key in FLOWS

    def usual(self) -> list[Variable]:
        """What designs of this machine trade: flows, jacket and fins, as far as it has them."""
        return [self.variable(k, None) for k in USUAL if self.knows(k) and self.value(k) > 0.0 and self._there(k)]

    def variable(self, key: str, bounds: tuple[float, float] | None) -> Variable:
        """Between bounds (of the key's unit), or around its value as usual."""
        usual = self.value(key)
        if usual == 0.0 or not self.knows(key):
            keys = [k for k in (*FLOWS, *self.parameters) if self.value(k) > 0.0]
            raise InputError(f"'{key}' is not a number of {self.where}", "--vary", th.suggestion(key, keys))
        low, high = bounds or tuple(share * usual for share in USUAL.get(key, (0.5, 2.0)))
        p = self.parameters.get(key)
        if p is not None and bounds is None:
            low, high = max(low, p.low), min(high, p.high)
        return Variable(key, low, high, usual, self._whole(key), key in self.parameters)

    def _whole(self, key: str) -> bool:
        return key in self.parameters and isinstance(self.parameters[key].default, int)

    def _there(self, key: str) -> bool:
        """Jackets have channels or turns; fins of a housing that is a jacket are none."""
        g = self.machine.geometry
        jacket = getattr(g, "jacket", None)
        if jacket is not None and self.parameters.get(key) is not None and self.parameters[key].group == "jacket":
            other = {"channels": "helical", "turns": "zigzag"}.get(self.parameters[key].attribute)
            return bool(jacket.sides) and jacket.layout != other
        kind, name = getattr(getattr(g, "housing", None), "kind", None), self.parameters.get(key)
        if kind is None or name is None:
            return True
        finned = name.attribute in ("fins", "fin_height", "fin_thickness")
        return (kind == "spiral") is not finned and kind not in ("none", "plain")


def short_key(key: str) -> str:
    """The last word of a key."""
    return key.rpartition(".")[2]


def machine_file_text(file: MachineFile, values: Mapping[str, float], name: str, comments: Iterable[str]) -> str:
    """A machine file of a design; with `comments`. Lengths that the file left to proportions are left so."""
    import tomlkit

    tables = file.tables({k: float(f"{v:.6g}") for k, v in values.items() if file.knows(k)})
    tables["machine"] = {**tables.get("machine", {}), "name": name}
    out = tomlkit.document()
    for line in comments:
        out.add(tomlkit.comment(line))
    for section, table in tables.items():
        out[section] = table
    return tomlkit.dumps(out)
