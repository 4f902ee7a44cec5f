"""Recordings as people have them (.csv, .xlsx, .tdms, .mf4, .parquet, .mat) into one table.

Channels of several rates share one time column and are empty where they were not sampled.
"""

import re
import struct
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.errors import InputError, MissingDependency
from geom.limits import BYTES, CELLS, PART_BYTES
from geom.plugins import plugins
from geom.recording_bounds import CHUNK, check_elements, check_shape, counted_rows, timed
from lumped.schemas.reader import suggestion
from measured.headers.rows import first_row_layout
from measured.headers.words import is_time
from measured.recordings.csv_file import HEAD, csv_pieces, in_rows, joined_parts
from measured.recordings.data_table import DataTable

Columns = Iterable[tuple[object, Any]]  # pairs of a name and its values
Reader = Callable[[Path], Mapping[str, Any]]  # name -> values; a pandas DataFrame is one too
READERS: Mapping[str, Reader] = plugins("formats")  # of other packages: name without its dot -> reader
PLAIN = (".csv", ".csv.gz")
PIECE = 2**16  # bytes of a CSV file of which no more than a piece is kept: about a thousand rows
SUFFIXES = (*PLAIN, ".xlsx", ".tdms", ".mf4", ".parquet", ".mat", *(f".{name}" for name in READERS))
TIME = "time_s"  # of formats that carry their own time
SHEETS = (".xlsx", ".tdms")  # formats of several tables
UNNAMED = re.compile(r"__index_level_\d+__")  # row numbers that pandas adds to a Parquet file
HEAD_BLOCK = 64  # byte at which the blocks of an MF4 file begin
CHAINS = {b"##HD": 5, b"##DG": 3, b"##CG": 2, b"##CN": 2, b"##DL": 1, b"##HL": 1, b"##LD": 1, b"##FH": 1, b"##AT": 1}
CHAINS |= {b"##EV": 1}  # kind of block -> of its links those that lead on: the first of others, or the next of its kind
GRAIN = 1e-6  # s, below which two instants are one
ABOUT = (("label", "name", "signal"), ("unit", "units"))  # of a signal, in structs of MATLAB
Signal = tuple[str, Array, Array]
Contents = tuple[Columns, dict[str, Any]]  # and what else the file says of them, see DataTable
BOOK = "an Excel workbook"
BOOKS_READ: ContextVar[dict[Path, dict[str, list[list[Any]]]] | None] = ContextVar("books read so far", default=None)
EPOCH = np.datetime64(0, "s")  # 1970
UNITS = ("unit_string", "unit", "Unit", "Units")  # properties of a channel
TIMELESS = "no channel says how far its rows are apart; without one of times rows are taken as 1 s apart"


def recording(path: Path) -> Path:
    """The file itself, or the one file of the same name in another format; two of them are one too many."""
    if path.is_file():
        return path
    if path.exists():
        raise InputError("is not a file", str(path), "a recording")
    here = sorted(path.parent.iterdir()) if path.parent.is_dir() else []
    stem = stem_of(path)
    twins = [p for p in here if _suffix(p) and p.name[: len(stem)] == stem and stem_of(p) == stem]
    for twin in twins:
        if not twin.is_file():
            what = "is a link that leads nowhere" if not twin.exists() else "is not a file"
            raise InputError(what, str(twin), "a recording")
    if len(twins) > 1:
        names = " and ".join(twin.name for twin in twins)
        raise InputError(f"{names} are both there", str(path), f'one of them, or file = "tests/{twins[0].name}"')
    if twins:
        return twins[0]
    beside = [p.name for p in here if _suffix(p) or (p.stem == stem and p.suffix != ".toml")]
    file = path if _suffix(path) else path.with_name(f"{path.name}.csv")
    raise InputError(
        "no such file",
        str(file),
        f"one of {', '.join(SUFFIXES)}; found there: {', '.join(beside) or 'no recording at all'}",
    )


def _suffix(path: Path) -> str:
    """The ending that says the format, the longest that fits; "" for none of those that are read."""
    return max((s for s in SUFFIXES if path.name.lower().endswith(s)), key=len, default="")


def stem_of(path: Path) -> str:
    """The name of a recording without the ending that says its format."""
    return path.name[: len(path.name) - len(_suffix(path))]


