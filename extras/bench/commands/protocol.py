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

from typing import Any

from extras.bench.measuring.protocol import Protocol
from thermoscope.plugin import PropagatedUncertainty, Summary, Table


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
