"""Recordings as people have them (.csv, .xlsx, .tdms, .mf4, .parquet) into one table.

Channels of several rates share one time column and are empty where they were not sampled.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geom.errors import InputError, MissingDependency
from geom.plugins import plugins
from lumped.schemas.reader import suggestion
from thermoscope.recordings.csv_file import NumberTable, read_csv

if TYPE_CHECKING:
    import pandas as pd

Array = NDArray[np.float64]
Reader = Callable[[Path], "pd.DataFrame"]
READERS: Mapping[str, Reader] = plugins("formats")  # of other packages: name without its dot -> reader
SUFFIXES = (".csv", ".csv.gz", ".xlsx", ".tdms", ".mf4", ".parquet", *(f".{name}" for name in READERS))
TIME = "time_s"  # of formats that carry their own time
SHEETS = (".xlsx", ".tdms")  # formats of several tables
HEADER = 2  # line of the first row of numbers
GRAIN = 1e-6  # s, below which two instants are one
Signal = tuple[str, Array, Array]


def recording(path: Path) -> Path:
    """The file itself, or the one file of the same name in another format; two of them are one too many."""
    if path.is_file():
        return path
    if path.exists():
        raise InputError("is no file", str(path), "a recording")
    here = sorted(path.parent.iterdir()) if path.parent.is_dir() else []
    stem = stem_of(path)
    twins = [p for p in here if _suffix(p) and p.name[: len(stem)] == stem and stem_of(p) == stem]
    for twin in twins:
        if not twin.is_file():
            what = "is a link that leads nowhere" if not twin.exists() else "is no file"
            raise InputError(what, str(twin), "a recording")
    if len(twins) > 1:
        names = " and ".join(twin.name for twin in twins)
        raise InputError(f"{names} are both there", str(path), f'one of them, or file = "tests/{twins[0].name}"')
    if twins:
        return twins[0]
    beside = [p.name for p in here if _suffix(p) or (p.stem == stem and p.suffix != ".toml")]
    named = path if _suffix(path) else path.with_name(f"{path.name}.csv")
    raise InputError(
        "no such file",
        str(named),
        f"one of {', '.join(SUFFIXES)}; found there: {', '.join(beside) or 'no recording at all'}",
    )


def _suffix(path: Path) -> str:
    """The ending that says the format, the longest that fits; "" for none of those that are read."""
    return max((s for s in SUFFIXES if path.name.lower().endswith(s)), key=len, default="")


def stem_of(path: Path) -> str:
    """The name of a recording without the ending that says its format."""
    return path.name[: len(path.name) - len(_suffix(path))]


def read_frame(file: Path, worksheet: str = "", least: int = 3) -> pd.DataFrame:
    """The table of a recording, column names stripped. worksheet : of a workbook; of a TDMS file, the group.

    least : rows without which it is none
    """
    suffix = _suffix(file)
    readers: dict[str, Callable[[], pd.DataFrame]] = {
        ".csv": lambda: read_csv(file), ".csv.gz": lambda: read_csv(file), ".xlsx": lambda: _xlsx(file, worksheet),
        ".tdms": lambda: _tdms(file, worksheet), ".mf4": lambda: _mf4(file), ".parquet": lambda: _parquet(file),
    }  # fmt: skip
    for name, read in READERS.items():
        readers[f".{name}"] = partial(guarded, file, f"a .{name} file", name, partial(read, file))
    if suffix not in readers:
        raise InputError(f"files ending in '{file.suffix}' are not read", str(file), f"one of {', '.join(SUFFIXES)}")
    if worksheet and suffix not in SHEETS:
        raise InputError(f"'{worksheet}' is asked for, and such a file has no worksheets", str(file),
                         f"no worksheet, or a file ending in {' or '.join(SHEETS)}")  # fmt: skip
    table = readers[suffix]()
    table.columns = [str(c).strip() for c in table.columns]
    twice = [name for name, count in Counter(table.columns).items() if count > 1]
    if twice:
        raise InputError(f"column '{twice[0]}' stands twice in the header", str(file), "a name of its own for each")
    if len(table) < least:
        raise InputError(f"the file holds {len(table)} rows", str(file), f"at least {least} rows under the header")
    return table


def guarded(file: Path, kind: str, package: str, read: Callable[[], Any]) -> Any:
    """What a reader returns; whatever it trips over becomes one message."""
    try:
        return read()
    except ImportError:
        missing = f"{file}: reading {kind} needs the package {package}; pip install 'thermoscope[bench]'"
        raise MissingDependency(missing) from None
    except InputError:
        raise
    except Exception as fault:
        first = str(fault).splitlines()[0] if str(fault) else type(fault).__name__
        raise InputError(f"not readable as {kind}: {first}", str(file), f"a file that is really {kind}") from None


def _xlsx(file: Path, worksheet: str) -> pd.DataFrame:
    import pandas as pd

    def read() -> pd.DataFrame:
        with pd.ExcelFile(file, engine="openpyxl") as book:
            if worksheet and worksheet not in book.sheet_names:
                right = suggestion(worksheet, [str(n) for n in book.sheet_names])
                raise InputError(f"no worksheet '{worksheet}'", str(file), right)
            return book.parse(worksheet or 0)

    return guarded(file, "an Excel workbook", "openpyxl", read)


def _parquet(file: Path) -> pd.DataFrame:
    import pandas as pd

    table: pd.DataFrame = guarded(file, "Parquet", "pyarrow", lambda: pd.read_parquet(file))
    return table.reset_index() if table.index.name else table


def _tdms(file: Path, group: str) -> pd.DataFrame:
    def read() -> pd.DataFrame:
        from nptdms import TdmsFile

        with TdmsFile.read(file) as tdms:
            groups = [g for g in tdms.groups() if not group or g.name == group]
            if not groups and group:
                raise InputError(f"no group '{group}'", str(file), suggestion(group, [g.name for g in tdms.groups()]))
            if not groups:
                raise InputError("holds no channels", str(file), "a TDMS file with readings")
            channels = [(g.name, c) for g in groups for c in g.channels() if len(c)]
            names = [c.name for _, c in channels]
            return joined(
                (c.name if names.count(c.name) == 1 else f"{g}/{c.name}", *_tdms_signal(c)) for g, c in channels
            )

    return guarded(file, "TDMS", "nptdms", read)


def _tdms_signal(signal: Any) -> tuple[Array, Array]:
    """Times (s) by the waveform's increment where it has one, else by rows."""
    values = np.asarray(signal[:])
    step, offset = signal.properties.get("wf_increment"), signal.properties.get("wf_start_offset", 0.0)
    time = np.arange(len(values), dtype=float)
    return (offset + step * time if step else time), values


