"""Tables with a row for every reading of every signal, as databases and control systems write them."""

import itertools
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np

from geom.description.roles import Role
from measured.headers.cells import EMPTY, TIMES, is_clock, is_date, is_reading, is_unit, number, split_unit, unit_of
from measured.headers.layout import MISSING
from measured.headers.words import RUNS, VOCABULARY, is_time, quantities_of, roles_of, tokens

SERIES, VALUES = (frozenset(VOCABULARY["words"][name].split()) for name in ("series", "value"))
MOST = 200  # signals in such a table
RARE = 10  # readings of the other signals, beside which one alone is none
LEAST = 3  # readings of a signal, on average
HOLD = "hold until the next reading"
BOUNDARIES = ([Role.AMBIENT], [Role.COOLANT])


def side_by_side(
    names: Sequence[str], columns: Sequence[Sequence[Any]], where: str
) -> tuple[dict[str, list[Any]], list[str]]:
    """The time and a column for every signal of such a table, and doubts; empty for a table of any other kind.

    Signals with times of their own hold from each of them to the next, as homes and controllers log what changes;
    temperatures of parts go on between them.
    """
    varying = [j for j, cells in enumerate(columns) if any(cell != cells[0] for cell in cells)]
    of_clocks = {j for j in varying if all(is_date(cell) or is_clock(cell) for cell in columns[j][:LEAST])}
    times = [j for j in varying if is_time(names[j]) or j in of_clocks]
    times = times or [j for j in varying if unit_of(names[j]) in TIMES]  # beside a clock "min" is the least
    ids = [j for j, name in enumerate(names) if {"id", *SERIES} & {*tokens(name)} > {"id"}]  # sensor_id
    numbered = [j for j in ids if all(map(is_reading, columns[j]))]
    columns = [[f"{number(c):g}" for c in cells] if j in numbered else cells for j, cells in enumerate(columns)]
    keys = [j for j, name in enumerate(names) if set(tokens(name)) & SERIES and _is_key(columns[j], j in numbered)]
    keys = keys or [j for j, cells in enumerate(columns) if j not in times and _is_key(cells) and _are_signals(cells)]
    if not keys:
        return {}, []
    key = keys[0]
    times += [j for j, name in enumerate(names) if times and j != key and set(tokens(name)) & RUNS]  # of several tests
    full = [i for i, instant in enumerate(zip(*(columns[j] for j in times))) if any(map(_text, instant))]
    columns = [[cells[i] for i in full] for cells in columns] if times else columns  # no remarks under the readings
    rest = [j for j in range(len(names)) if j != key and j not in times]
    values = [j for j in rest if set(tokens(names[j])) & VALUES]
    numeric = [j for j in rest if any(map(is_reading, columns[j]))]
    clocks = list(zip(*(columns[j] for j in times), strict=True))
    tells = not values and any(map(quantities_of, {*map(_text, columns[key])}))  # a temperature, or a power
    of_instant = [j for j in numeric if tells and len({*zip(clocks, columns[j])}) == len({*clocks})]
    numeric = [j for j in numeric if j not in of_instant] if len(numeric) > 1 else numeric
    if not times or not (values or len(numeric) == 1):
        return {}, []
    value = [*values, *numeric][0]
    text = split_unit(names[value])[1]
    unit = text and f" [{text}]" if values else f" {names[value]}" if text or quantities_of(names[value]) else ""
    series: dict[str, dict[Any, Any]] = {}
    per_instant = {names[j]: dict(zip(clocks, columns[j])) for j in of_instant if j != value}
    signals = columns[key]
    once = {
        signal for signal, count in Counter(signals).items() if count == 1 and len(signals) > RARE * len({*signals})
    }
    if once:  # remarks of the logger, such as its end
        lines = [i for i, signal in enumerate(signals) if signal not in once]
        columns, clocks = [[cells[i] for i in lines] for cells in columns], [clocks[i] for i in lines]
        signals = columns[key]
    for j in (j for j in rest if j != value and _is_key(columns[j])):  # what tells signals apart besides: a place
        if len(set(zip(clocks, signals))) < 0.9 * len(clocks):
            signals = [f"{signal} {word}" for signal, word in zip(signals, columns[j], strict=True)]
    others = (list(map(_text, columns[j])) for j in rest if j != value)
    texts = next((c for c in others if all(is_unit(u) and not is_reading(u) for u in c if u)), [])
    units = {signal: f" [{text}]" for signal, text in zip(signals, texts) if text}
    for signal, instant, reading in zip(signals, clocks, columns[value], strict=True):
        if _text(signal):
            series.setdefault(f"{signal}{units.get(signal, unit)}", {})[instant] = reading
    instants: list[tuple[Any, ...]] = max((list(readings) for readings in series.values()), key=len)
    notes, lost = [], len(clocks) - sum(map(len, series.values()))
    if lost:
        notes.append(f"{Path(where).name}: {lost} readings share signal and time with another, and are left out")
    if any(not readings.keys() <= set(instants) for readings in series.values()):
        what = f"holds a row for every reading of {len(series)} signals ('{names[key]}'), each at its own times"
        instants = _in_order(dict.fromkeys(clocks), series.values())
        turns = _in_turns([*dict.fromkeys(map(_text, signals))], signals)  # one reader for all of them
        rule = "" if turns else f"; all but temperatures of parts {HOLD} of their signal"
        notes.append(f"{Path(where).name}: {what}{rule}")
        for signal, readings in series.items() if not turns else ():
            roles, quantities = roles_of(signal), quantities_of(signal)
            if roles[:1] not in BOUNDARIES and ("temperature" in quantities or (roles and not quantities)):
                continue
            last = None
            for instant in instants:
                reading = readings.get(instant)  # a word in its place is none
                readings[instant] = last = (
                    reading if is_reading(reading) and _text(reading).lower() not in EMPTY else last
                )
    common = {names[j]: [instant[i] for instant in instants] for i, j in enumerate(times)}
    series = per_instant | series
    return {**common, **{s: [readings.get(t) for t in instants] for s, readings in series.items()}}, notes


