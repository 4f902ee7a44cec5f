"""Declared parameters of a machine family: unit, default, range and meaning, each written once.

Most lengths are measured in others (`Scale`): a file gives the length itself (tooth_mm), or its ratio to its scale
(tooth_ratio), or neither; then it has the proportion of the default machine. Any ratios within their bounds fit.
"""

import csv
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geom.description.geometry import Geometry
from geom.errors import InputError

UNITS = {"mm": 1e-3, "deg": math.pi / 180}


Length = Callable[[Geometry], float]  # (m), of the geometry so far


@dataclass(frozen=True)
class Measure:
    """What lengths are measured in, each within its own bounds: measure(low, high) is the scale of one.

    name : in words, after "of";  span, start : both of the geometry so far (m)
    """

    name: str
    span: Length
    start: Length = lambda g: 0.0

    def __call__(self, low: float, high: float) -> "Scale":
        return Scale(self.name, low, high, self.span, self.start)


@dataclass(frozen=True)
class Scale:
    """A length is start + ratio * span (m); any ratio between low and high makes a machine that fits."""

    name: str
    low: float
    high: float
    span: Length
    start: Length


@dataclass(frozen=True)
class Parameter:
    """One geometric parameter of a family.

    key : "group.name_unit" as written in the machine file; no suffix means a count or a ratio
    default, low, high : in the unit of the key
    choices : allowed words, for a parameter that is a choice; then low and high play no role
    off : whether 0 stands for none, beside what low and high, or the scale, allow
    of : of a length, what it is measured in;  like : of one without, the key it follows in proportion if that is given
    """

    key: str
    default: float | int | str
    low: float = 0.0
    high: float = 0.0
    doc: str = ""
    choices: tuple[str, ...] = ()
    off: bool = False
    of: Scale | None = None
    like: str = ""

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
    def ratio_name(self) -> str:
        return f"{self.attribute}_ratio"

    @property
    def usual(self) -> float:
        """The default in SI."""
        assert not isinstance(self.default, str)
        return self.default * UNITS[self.unit] if self.unit else self.default

    @property
    def allowed(self) -> str:
        if self.choices:
            return "one of " + ", ".join(self.choices)
        kind = "an integer from" if isinstance(self.default, int) else "from"
        return f"{'0, or ' * self.off}{kind} {self.low:g} to {self.high:g} {self.unit}".rstrip()

    @property
    def allowed_ratio(self) -> str:
        assert self.of is not None
        return f"{'0, or ' * self.off}from {self.of.low:g} to {self.of.high:g} of {self.of.name}"

    def checked(self, value: Any, where: str) -> float | int | str:
        """The value in SI, or an InputError that names key, value and range."""
        place = f"{where} [geometry.{self.group}] {self.name}"
        if not self._valid(value):
            raise InputError(f"{value!r} is not possible", place, f"allowed: {self.allowed}")
        return value * UNITS[self.unit] if self.unit else value

    def checked_ratio(self, value: Any, where: str) -> float:
        """The ratio, or an InputError that names key, value and range."""
        assert self.of is not None
        if not is_number(value) or not (self.of.low <= value <= self.of.high or (self.off and value == 0)):
            place = f"{where} [geometry.{self.group}] {self.ratio_name}"
            raise InputError(f"{value!r} is not possible", place, f"allowed: {self.allowed_ratio}")
        return float(value)

    def _valid(self, value: Any) -> bool:
        if self.choices:
            return value in self.choices
        kinds = int if isinstance(self.default, int) else (int, float)
        return (
            isinstance(value, kinds)
            and is_number(value)
            and (self.low <= value <= self.high or (self.off and value == 0))
        )


def is_number(value: Any) -> bool:
    """What a file gave; true and false are no numbers."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def length(
    key: str, usual: float, low: float, high: float, of: Scale | None, doc: str, off: bool = False, like: str = ""
) -> Parameter:
    """A length (mm) under a key without its unit, "group.name"."""
    return Parameter(f"{key}_mm", float(usual), float(low), float(high), doc, off=off, of=of, like=like)


def choice(key: str, words: tuple[str, ...], doc: str) -> Parameter:
    """A choice among words, of which the first is the default."""
    return Parameter(key, words[0], doc=doc, choices=words)


def parameter_sets(
    table: Path, measures: Mapping[str, Measure], usual: str = "usual"
) -> dict[str, tuple[Parameter, ...]]:
    """The parameters that a table (CSV) declares, by their set.

    measures : of lengths, by the name that the table has for them;  usual : column of the defaults; where it is empty,
    those of all machines hold. Words with | between them are a choice, of which the first is the default.
    """
    sets: dict[str, tuple[Parameter, ...]] = {}
    with table.open(encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows):
            key, words = row["key"], row["usual"].split("|")
            if len(words) > 1:
                first = words[0] if usual == "usual" else row[usual] or words[0]
                one = Parameter(key, first, doc=row["meaning"], choices=tuple(words))
            else:
                number = float if key.endswith("_mm") or "." in row["usual"] else int
                default, low, high = (number(row[name]) for name in (usual if row[usual] else "usual", "low", "high"))
                scale = measures[row["measure"]](float(row["least"]), float(row["most"])) if row["measure"] else None
                one = Parameter(key, default, low, high, row["meaning"], (), bool(row["or_none"]), scale, row["like"])
            sets[row["set"]] = (*sets.get(row["set"], ()), one)
    return sets
