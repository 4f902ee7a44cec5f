"""The record of a thermal test in a file: what was read when, by which meters."""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from pathlib import Path

from extras.bench.measuring.protocol import Cold, Hot, Record
from thermoscope import plugin as th

Pairs = tuple[tuple[float, float], ...]


def read_record(file: Path) -> Record:
    """The record of a test; InputError for unknown keys and values that cannot be."""
    top = th.TomlTable(th.read_toml(file, "a record of a thermal test, see docs/how-to/thermal-test.md"), str(file))
    record = record_in(top, file)
    top.close()
    return record


def record_in(top: th.TomlTable, file: Path) -> Record:
    """The record of a test in a file that may hold more; who reads the rest closes it."""
    machine, cold, load, hot = (top.table(name) for name in ("machine", "cold", "load", "hot"))
    coefficients, meters = top.table("coefficients"), top.table("meters")
    record = Record(
        machine.number("rated_kW"),
        _cold(cold) if cold.data else None,
        timed_pairs(load, file, 60.0),
        load.number("resolution_K", 0.5),
        _hot(hot, file) if hot.data else None,
        th.meter_of(meters, "resistance", th.OHMMETER),
        th.meter_of(meters, "emf", th.VOLTMETER),
        beta=_range(coefficients, "beta_percent_K", th.COPPER),
        alpha=_range(coefficients, "alpha_percent_K", th.NDFEB),
        curve=th.saturation_of(coefficients),
    )
    for one in (machine, load, coefficients, meters):
        one.close()
    return record


def _optional(table: th.TomlTable, key: str) -> float | None:
    return table.number(key) if key in table else None


def _cold(table: th.TomlTable) -> Cold:
    needed = (table.number(key) for key in ("room_degC", "machine_degC", "resistance_ohm"))
    others = (_optional(table, key) for key in ("emf_V", "speed_rpm", "range_ohm", "hours_since_run"))
    cold = Cold(*needed, *others)
    table.close()
    return cold


def _hot(table: th.TomlTable, file: Path) -> Hot:
    ambient, pairs = table.number("ambient_degC"), timed_pairs(table, file, 1.0)
    hot = Hot(ambient, pairs, *(_optional(table, key) for key in ("emf_V", "speed_rpm", "range_ohm")))
    table.close()
    return hot


def timed_pairs(source: th.TomlTable, beside: Path, unit_s: float) -> Pairs:
    """(time, value) of a table's `readings`, or of its file; the file's times (s) are divided by `unit_s`."""
    rows: Iterable[Sequence[float]]
    if "readings" in source:
        rows = source.rows("readings", of="value")
        if any(len(row) != 2 for row in rows):
            raise source.error("readings is not a list of pairs", "readings = [[time, value], ...]")
    elif "file" in source:
        path, time, column = beside.parent / source.word("file"), source.word("time", "time_s"), source.word("column")
        file = th.recording(path)
        frame = th.read_recording(file, source.word("worksheet", ""))
        for name in (time, column):
            if name not in frame.columns:
                raise source.error(f"column '{name}' is not in {path.name}", f"known: {', '.join(frame.columns)}")
        rows = [(t / unit_s, v) for t, v in th.pairs(frame, time, column, file)]
    else:
        return ()
    if late := next((b for (a, _), (b, _) in pairwise(rows) if b <= a), None):
        raise source.error(f"the time {late:g} does not come after the one before it", "readings at rising times")
    return tuple((float(t), float(v)) for t, v in rows)


def _range(table: th.TomlTable, key: str, usual: th.Reading) -> th.Reading:
    if key not in table:
        return usual
    values = table.numbers(key)
    if len(values) not in (1, 2):
        raise table.error(f"{key} = {list(values)} is not possible", "one number, or [lowest, highest]")
    low, high = values[0], values[-1]
    return th.Reading(usual.name, (low + high) / 200.0, abs(high - low) / 200.0)