def read_recording(file: Path, worksheet: str = "", least: int = 3) -> DataTable:
    """The table of a recording. worksheet : of a workbook; of a TDMS file, the group.

    least : rows without which it is none
    """
    suffix = _suffix(file)
    readers: dict[str, Callable[[], DataTable]] = {
        ".csv": lambda: read_csv(file),
        ".csv.gz": lambda: read_csv(file),
        ".xlsx": lambda: _table(file, BOOK, "openpyxl", lambda: _xlsx(file, worksheet)),
        ".tdms": lambda: _table(file, "TDMS", "nptdms", lambda: _tdms(file, worksheet)),
        ".mf4": lambda: _table(file, "MF4", "asammdf", lambda: _mf4(file)),
        ".parquet": lambda: _table(file, "Parquet", "pyarrow", lambda: _parquet(file)),
        ".mat": lambda: _table(file, "a MATLAB file", "scipy", lambda: _mat(file)),
        **{
            f".{n}": partial(_table, file, f"a .{n} file", n, lambda read=read: (read(file).items(), {}))  # type: ignore[misc]
            for n, read in READERS.items()
        },
    }
    if suffix not in readers:
        raise InputError(f"files ending in '{file.suffix}' are not read", str(file), f"one of {', '.join(SUFFIXES)}")
    if worksheet and suffix not in SHEETS:
        raise InputError(
            f"'{worksheet}' is asked for, and such a file has no worksheets",
            str(file),
            f"no worksheet, or a file ending in {' or '.join(SHEETS)}",
        )
    table = readers[suffix]()
    if table.rows < least:
        raise InputError(f"the file holds {table.rows} rows", str(file), f"at least {least} rows under the header")
    return table


def read_csv(file: Path) -> DataTable:
    """The table of a CSV file under its own header."""
    plan, line, parts = csv_pieces(file, first_row_layout)
    rest = [[*part] for part in parts]
    pairs = ((name, joined_parts([part.pop(0) for part in rest])) for name in plan.names)
    return DataTable.of(pairs, file, line=line, units=plan.units_by_name)


def recording_pieces(file: Path, most: int, worksheet: str = "") -> Iterator[DataTable]:
    """A recording, at most so many rows at once: of a CSV file no more is in memory. What has another ending is one."""
    if _suffix(file) not in ("", *PLAIN):
        yield from read_recording(file, worksheet, 0).cut(most)
        return
    plan, line, pieces = csv_pieces(file, first_row_layout, PIECE)
    for i, columns in enumerate(in_rows(pieces, most)):
        yield DataTable.of(zip(plan.names, columns, strict=True), file, line=line + i * most)


def _table(file: Path, kind: str, package: str, read: Callable[[], Contents]) -> DataTable:
    # InputError where the file itself has more bytes than a recording may have
    BYTES.check(file.stat().st_size, file, "holds")

    def table() -> DataTable:
        columns, about = read()
        return DataTable.of(columns, file, **about)

    read_whole: DataTable = guarded(file, kind, package, table)
    return read_whole


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


def _xlsx(file: Path, worksheet: str) -> Contents:
    rows = workbook_rows(file, worksheet) or [[]]
    plan = first_row_layout(rows[:HEAD], str(file))
    names = [name or f"column {j + 1}" for j, name in enumerate(plan.names)]
    columns = zip(*rows[plan.first :], strict=True) if rows[plan.first :] else [()] * len(names)
    return zip(names, columns, strict=True), {"line": plan.first + 1, "units": plan.units_by_name}


def worksheets(file: Path) -> dict[str, list[list[Any]]]:
    """Name -> rows of every worksheet that has any."""
    books = BOOKS_READ.get()
    if books is not None and file in books:
        return dict(books[file])
    with _workbook(file) as book:
        sheets = {sheet.title: rows for sheet in book.worksheets if (rows := _rows(sheet, file))}
    if books is not None:
        books[file] = sheets
    return dict(sheets)


@contextmanager
def each_book_once() -> Iterator[None]:
    """A workbook that is read again in here is not opened again."""
    token = BOOKS_READ.set({})
    try:
        yield
    finally:
        BOOKS_READ.reset(token)


def workbook_rows(file: Path, worksheet: str) -> list[list[Any]]:
    """Rows of a worksheet: of the first where its name is ""."""
    if BOOKS_READ.get() is not None and worksheet in (rows_of := {"": [], **worksheets(file)}):
        return rows_of[worksheet or next((name for name in rows_of if name), "")]
    with _workbook(file) as book:
        sheets = {sheet.title: sheet for sheet in book.worksheets}
        if worksheet and worksheet not in sheets:
            raise InputError(f"no worksheet '{worksheet}'", str(file), suggestion(worksheet, sheets))
        return _rows(sheets[worksheet or next(iter(sheets))], file)


