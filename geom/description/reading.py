"""The [geometry] of a machine file: what it gives, and what follows in the proportions of the default machine."""

import difflib
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

from geom.description.geometry import Geometry, Group
from geom.description.parameters import Parameter
from geom.errors import InputError


def read_geometry(parameters: Iterable[Parameter], table: Mapping[str, Any], where: str) -> Geometry:
    """Values in SI as `groups.attribute` (e.g. g.rotor.radius), with what is not given from what is.

    Raises InputError for an unknown group or key, a missing unit, a length given twice, or a value out of range.
    """
    parameters = tuple(parameters)
    _refuse_unknown({parameter.key: parameter for parameter in parameters}, table, where)
    return _Reading(parameters, table, where).geometry()


@cache
def usual_geometry(parameters: tuple[Parameter, ...]) -> Geometry:
    """The family's default machine, whose proportions hold where nothing is given."""
    groups: dict[str, Group] = {}
    for p in parameters:
        value = p.default if p.choices or not p.unit else p.usual
        setattr(groups.setdefault(p.group, Group()), p.attribute, value)
    return Geometry(**groups)


class _Reading:
    """Parameters of one file, each worked out when it is first asked for, by its scale or by another's."""

    def __init__(self, parameters: tuple[Parameter, ...], table: Mapping[str, Any], where: str) -> None:
        self.parameters, self.table, self.where = parameters, table, where
        self.known = {(p.group, p.attribute): p for p in parameters}
        self.so_far = Geometry(**{p.group: _Group(self, p.group) for p in parameters})

    def geometry(self) -> Geometry:
        groups: dict[str, Group] = {}
        for p in self.parameters:
            value = getattr(getattr(self.so_far, p.group), p.attribute)
            setattr(groups.setdefault(p.group, Group()), p.attribute, value)
        return Geometry(**groups)

    def value(self, p: Parameter) -> float | int | str:
        group = self.table.get(p.group, {})
        if p.of is not None and p.ratio_name in group:
            if p.name in group:
                place = f"{self.where} [geometry.{p.group}]"
                raise InputError(f"{p.name} and {p.ratio_name} are both given", place, "one of them")
            ratio = p.checked_ratio(group[p.ratio_name], self.where)
            return p.of.start(self.so_far) + ratio * p.of.span(self.so_far) if ratio else 0.0
        if p.name in group:
            return p.checked(group[p.name], self.where)
        return self._proportional(p) if p.of is not None and p.default else self._alike(p)

    def _proportional(self, p: Parameter) -> float:
        """As in the default machine, to the bit where all that it is measured in is."""
        assert p.of is not None
        usual = usual_geometry(self.parameters)
        start, span = p.of.start(self.so_far), p.of.span(self.so_far)
        first, whole = p.of.start(usual), p.of.span(usual)
        return p.usual if (start, span) == (first, whole) else start + (p.usual - first) / whole * span

    def _alike(self, p: Parameter) -> float | int | str:
        """The default; of a size that the file does not give, in proportion to one that it does."""
        other = next((q for q in self.parameters if q.key == p.like), None)
        if other is None or other.name not in self.table.get(other.group, {}):
            return p.checked(p.default, self.where)
        return p.usual * float(self.value(other)) / other.usual


class _Group:
    """A group of the geometry so far."""

    def __init__(self, reading: _Reading, name: str) -> None:
        self._reading, self._name = reading, name

    def __getattr__(self, attribute: str) -> Any:
        value = self._reading.value(self._reading.known[self._name, attribute])
        setattr(self, attribute, value)
        return value


def _refuse_unknown(parameters: Mapping[str, Parameter], table: Mapping[str, Any], where: str) -> None:
    groups = {parameter.group for parameter in parameters.values()}
    for group, keys in table.items():
        if group not in groups or not isinstance(keys, Mapping):
            raise InputError(f"unknown section [geometry.{group}]", where, _suggestion(group, groups))
        ratios = {p.ratio_name for p in parameters.values() if p.group == group and p.of is not None}
        for name in keys:
            if f"{group}.{name}" not in parameters and name not in ratios:
                _refuse_key(parameters, group, name, where)


def _refuse_key(parameters: Mapping[str, Parameter], group: str, name: str, where: str) -> None:
    siblings = {p.name: p for p in parameters.values() if p.group == group}
    ratios = [p.ratio_name for p in siblings.values() if p.of is not None]
    place = f"{where} [geometry.{group}]"
    with_unit = [
        p.name for p in siblings.values() if (p.unit and name.rsplit("_", 1)[0] == p.attribute) or name == p.attribute
    ]
    if with_unit:
        raise InputError(f"{name!r} lacks its unit", place, f"write {with_unit[0]}")
    raise InputError(f"unknown key {name!r}", place, _suggestion(name, [*siblings, *ratios]))


def _suggestion(word: str, words: Iterable[str]) -> str:
    near = difflib.get_close_matches(word, sorted(words), n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}known: {', '.join(sorted(words))}"
