"""thermoscope bench protocol [RECORD.toml]

[machine]
rated_kW = 7
[cold]
room_degC = 21.0
machine_degC = 21.3
resistance_ohm = 0.52
emf_V = 290.0
speed_rpm = 383
range_ohm = 4.0            # upper end of the range that was set
hours_since_run = 14
[load]
file = "run.csv"           # .csv, .xlsx, .tdms, .mf4, .parquet
time = "time_s"
column = "T_lamination"
resolution_K = 0.5
[hot]
ambient_degC = 22.0
file = "cooling.csv"       # or readings = [[30, 0.668], [45, 0.667]]
time = "time_s"
column = "R_ohm"
emf_V = 266.1
speed_rpm = 383
[coefficients]
beta_percent_K = [0.392, 0.393]
alpha_percent_K = [-0.11, -0.10]
saturation = { emf_V = [240, 270, 300], remanence_T = [0.98, 1.12, 1.28] }   # optional, from the field of the machine
[meters]                   # those of the published procedure if not given; one table per range
resistance = [
    { range = [0.4, 4.0], percent = 0.25, offset = 0.002, resolution = 0.002 },
    { range = [4.0, 40.0], percent = 0.25, offset = 0.02, resolution = 0.02 },
]
emf = { range = [0, 1000], percent = 0.1, offset = 1.0 }
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from extras.bench.measuring.protocol import Cold, Hot, Protocol, Record
from thermoscope.plugin import (
    COPPER,
    NDFEB,
    OHMMETER,
    VOLTMETER,
    PropagatedUncertainty,
    Reading,
    Summary,
    Table,
    TomlTable,
    meter_of,
    pairs,
    read_recording,
    read_toml,
    recording,
    saturation_of,
)

Pairs = tuple[tuple[float, float], ...]


def read_record(file: Path) -> Record:
    """The record of a test; InputError for unknown keys and values that cannot be."""
    top = TomlTable(read_toml(file, "a record of a thermal test, see docs/how-to/thermal-test.md"), str(file))
    record = record_in(top, file)
    top.close()
    return record


def record_in(top: TomlTable, file: Path) -> Record:
    """The record of a test in a file that may hold more; who reads the rest closes it."""
    machine, cold, load, hot = (top.table(name) for name in ("machine", "cold", "load", "hot"))
    coefficients, meters = top.table("coefficients"), top.table("meters")
    record = Record(
        machine.number("rated_kW"),
        _cold(cold) if cold.data else None,
        timed_pairs(load, file, 60.0),
        load.number("resolution_K", 0.5),
        _hot(hot, file) if hot.data else None,
        meter_of(meters, "resistance", OHMMETER),
        meter_of(meters, "emf", VOLTMETER),
        beta=_range(coefficients, "beta_percent_K", COPPER),
        alpha=_range(coefficients, "alpha_percent_K", NDFEB),
        curve=saturation_of(coefficients),
    )
    for one in (machine, load, coefficients, meters):
        one.close()
    return record


def _optional(table: TomlTable, key: str) -> float | None:
    return table.number(key) if key in table else None


def _cold(table: TomlTable) -> Cold:
    cold = Cold(
        table.number("room_degC"),
        table.number("machine_degC"),
        table.number("resistance_ohm"),
        _optional(table, "emf_V"),
        _optional(table, "speed_rpm"),
        _optional(table, "range_ohm"),
        _optional(table, "hours_since_run"),
    )
    table.close()
    return cold


def _hot(table: TomlTable, file: Path) -> Hot:
    hot = Hot(
        table.number("ambient_degC"),
        timed_pairs(table, file, 1.0),
        _optional(table, "emf_V"),
        _optional(table, "speed_rpm"),
        _optional(table, "range_ohm"),
    )
    table.close()
    return hot


def timed_pairs(source: TomlTable, beside: Path, unit_s: float) -> Pairs:
    """(time, value) of a table's `readings`, or of its file; the file's times (s) are divided by `unit_s`."""
    if "readings" in source:
        rows = source.rows("readings", of="value")
        if any(len(row) != 2 for row in rows):
            raise source.error("readings is no list of pairs", "readings = [[time, value], ...]")
        return tuple((row[0], row[1]) for row in rows)
    if "file" not in source:
        return ()
    path, time, column = beside.parent / source.word("file"), source.word("time", "time_s"), source.word("column")
    file = recording(path)
    frame = read_recording(file, source.word("worksheet", ""))
    for name in (time, column):
        if name not in frame.columns:
            raise source.error(f"column '{name}' is not in {path.name}", f"known: {', '.join(frame.columns)}")
    return tuple((float(t) / unit_s, float(v)) for t, v in pairs(frame, time, column, file))


def _range(table: TomlTable, key: str, usual: Reading) -> Reading:
    if key not in table:
        return usual
    values = table.numbers(key)
    if len(values) not in (1, 2):
        raise table.error(f"{key} = {list(values)} is not possible", "one number, or [lowest, highest]")
    low, high = values[0], values[-1]
    return Reading(usual.name, (low + high) / 200.0, abs(high - low) / 200.0)


def protocol_summary(result: Protocol) -> Summary:
    """What to do next; the temperatures with their three uncertainties; then all steps."""
    spreads = [(n, s) for n, s in (("winding", result.winding), ("magnets", result.magnets)) if s is not None]
    headers = ["rise", "K", "worst case", "GUM 95 %", "Monte Carlo 95 %", "largest share"]
    rises = Table("Rises over the cold temperature", headers, [_row(n, s) for n, s in spreads], keep=["K", "GUM 95 %"])
    ways = "way=method | at (s)=at_s | degC=value | 1 sigma (K)=sd | how=words"
    off = Table.of("Winding when switched off", result.ways, ways)
    steps = Table.of("Thermal test", result.steps, "step=name | *state | *when | *what | found=words", ["refused"])
    return Summary(_in_short(result), [rises, off, steps], "--json FILE; docs/how-to/thermal-test.md")


def _in_short(result: Protocol) -> str:
    if result.refused:
        return f"{len(result.refused)} steps are refused: no temperature is given."
    rises = [
        f"{n} {s.value:.1f} K" for n, s in (("winding", result.winding), ("magnets", result.magnets)) if s is not None
    ]
    return f"Rises: {', '.join(rises)}." if rises else f"A thermal test has {len(result.steps)} steps."


def _row(name: str, s: PropagatedUncertainty) -> list[Any]:
    largest = max(s.budget, key=lambda n: s.budget[n])
    pairs = (s.worst, s.first_order, s.interval)
    return [name, s.value, *(f"{a:.1f} ... {b:.1f}" for a, b in pairs), f"{largest} ({s.budget[largest]:.1f} K)"]