class Archive(zipfile.ZipFile):
    """A workbook, packed: every part is counted before a reader keeps what grows with it."""

    def __init__(self, file: Path) -> None:
        super().__init__(file)
        # InputError where a workbook, unpacked, has more bytes than a recording may have
        BYTES.check(sum(entry.file_size for entry in self.infolist()), file, "holds")

    def read(self, name: Any, pwd: bytes | None = None) -> bytes:
        """A part that is kept whole, such as the styles of cells."""
        PART_BYTES.check(self.getinfo(name).file_size, f"{self.filename} part '{name}'", "holds")
        return super().read(name, pwd)

    def open(self, *words: Any, **more: Any) -> Any:
        """A part that was counted."""
        with super().open(*words, **more) as part:
            check_elements(iter(partial(part.read, PIECE), b""), f"{self.filename} part '{part.name}'")
        return super().open(*words, **more)


@contextmanager
def _workbook(file: Path) -> Iterator[Any]:
    """A workbook's values, not its formulas."""
    from openpyxl.reader.excel import ExcelReader
    from openpyxl.worksheet._read_only import ReadOnlyWorksheet

    class Cells(ReadOnlyWorksheet):
        """Rows as they come: a file's claims would be filled up with cells, and without claims it is parsed twice."""

        _get_size = ReadOnlyWorksheet.reset_dimensions

    class Reader(ExcelReader):
        """Sheets of cells alone: openpyxl trips over a chart sheet that draws nothing."""

        read_properties = read_custom = read_theme = lambda self: None

        def read_worksheets(self) -> None:
            parts = {rel.target: sheet for sheet, rel in self.parser.find_sheets() if "chartsheet" not in rel.Type}
            sheets = {part: sheet.name for part, sheet in parts.items() if part in self.valid_files}
            self.wb._sheets += [Cells(self.wb, name, part, self.shared_strings) for part, name in sheets.items()]

    reader = Reader(file, read_only=True, data_only=True, keep_links=False)
    reader.archive.close()
    reader.archive = Archive(file)
    reader.read()
    book = reader.wb
    try:
        if not book.worksheets:
            raise InputError("holds charts alone", str(file), "a workbook with a sheet of cells")
        yield book
    finally:
        book.close()


def _rows(sheet: Any, file: Path) -> list[list[Any]]:
    """Cells row by row, as wide as the widest row; None for empty cells and for errors such as #DIV/0!."""
    from openpyxl.cell.cell import ERROR_CODES

    where = f"{file} worksheet '{sheet.title}'"
    every = counted_rows(sheet.iter_rows(values_only=True), where)
    rows = [[None if c in ERROR_CODES or c == "" else c for c in row] for row in every]
    width = max((j + 1 for row in rows for j, c in enumerate(row) if c is not None), default=0)
    while rows and all(c is None for c in rows[-1]):
        rows.pop()
    check_shape(len(rows), width, where)
    return [[*row, *[None] * width][:width] for row in rows]


def _parquet(file: Path) -> Contents:
    import pyarrow
    from pyarrow.parquet import ParquetFile

    with ParquetFile(file) as parquet:
        about = parquet.metadata
        check_shape(about.num_rows, about.num_columns, file)
        BYTES.check(sum(about.row_group(i).total_byte_size for i in range(about.num_row_groups)), file, "holds")
        table = pyarrow.Table.from_batches(timed(parquet.iter_batches(), file), parquet.schema_arrow)
    columns = [(n, c.to_numpy(zero_copy_only=False)) for n, c in zip(table.column_names, table.columns, strict=True)]
    index = {n: "time" for n, c in columns if UNNAMED.fullmatch(n) and c.dtype.kind == "M"}  # instants without a name
    return [(index.get(n, n), c) for n, c in columns if n in index or not UNNAMED.fullmatch(n)], {}


def matlab_variables(file: Path) -> dict[str, Any]:
    """All that a MATLAB file holds, by name; InputError for a version or a size that is not read."""
    from scipy.io import loadmat

    with file.open("rb") as stream:
        start = stream.read(128)
    if start.startswith(b"MATLAB 7.3"):
        raise InputError("is a MATLAB file of version 7.3", str(file), "save(..., '-v7'), or the table saved as CSV")
    if start.startswith(b"MATLAB 5.0"):  # older ones are not packed
        BYTES.check(sum(timed(_unpacked(file, "<II" if start.endswith(b"IM") else ">II"), file)), file, "holds")
    return dict(loadmat(file, simplify_cells=True))


