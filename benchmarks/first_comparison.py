"""From recordings to the first comparison: `test new` and `test compare`, each in a process of its own.

    python benchmarks/first_comparison.py [--only NAME ...] [--machine] [--json FILE]

Recordings are HUST's and TCLab's as published, and an hour of a motor bench at 1 Hz, written as every format that
benches write. The bench is two bodies with heat that a network does not know of: nothing here asks how good a model
is. The first row is a computer that never ran the tool (no compiled kernel), --machine adds one with a machine file
that was never meshed. CPU time is that of both processes; wall time depends on what else runs.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from scripts.published import benchmark_parser, measured_row, write_rows

ROOT = Path(__file__).resolve().parents[1]
HUST, TCLAB = ROOT / "cases" / "hust-ipmsm", ROOT / "cases" / "tclab"
WISHED_S = 60.0
ROWS, STEP_S = 3600, 1.0
UNITS = {
    "current": "A",
    "speed": "1/min",
    "torque": "Nm",
    "T_winding": "°C",
    "T_core": "°C",
    "T_housing": "°C",
    "T_bearing": "°C",
    "T_air": "°C",
}
Writer = Callable[[pd.DataFrame, Path], list[Path]]


def bench_hour() -> pd.DataFrame:
    """Seconds, inputs and temperatures (degC) of a motor that is switched on after five minutes."""
    t = STEP_S * np.arange(ROWS)
    on = np.where(t >= 300.0, 1.0, 0.0)
    noise = np.random.default_rng(0).normal(0.0, 0.05, (5, ROWS))
    ends = {  # rise (K) and time constant (s)
        "T_winding": (45, 500),
        "T_core": (35, 900),
        "T_housing": (25, 1500),
        "T_bearing": (18, 1800),
        "T_air": (1, 2000),
    }
    warm = {
        name: 21.0 + most * (1 - np.exp(-np.maximum(t - 300.0, 0.0) / tau)) + row
        for (name, (most, tau)), row in zip(ends.items(), noise, strict=True)
    }
    return pd.DataFrame({"time": t, "current": 120.0 * on, "speed": 1500.0 * on, "torque": 95.0 * on, **warm})


def headed(table: pd.DataFrame) -> pd.DataFrame:
    """Units in the header."""
    return table.rename(columns={name: f"{name} [{unit}]" for name, unit in UNITS.items()})


def as_german(table: pd.DataFrame, folder: Path) -> list[Path]:
    """Preamble, semicolons, decimal commas, a row of units, clock strings m:ss,f, the code page of Windows."""
    lines = ["Messdaten-Export", "Prüfer: Müller", "", ";".join(["Zeit", *UNITS]), ";".join(["mm:ss", *UNITS.values()])]
    for t, *row in table.itertuples(index=False):
        clock = f"{int(t // 60)}:{t % 60:04.1f}"
        lines.append(";".join([clock, *(f"{x:.3f}" for x in row)]).replace(".", ","))
    path = folder / "german.csv"
    path.write_bytes("\r\n".join(lines).encode("cp1252"))
    return [path]


def as_zoned(table: pd.DataFrame, folder: Path) -> list[Path]:
    """Tabs, dates with a zone across the end of summer time, UTF-16."""
    stamps = pd.Timestamp("2024-10-27T02:40:00+02:00") + pd.to_timedelta(table.time, unit="s")
    path = folder / "zoned.tsv"
    local = [s.tz_convert("Europe/Berlin").isoformat() for s in stamps]
    headed(table).assign(time=local).to_csv(path, sep="\t", index=False, encoding="utf-16")
    return [path]


def as_clock(table: pd.DataFrame, folder: Path) -> list[Path]:
    """Date and time of day in two columns, across midnight."""
    stamps = pd.Timestamp("2024-03-09 23:50:00") + pd.to_timedelta(table.time, unit="s")
    path = folder / "clock.csv"
    text = headed(table).assign(time=stamps.dt.strftime("%H:%M:%S"))
    text.insert(0, "date", stamps.dt.strftime("%d.%m.%Y"))
    text.to_csv(path, index=False)
    return [path]


def as_xlsx(table: pd.DataFrame, folder: Path) -> list[Path]:
    """A cover sheet, a title over the header, real dates."""
    stamps = pd.Timestamp("2024-03-09 10:00:00") + pd.to_timedelta(table.time, unit="s")
    path = folder / "book.xlsx"
    with pd.ExcelWriter(path, engine="openpyxl") as book:
        pd.DataFrame({"Project": ["M1"]}).to_excel(book, sheet_name="cover", index=False)
        headed(table).assign(time=stamps).to_excel(book, sheet_name="data", index=False, startrow=2)
    return [path]


def as_tdms(table: pd.DataFrame, folder: Path) -> list[Path]:
    from nptdms import ChannelObject, TdmsWriter

    path = folder / "log.tdms"
    with TdmsWriter(path) as file:
        for name, unit in UNITS.items():
            wave = {"wf_increment": STEP_S, "wf_start_offset": 0.0, "unit_string": unit}
            file.write_segment([ChannelObject("Log", name, table[name].to_numpy(), properties=wave)])
    return [path]


def as_mf4(table: pd.DataFrame, folder: Path) -> list[Path]:
    from asammdf import MDF, Signal

    path, t = folder / "log.mf4", table.time.to_numpy()
    with MDF(version="4.10") as file:
        file.append([Signal(table[name].to_numpy(), t, name=name, unit=unit) for name, unit in UNITS.items()])
        file.save(path)
    return [path]


def as_parquet(table: pd.DataFrame, folder: Path) -> list[Path]:
    path = folder / "log.parquet"
    headed(table).to_parquet(path)
    return [path]


def as_recorders(table: pd.DataFrame, folder: Path) -> list[Path]:
    """Three instruments, started one after the other, each with seconds of its own."""
    paths = []
    parts = {
        "power": ["current", "speed", "torque"],
        "logger": ["T_winding", "T_core", "T_housing"],
        "second": ["T_bearing", "T_air"],
    }
    for late, (name, columns) in zip((0, 73, 140), parts.items(), strict=True):
        own = headed(table[["time", *columns]].iloc[late:])
        paths.append(folder / f"{name}.csv")
        own.assign(time=own.time - own.time.iloc[0]).to_csv(paths[-1], index=False)
    return paths


FORMATS: dict[str, Writer] = {
    "text: preamble, decimal comma, m:ss,f": as_german,
    "text: dates with a zone, UTF-16": as_zoned,
    "text: date and clock in two columns": as_clock,
    "xlsx": as_xlsx,
    "TDMS": as_tdms,
    "MF4": as_mf4,
    "Parquet": as_parquet,
    "three recorders, no common clock": as_recorders,
}


@dataclass(frozen=True)
class Trial:
    """files : what `new` is given;  options : its options;  cold : no compiled kernel, no mesh of earlier runs"""

    name: str
    files: Sequence[Path]
    options: Sequence[str] = ()
    cold: bool = False


def trials(folder: Path, machine: bool) -> list[Trial]:
    table = bench_hour()
    published = {
        name: [p for n in names for p in case.glob(f"tests/{n}.csv*")]
        for name, case, names in (
            ("HUST", HUST, ("id_0", "id_1", "id_5")),
            ("TCLab", TCLAB, ("steps", "random-1", "random-2")),
        )
    }
    hust = ("--network", str(HUST / "network.toml"), "--period", "1")
    board = ("--network", str(TCLAB / "network.toml"), "--set", "ambient=20.4")
    exports = [Trial(name, write(table, folder)) for name, write in FORMATS.items()]
    first = Trial("HUST, the first command on a computer", published["HUST"], hust, cold=True)
    out = [first, Trial("HUST", published["HUST"], hust), Trial("TCLab", published["TCLab"], board), *exports]
    stand = [ROOT / "cases" / "road-test" / "tests" / "stand-1.csv"]
    return [
        *out,
        *([Trial("a machine never meshed", stand, ("--machine", "series-dc-100kw"), True)] if machine else []),
    ]


def run(trial: Trial, out: Path) -> dict[str, float | str]:
    """CPU and wall time (s) of `new` and `compare`."""
    empty = {"NUMBA_CACHE_DIR": f"{out}-kernel", "THERMOSCOPE_CACHE": f"{out}-cache"} if trial.cold else {}
    env = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "80", **empty}
    before, begun = cpu(), time.monotonic()
    for words in (
        ["test", "new", *map(str, trial.files), *trial.options, "--yes", "--out", str(out)],
        ["test", "compare", str(out)],
    ):
        done = subprocess.run([sys.executable, "-m", "thermoscope", *words], env=env, text=True, capture_output=True)
        if done.returncode > 1:
            raise SystemExit(f"{trial.name}: {done.stderr}")
    answer = " ".join(done.stdout.splitlines()[:2])
    return {"cpu": cpu() - before, "wall": time.monotonic() - begun, "answer": answer}


def cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    parser = benchmark_parser(__doc__)
    parser.add_argument("--only", nargs="*", help="rows by name")
    parser.add_argument("--machine", action="store_true", help="also a machine that was never meshed")
    options = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for i, trial in enumerate(trials(Path(folder), options.machine)):
            if options.only and trial.name not in options.only:
                continue
            took = run(trial, Path(folder) / f"case-{i}")
            print(f"| {trial.name} | {took['cpu']:.1f} s | {took['wall']:.1f} s |", flush=True)
            print(f"    {took['answer']}", file=sys.stderr)
            rows += [
                measured_row(trial.name, f"first comparison, {clock}", "s", float(took[clock]), WISHED_S, "wished")
                for clock in ("cpu", "wall")
            ]
    write_rows(options.json, "first_comparison", rows)


if __name__ == "__main__":
    main()