def _in_order(instants: Iterable[tuple[Any, ...]], series: Iterable[Iterable[Any]]) -> list[tuple[Any, ...]]:
    """Instants by their first cell, a number or a date with its parts in the order in which no signal runs back; else
    as the file has them, which clocks refuse where it runs back."""
    plain = {t: number(t[0]) for t in instants}
    try:
        plain |= {t: datetime.fromisoformat(str(t[0])).timestamp() for t, value in plain.items() if value != value}
    except ValueError:
        parts = {t: [float(n) for n in re.findall(r"\d+", " ".join(map(str, t)))] for t in plain}
        for year, month, day in ((2, 1, 0), (2, 0, 1)):
            at = {t: (*(p[i] for i in (year, month, day)), *p[3:]) for t, p in parts.items() if len(p) > LEAST}
            if len(at) == len(parts) and all(at[a] <= at[b] for one in series for a, b in itertools.pairwise(one)):
                return sorted(at, key=lambda t: at[t])
        return list(plain)
    return sorted(plain, key=lambda t: plain[t])


def _are_signals(cells: Sequence[Any]) -> bool:
    """Do most of its words say what a signal reads, and do they take turns or begin anew, as no state does?  Any words
    that come in one order all the time are names."""
    words = [*dict.fromkeys(map(_text, cells))]
    if _in_turns(words, cells):
        return True
    spoken = sum(bool(quantities_of(word) or roles_of(word)) for word in words)
    turns = sum(a != b for a, b in itertools.pairwise(cells))
    return len(words) > 2 and 2 * spoken > len(words) and (turns > len(cells) / 2 or turns == len(words) - 1)


def _in_turns(words: Sequence[str], cells: Sequence[Any]) -> bool:
    """Do several words come in one order all the time?"""
    return len(words) > 2 and all(_text(cell) == words[i % len(words)] for i, cell in enumerate(cells))


def _text(cell: Any) -> str:
    text = "" if cell is None else str(cell).strip()
    return "" if text in MISSING else text


def _is_key(cells: Sequence[Any], numbered: bool = False) -> bool:
    """Names of signals, that come again and again?"""
    if isinstance(cells, np.ndarray):  # numbers, perhaps a million of them
        return False
    counts = Counter(filter(None, map(_text, cells)))
    repeated = sum(counts.values()) >= LEAST * len(counts)
    return 1 < len(counts) <= MOST and repeated and (numbered or not any(map(is_reading, counts)))