def _mat(file: Path) -> Contents:
    """Vectors of a MATLAB file, alone or in structs, and columns of its matrices; those of the commonest length."""
    variables = matlab_variables(file)
    paths = dict(_vectors(variables))
    sizes = Counter(len(v) for v in paths.values() if len(v) > 2)
    if not sizes:
        right = "columns of numbers; the table saved as CSV"
        raise InputError("holds no columns of numbers", str(file), right)
    rows = sizes.most_common(1)[0][0]
    other = [".".join(path) for path, v in paths.items() if len(v) not in (rows, 0, 1)]
    columns = {path: v for path, v in paths.items() if len(v) == rows}
    check_shape(rows, len(columns), file)
    last = Counter(path[-1] for path in columns)
    names = [path[-1] if last[path[-1]] == 1 else ".".join(path) for path in columns]
    texts = dict(_texts(variables))
    units = {name: text for name, path in zip(names, columns, strict=True) if (text := texts.get(path[-1]))}
    return zip(names, columns.values(), strict=True), {
        "units": units,
        "notes": (f"{file.name}: left out for their length: {', '.join(other[:9])}",) * bool(other),
    }


def _texts(one: Any, name: str = "") -> Iterator[tuple[str, str]]:
    """Words by their names, as in a struct of units beside that of the readings."""
    if isinstance(one, Mapping):
        for key, inside in one.items():
            yield from _texts(inside, str(key))
    elif isinstance(one, str) and one.strip():
        yield name, one.strip()


def _unpacked(file: Path, head: str) -> Iterator[int]:
    """Bytes of each piece of a MATLAB file as it is unpacked."""
    with file.open("rb") as source:
        source.seek(128)
        while len(about := source.read(8)) == 8:
            kind, size = struct.unpack(head, about)
            if kind != 15:
                source.seek(size, 1)
                continue
            unpacker, rest = zlib.decompressobj(), source.read(size)
            while rest and (part := unpacker.decompress(rest, CHUNK)):
                yield len(part)
                rest = unpacker.unconsumed_tail


def _vectors(one: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Array]]:
    """Numbers of one dimension by the names that lead to them; a signal whose struct has its name and unit by these."""
    if isinstance(one, Mapping):
        about = {str(key).lower(): inside for key, inside in one.items()}
        label, unit = (next((w for k in keys if isinstance(w := about.get(k), str) and w), "") for keys in ABOUT)
        if (key := next((k for k in ("values", "data", "value") if k in about), "")) and (label or unit):
            name = label or (path or ("column",))[-1]
            yield from _vectors(about.get("time"), (*path, "time"))
            yield from _vectors(about[key], (*path[:-1], f"{name} [{unit}]" if unit else name))
            return
        lists = [[*v] for v in one.values() if isinstance(v, list | np.ndarray) and all(isinstance(w, str) for w in v)]
        for name, inside in one.items():
            columns = next((v for v in lists if np.ndim(inside) == 2 and len(v) == np.shape(inside)[1]), None)
            if columns:  # names beside a matrix
                yield from _vectors(dict(zip(columns, np.asarray(inside).T, strict=True)), path)
            elif not str(name).startswith("__"):
                yield from _vectors(inside, (*path, str(name)))
    elif isinstance(one, np.ndarray) and one.dtype.kind in "fiub":
        for j, column in enumerate(one.T if one.ndim == 2 else [one][: one.ndim == 1], 1):
            yield (path if one.ndim == 1 else (*path[:-1], f"{path[-1]} {j}")), np.asarray(column, float)
    elif isinstance(one, list | np.ndarray) and np.ndim(one) == 1:
        for j, inside in enumerate(one, 1):
            yield from _vectors(inside, (*path, str(j)))


def _tdms(file: Path, group: str) -> Contents:
    """Units and the start of the clock are properties of the channels."""
    from nptdms import TdmsFile
    from nptdms.log import log_manager

    log_manager.set_level("ERROR")  # what it finds odd is a fault here, or nothing
    with TdmsFile.read_metadata(file) as about:
        sizes = [len(channel) for g in about.groups() for channel in g.channels()]
        check_shape(max(sizes, default=0), len(sizes), file)
    with TdmsFile.read(file) as tdms:
        groups = [g for g in tdms.groups() if not group or g.name == group]
        channels = [(g.name, c) for g in groups for c in g.channels()]
        if not groups and group:
            raise InputError(f"no group '{group}'", str(file), suggestion(group, [g.name for g in tdms.groups()]))
        if not groups:
            raise InputError("holds no channels", str(file), "a TDMS file with readings")
        for _, channel in channels:
            if (step := channel.properties.get("wf_increment", 0.0)) < 0:
                raise InputError(
                    f"its wf_increment is {step:g} s",
                    f"{file} channel '{channel.name}'",
                    "a time from row to row above 0",
                )
        names = Counter(c.name for _, c in channels if len(c))
        by_name = [(c.name if names[c.name] == 1 else f"{g}/{c.name}", c) for g, c in channels if len(c)]
        columns = joined((name, *_tdms_signal(c)) for name, c in timed(by_name, file))
        starts = [c.properties["wf_start_time"] for _, c in channels if "wf_start_time" in c.properties]
        timeless = not any("wf_increment" in c.properties or is_time(c.name) for _, c in channels)
        return columns, {
            "units": {name: str(next(filter(None, map(c.properties.get, UNITS)), "")) for name, c in by_name},
            "remarks": {name: str(c.properties.get("description", "")) for name, c in by_name},
            "start": _since_1970(starts[0]) if starts else None,
            "notes": (f"{file.name}: {TIMELESS}",) * timeless,
        }


