"""Tables with a row for every reading of every signal, as databases and control systems write them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

from geom.errors import InputError
from measured.importing.cells import is_date, is_reading
from measured.importing.words import VOCABULARY, is_time, tokens

SERIES, VALUES = (frozenset(VOCABULARY["words"][name].split()) for name in ("series", "value"))
MOST = 200  # signals in such a table
LEAST = 3  # readings of a signal


def side_by_side(names: Sequence[str], columns: Sequence[Sequence[Any]], where: str) -> dict[str, list[Any]]:
    """The time and a column for every signal of such a table; empty for a table of any other kind.

    InputError where signals have times of their own, which one table of rows cannot hold.
    """
    key = next((j for j, name in enumerate(names) if set(tokens(name)) & SERIES and _is_key(columns[j])), None)
    if key is None:
        return {}
    values = [j for j, name in enumerate(names) if j != key and set(tokens(name)) & VALUES]
    times = [
        j
        for j, name in enumerate(names)
        if (is_time(name) or all(map(is_date, columns[j][:LEAST]))) and len(set(columns[j])) > 1
    ]
    rest = [j for j in range(len(names)) if j != key and j not in times]
    if not times or not (values or len(rest) == 1):
        return {}
    value, unit = (values[0], "") if values else (rest[0], f" {names[rest[0]]}")
    series: dict[str, dict[Any, Any]] = {}
    clocks = list(zip(*(columns[j] for j in times), strict=True))
    for signal, instant, reading in zip(columns[key], clocks, columns[value], strict=True):
        if signal is not None and str(signal).strip():
            series.setdefault(f"{signal}{unit}", {})[instant] = reading
    instants: list[tuple[Any, ...]] = max((list(readings) for readings in series.values()), key=len)
    if any(not readings.keys() <= set(instants) for readings in series.values()):
        what = f"holds a row for every reading of {len(series)} signals ('{names[key]}'), each at its own times"
        raise InputError(what, where, "a column for each signal, with common times")
    common = {names[j]: [instant[i] for instant in instants] for i, j in enumerate(times)}
    return {**common, **{s: [readings.get(t) for t in instants] for s, readings in series.items()}}


def _is_key(cells: Sequence[Any]) -> bool:
    """Names of signals, that come again and again?"""
    if any(map(is_reading, cells[:LEAST])):
        return False
    counts = Counter(str(c).strip() for c in cells if c is not None and str(c).strip())
    return 1 < len(counts) <= MOST and min(counts.values()) >= LEAST and not any(map(is_reading, counts))
