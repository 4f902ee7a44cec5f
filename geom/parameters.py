"""Declared parameters of a machine family: unit, default, range and meaning, each written once."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from geom.errors import InputError

UNITS = {"mm": 1e-3, "deg": math.pi / 180}


@dataclass(frozen=True)
class Parameter:
    """One geometric parameter of a family.

    key : "group.name_unit" as written in the machine file; no suffix means a count or a ratio
    default, low, high : in the unit of the key
    choices : allowed words, for a parameter that is a choice; then low and high play no role
    """

    key: str
    default: float | int | str
    low: float = 0.0
    high: float = 0.0
    doc: str = ""
    choices: tuple[str, ...] = ()

    @property
    def group(self) -> str:
        return self.key.split(".")[0]

    @property
    def name(self) -> str:
        return self.key.split(".")[1]

    @property
    def unit(self) -> str:
        suffix = self.name.rsplit("_", 1)[-1]
        return suffix if suffix in UNITS else ""

    @property
    def attribute(self) -> str:
        """The name without its unit, as the family's code sees it in SI."""
        return self.name.removesuffix(f"_{self.unit}") if self.unit else self.name

    @property
    def allowed(self) -> str:
        if self.choices:
            return "one of " + ", ".join(self.choices)
        kind = "an integer from" if isinstance(self.default, int) else "from"
        return f"{kind} {self.low:g} to {self.high:g} {self.unit}".rstrip()

    def checked(self, value: Any, where: str) -> float | int | str:
        """The value in SI, or an InputError that names key, value and range."""
        place = f"{where} [geometry.{self.group}] {self.name}"
        if not self._valid(value):
            raise InputError(f"{value!r} is not possible", place, f"allowed: {self.allowed}")
        return value * UNITS[self.unit] if self.unit else value

    def _valid(self, value: Any) -> bool:
        if self.choices:
            return value in self.choices
        kinds = int if isinstance(self.default, int) else (int, float)
        return isinstance(value, kinds) and not isinstance(value, bool) and self.low <= value <= self.high


def read_geometry(parameters: Iterable[Parameter], table: Mapping[str, Any], where: str) -> Any:
    """Values in SI as `groups.attribute` (e.g. g.rotor.radius), defaults filled in.

    Raises InputError for an unknown group or key, a missing unit, or a value out of range.
    """
    groups: dict[str, SimpleNamespace] = {}
    declared = {parameter.key: parameter for parameter in parameters}
    _refuse_unknown(declared, table, where)
    for parameter in declared.values():
        given = table.get(parameter.group, {}).get(parameter.name, parameter.default)
        group = groups.setdefault(parameter.group, SimpleNamespace())
        setattr(group, parameter.attribute, parameter.checked(given, where))
    return SimpleNamespace(**groups)


def _refuse_unknown(declared: Mapping[str, Parameter], table: Mapping[str, Any], where: str) -> None:
    groups = {parameter.group for parameter in declared.values()}
    for group, keys in table.items():
        if group not in groups or not isinstance(keys, Mapping):
            raise InputError(f"unknown section [geometry.{group}]", where, _known(group, groups))
        for name in keys:
            if f"{group}.{name}" not in declared:
                _refuse_key(declared, group, name, where)


def _refuse_key(declared: Mapping[str, Parameter], group: str, name: str, where: str) -> None:
    siblings = {p.name: p for p in declared.values() if p.group == group}
    place = f"{where} [geometry.{group}]"
    with_unit = [
        p.name for p in siblings.values() if (p.unit and name.rsplit("_", 1)[0] == p.attribute) or name == p.attribute
    ]
    if with_unit:
        raise InputError(f"{name!r} lacks its unit", place, f"write {with_unit[0]}")
    raise InputError(f"unknown key {name!r}", place, _known(name, siblings))


def _known(word: str, words: Iterable[str]) -> str:
    near = difflib.get_close_matches(word, sorted(words), n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}known: {', '.join(sorted(words))}"


def impossible(what: str, key: str, right: str) -> InputError:
    """The error for values that are each allowed but do not fit together."""
    group, name = key.split(".")
    return InputError(what, f"[geometry.{group}] {name}", right)