def _tdms_signal(signal: Any) -> tuple[Array, Array]:
    """Times (s) by the waveform's increment where it has one, else by rows."""
    values = np.asarray(signal[:])
    step, offset = signal.properties.get("wf_increment"), signal.properties.get("wf_start_offset", 0.0)
    time = np.arange(len(values), dtype=float)
    return (offset + step * time if step else time), values


def _mf4(file: Path) -> Contents:
    """A group whose rows are not all there is refused: they would be read as zeros."""
    from asammdf import MDF

    check_chains(file)
    with MDF(file) as mdf:
        for group in mdf.groups:
            about = group.channel_group
            check_shape(about.cycles_nr, len(group.channels), file)
            width = about.samples_byte_nr + getattr(about, "invalidation_bytes_nr", 0)
            there = sum(block.original_size or 0 for block in group.get_data_blocks())
            BYTES.check(there, file, "holds")
            if width * about.cycles_nr > there:
                what = f"a group claims {about.cycles_nr:,} rows and holds {there // width:,}"
                raise InputError(what, str(file), "a file that was closed by its recorder: save it again")
        signals = [
            (s.name, np.asarray(s.timestamps, float), np.asarray(s.samples))
            for s in timed(mdf.iter_channels(skip_master=True), file)
            if len(s.samples) > 0 and s.samples.ndim == 1
        ]
        units = {c.name: c.unit or "" for g in mdf.groups for c in g.channels}
        remarks = {c.name: c.comment or "" for g in mdf.groups for c in g.channels}
        return joined(signals), {"units": units, "remarks": remarks, "start": _since_1970(mdf.start_time)}


def check_chains(file: Path) -> None:
    """InputError where blocks of an MF4 file follow each other in a circle: its reader would never come to an end."""
    with file.open("rb") as source:
        visits, rest = set[int](), [HEAD_BLOCK] if source.read(12)[:10] == b"MDF     4." else []
        while rest:
            source.seek(address := rest.pop())
            block = source.read(24)[:4]
            if followed := CHAINS.get(block, 0):
                if address in visits:
                    what = f"block {block.decode()} at byte {address} comes twice: the file has no end"
                    raise InputError(what, str(file), "a file that was closed by its recorder: save it again")
                visits.add(address)
                rest += filter(
                    None, struct.unpack(f"<{followed}Q", source.read(8 * followed).ljust(8 * followed, b"\0"))
                )


def _since_1970(instant: Any) -> float | None:
    """Seconds, of a datetime or a NumPy instant; None for one that a recorder left out."""
    if isinstance(instant, datetime):
        stamp = (instant if instant.tzinfo else instant.replace(tzinfo=UTC)).timestamp()
    else:
        stamp = float((np.datetime64(instant) - EPOCH) / np.timedelta64(1, "s"))
    return stamp if np.isfinite(stamp) and stamp > 0 else None


def joined(signals: Iterable[Signal]) -> Columns:
    """Signals (name, time, values) of any rates on all their instants, with a column `time_s`."""
    whole = list(signals)
    instants = np.unique(np.round(np.concatenate([t for _, t, _ in whole]) / GRAIN)) if whole else np.zeros(0)
    CELLS.check(instants.size * (len(whole) + 1), "signals of several rates", "need")
    columns: dict[str, Array] = {TIME: instants * GRAIN}
    for name, time, values in whole:
        at = np.searchsorted(instants, np.round(time / GRAIN))
        if values.dtype.kind == "M":  # times of their own
            values = values.astype("datetime64[us]").astype(float) * 1e-6  # s since 1970
        if np.issubdtype(values.dtype, np.number):
            column = np.full(instants.size, np.nan)
            column[at] = values
            columns[name if name not in columns else f"{name} (recorded)"] = column
    return columns.items()
