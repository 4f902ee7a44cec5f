"""NAME=VALUE on the command line."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, nan

from geom.constants import ZERO_C
from geom.errors import InputError


def read_pairs(
    words: Sequence[str], option: str, what: str, right: str, low: float = -inf, high: float = inf
) -> dict[str, float]:
    """Values between two bounds by name. Raises InputError for anything else, and for a name that comes twice."""
    out: dict[str, float] = {}
    for one in words:
        name, _, text = one.rpartition("=")
        if name in out:
            raise InputError(f"'{name}' is given twice", option, f"one {what} for each")
        try:
            value = float(text.replace(",", "."))
        except ValueError:
            value = nan
        if not name or not low < value < high:
            raise InputError(f"'{one}' is not {'an' if what[0] in 'aeiou' else 'a'} {what}", option, right)
        out[name] = value
    return out


def read_limits(words: Sequence[str]) -> dict[str, float]:
    """PLACE=DEGC, ..."""
    return read_pairs(words, "--limit", "limit", "PLACE=DEGC, for example winding=155", -ZERO_C, 3000.0)