def _mf4(file: Path) -> pd.DataFrame:
    def read() -> pd.DataFrame:
        from asammdf import MDF

        with MDF(file) as mdf:
            signals = [s for s in mdf.iter_channels(skip_master=True) if len(s.samples) and s.samples.ndim == 1]
            return joined((s.name, np.asarray(s.timestamps, float), np.asarray(s.samples)) for s in signals)

    return guarded(file, "MF4", "asammdf", read)


def joined(signals: Iterable[Signal]) -> pd.DataFrame:
    """Signals (name, time, values) of any rates on all their instants, with a column `time_s`."""
    import pandas as pd

    whole = list(signals)
    instants = np.unique(np.round(np.concatenate([t for _, t, _ in whole]) / GRAIN)) if whole else np.zeros(0)
    columns: dict[str, Any] = {TIME: instants * GRAIN}
    for name, time, values in whole:
        at = np.searchsorted(instants, np.round(time / GRAIN))
        if np.issubdtype(values.dtype, np.number):
            column = np.full(instants.size, np.nan)
            column[at] = values
            columns[name if name not in columns else f"{name} (recorded)"] = column
    return pd.DataFrame(columns)


def merged(
    frame: pd.DataFrame, time: str, others: Mapping[str, tuple[pd.DataFrame, str, float]], where: str
) -> pd.DataFrame:
    """The main table with those of other recorders beside it, on all instants (in the main clock).

    others : recorder -> (table, its time column, seconds to add to its clock); columns that exist already are refused
    """
    import pandas as pd

    out = frame
    for name, (table, own, shift) in others.items():
        moved = table.rename(columns={own: time}).assign(**{time: table[own].to_numpy(float) + shift})
        twice = [c for c in moved.columns if c in out.columns and c != time]
        if twice:
            raise InputError(
                f"column '{twice[0]}' is recorded twice", f"{where} [recorders.{name}]", "columns of other names"
            )
        out = pd.merge(out, moved, on=time, how="outer", sort=True)
    return out


def numbers(table: pd.DataFrame | NumberTable, name: str, file: Path) -> Array:
    """A column as numbers, NaN where nothing was read; InputError with the line of what is no finite number."""
    column = table[name]
    values = column if isinstance(column, np.ndarray) else _numbers(column, name, file)
    endless = np.flatnonzero(np.isinf(values))
    if endless.size:
        raise InputError("the value is infinite", cell(file, name, int(endless[0])), "a finite number")
    return values


def _numbers(column: pd.Series[Any], name: str, file: Path) -> Array:
    """Of a column of any type."""
    import pandas as pd

    if column.dtype.kind in "mM":
        raise InputError("holds instants, no numbers", f"{file} column '{name}'", "numbers, or another column")
    values = np.array(pd.to_numeric(column, errors="coerce"), float)
    bad = np.flatnonzero(np.isnan(values) & column.notna().to_numpy())
    if bad.size:
        raise InputError(f"'{column.iloc[bad[0]]}' is no number", cell(file, name, int(bad[0])),
                         "a number with a decimal point, or nothing where nothing was read")  # fmt: skip
    return values


def cell(file: Path, column: str, row: int) -> str:
    """Where a reading stands."""
    return f"{file} column '{column}' line {row + HEADER}"


def pairs(table: pd.DataFrame, time: str, column: str, file: Path) -> Array:
    """(n, 2) times and readings of two columns, where both are given."""
    both = np.column_stack([numbers(table, time, file), numbers(table, column, file)])
    return np.asarray(both[np.isfinite(both).all(axis=1)])
