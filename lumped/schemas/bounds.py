"""What a number in a file may be, for every key: readers, schemas, messages and the page of keys follow bounds.csv.

A key says its unit in its name, so most bounds are those of a unit. They are far beyond any machine: what they refuse
is a slip (a sign, a decimal point, a unit), never an unusual design.
"""

import csv
import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

COLDEST, HOTTEST = -100.0, 3000.0  # degC: no test bench is colder; copper, steel and insulation are gone before
TINY = 1e-12  # stands for "above zero" where a number divides


@dataclass(frozen=True)
class Bounds:
    """low, high : both allowed;  whole : no fraction"""

    low: float
    high: float
    whole: bool = False

    def hold(self, value: Any) -> bool:
        """Is it a number within the bounds? True and false are not numbers, and nan lies nowhere."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            return False
        return self.low <= value <= self.high and (not self.whole or math.floor(value) == value)

    @property
    def words(self) -> str:
        """As a message and the page of keys say it."""
        return f"a {'whole ' if self.whole else ''}number from {self.low:g} to {self.high:g}"


ANY = Bounds(-1e12, 1e12)  # keeps out what overflows, and no more


def _table() -> dict[str, dict[str, Bounds]]:
    """Kind -> its bounds by name: of units, of keys without one or tighter than their unit, of whole numbers."""
    kinds: dict[str, dict[str, Bounds]] = {"unit": {}, "key": {}, "whole": {}}
    with Path(__file__).with_name("bounds.csv").open(encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows):
            one = Bounds(json.loads(row["low"]), json.loads(row["high"]), row["kind"] == "whole")
            kinds[row["kind"]] |= dict.fromkeys(row["keys"].split(), one)
    return kinds


UNITS, KEYS, WHOLE = _table().values()  # "table.key" where a key means something else in that table
KEYS |= WHOLE
LEAST_J_K = UNITS["J_K"].low
ENDINGS = sorted(UNITS, key=len, reverse=True)  # the longest first where one ends like another: W_m2K before K


def bounds(key: str, table: str = "") -> Bounds:
    """What a number under this key may be; `table` is the name of the table it stands in."""
    for name in (f"{table}.{key}", key):
        if name in KEYS:
            return KEYS[name]
    unit = next((unit for unit in ENDINGS if key == unit or key.endswith(f"_{unit}")), None)
    return ANY if unit is None else UNITS[unit]
