"""A recording as its file has it: named columns of cells, their units, and where it came from."""

import itertools
import re
import zipfile
from collections import Counter
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from geom.arrays import Array
from geom.description.names import plain_header
from geom.description.roles import ROLE_WORDS, Role
from geom.errors import InputError
from measured.headers.cells import EMPTY, SWITCH, WITH_UNIT, is_clock, is_date, is_unit, number, split_unit, unit_of
from measured.headers.rows import NO_RECORD, UNIT_NAMES, Layout, called, layout, transposed, trimmed
from measured.headers.words import QUANTITY, RUNS, is_rise, is_time, quantities_of, roles_of, tokens, without_rise
from measured.importing.long_table import side_by_side
from measured.importing.text import DELIMITERS, decoded, split_cells, text_table
from measured.recordings.csv_file import CHUNK
from measured.recordings.data_table import PIECE, DataTable
from measured.recordings.formats import BOOK, READERS, TIME, guarded, read_recording, worksheets
from measured.recordings.units import MEMORY_UNIT, QUANTITIES, converted

LONGEST = max(map(len, EMPTY))  # letters of a way to write that nothing was read
TEXT = 0.2  # share of cells that are words from which a column holds no readings
BINARY = (".tdms", ".mf4", ".parquet", ".mat", *(f".{name}" for name in READERS))
MODELS = (".toml", ".step", ".stp", ".mot", ".dxf")
UNNAMED = re.compile(r"column \d+")
ONE_OF = re.compile(r"(?i)(?:phase|coil|spule|sensor|channel|kanal|strang|(?<![^\W\d_])[pc]h)$")  # before a letter
BRACKETED = re.compile(r"(.*?)\s*[\[(]([^\[\]()]*)[\])]")
SCALED = re.compile(
    r"(?:[x×*]\s*(?=0|1/|1e))?(1/(?=1))?(0[.,]0*1|1[eE]-\d|10+)\s*([^\d\s.,].*)"
)  # x0.1 °C, 1/10 °C, 10 mA
TENFOLD = re.compile(r"(.*[^\W_])[ _]\(?[x×*](10+)\)?")  # T_wdg_x10: a register of whole numbers
LEAST_PATHS = 3  # with groups in common
BOOKS = (".xlsx", ".xlsm")
HOURS = re.compile(r"(?:[01]?\d|2[0-4])\s*[hH]\s*[0-5]\d")  # 10h05, by hand in French
HALVES = re.compile(  # of a day, before the hour or behind the time
    r"(?:(오전|上午|午前)|오후|下午|午後)\s*(\d[\d:.]*)|(?<=\d)\s?(?:([öÖ]{2}|π\.?\s?μ\.?)|[öÖ][sS]|μ\.?\s?μ\.?)$"
)
YEAR = re.compile(r"^\s*['’](?=\d\d[-/.]\d\d[-/.]\d\d\b)")
POINTED = re.compile(r"(?:[01]?\d|2[0-3])\.[0-5]\d\.[0-5]\d")
TAG = re.compile(r"\s*<[^<>]*>|\\[^\\]*:\d+$")  # of a channel, no part of its name: 101 Winding <TC K>, tStator\ETKC:1
VALUED = re.compile(r"([-+]?\d+(?:[.,]\d+)?)\s*([^\d\s.,:;+/|()-][^\d\s/|()]*)")
CELL_LETTERS = 80  # of a cell with two readings; of a longer one looking for them takes as long as its square
SEVERAL = re.compile(rf"(?:{VALUED.pattern}(?:[\s/|(),;]+|$)){{2,}}")
UNCALCULATED = re.compile(rb"</f>\s*(?:<v\s*/>|<v></v>)?\s*</c>")


@dataclass(frozen=True)
class Source(DataTable):
    """A table with a number or a word in every cell, as its file has them, and what each column is called.

    labels : column -> its name without the unit;  units : also those that stand in the names
    unnamed : the file has no header;  period_s : between rows, by its preamble
    clock_of_each : rows of different signals have nothing in common, for each stands behind its own clock
    """

    file: Path = Path()
    labels: Mapping[str, str] = field(default_factory=dict)
    unnamed: bool = False
    period_s: float | None = None
    clock_of_each: bool = False
    values: dict[str, Array] = field(default_factory=dict, compare=False, repr=False)

    def numbers(self, column: str) -> Array:
        """(rows,) readings, nan where there is none or no number; on and off are 1 and 0."""
        if column not in self.values:
            self.values[column] = as_numbers(self.cells[column])
        return self.values[column]

    def finite(self, column: str) -> Array:
        """Its readings alone, row after row."""
        values = self.numbers(column)
        return values[np.isfinite(values)]

    def is_filled(self, column: str) -> bool:
        """Does it hold anything but ways to write that nothing was read?"""
        return _any(self.cells[column])

    def is_switch(self, column: str) -> bool:
        """Does it hold on and off, or true and false, in words?"""
        cells = self.cells[column]
        if isinstance(cells, np.ndarray) and cells.dtype.kind != "O":
            return cells.dtype.kind == "b"
        return all(_empty(c) or str(c).strip().lower() in SWITCH for c in set(cells))

    def is_numeric(self, column: str) -> bool:
        """Does it hold numbers, but for a few words such as "overload"?"""
        cells, finite = self.cells[column], np.isfinite(self.numbers(column))
        if finite.mean() >= 1 - TEXT or not finite.any() or (isinstance(cells, np.ndarray) and cells.dtype.kind == "f"):
            return bool(finite.any())
        words = sum(not _empty(c) for c in itertools.compress(cells, ~finite))
        return bool(words <= TEXT * (words + finite.sum()))


def _empty(cell: Any) -> bool:
    if cell is None or (isinstance(cell, float) and np.isnan(cell)):
        return True
    word = str(cell).strip()
    return len(word) <= LONGEST and word.lower() in EMPTY


def as_numbers(cells: Sequence[Any]) -> Array:
    """Numbers of cells, nan for all else; commas are points, switches 0 and 1."""
    if isinstance(cells, np.ndarray) and cells.dtype.kind in "fiub":
        return np.asarray(cells, float)
    if len(cells) > PIECE:
        return np.concatenate([as_numbers(cells[i : i + PIECE]) for i in range(0, len(cells), PIECE)])
    cells = [None if isinstance(cell, list | dict | np.ndarray) else cell for cell in cells]  # as Parquet may hold
    meaning = {cell: number(cell) for cell in set(cells)}
    meaning |= {c: SWITCH[word] for c in meaning if isinstance(c, str) and (word := c.strip().lower()) in SWITCH}
    return np.fromiter(map(meaning.__getitem__, cells), float, len(cells))


def read_source(file: Path) -> Source:
    """The longest of the tables of a file."""
    return max(read_sources(file), key=lambda source: source.rows)


def read_sources(file: Path) -> list[Source]:
    """Any file a recorder writes; of a workbook all sheets with the columns of the largest, or with its other signals.

    InputError where it is not a record, MissingDependency where a package is not there.
    """
    if file.is_dir():
        raise InputError("is a folder", str(file), f"the recordings in it, such as {file}/*.csv")
    if not file.is_file():
        raise InputError("no such file", str(file), "a recording")
    suffix = file.suffix.lower()
    if suffix in MODELS:
        raise InputError(
            "describes a machine or a model: it is not a record", str(file), "readings over time, such as a CSV"
        )
    if suffix in BOOKS:
        return _of_sheets(file)
    if suffix not in BINARY:
        return [source_of_table(file, *text_table(file))]
    return [source_of_recording(file, read_recording(file))]


def explained(sources: Sequence[Source], legend: Path) -> list[Source]:
    """With names and units of columns as a file of words beside them gives them, and a note."""
    lines = list[str]()
    with suppress(InputError):  # a picture
        lines = decoded(legend.read_bytes(), legend).splitlines(keepends=True)
    rows = split_cells(lines, max(DELIMITERS, key=lambda sign: sum(line.count(sign) for line in lines)))
    out = []
    for source in sources:
        pairs = zip(source.cells, called([*source.cells], rows), strict=True)
        split = {c: split_unit(name) for c, name in pairs if name != c}
        labels = {**source.labels, **{c: label for c, (label, _) in split.items()}}
        units = {**source.units, **{c: unit for c, (_, unit) in split.items() if unit}}
        note = f"{legend.name} {'says what columns are' if split else f'is left out: {NO_RECORD}'}"
        out.append(replace(source, labels=labels, units=units, notes=(*source.notes, note)))
    return out


def over_room(source: Source) -> Source:
    """With rises over the room as temperatures, and a note, where the room is the only temperature beside them."""
    units = {c: unit_of(text) for c, text in source.units.items() if source.is_numeric(c)}
    hot = [c for c in units if units[c] in ("K", "degC", "degF")]
    rises = {c: parts[0] for c in hot if is_rise(source.labels[c]) and len(parts := roles_of(source.labels[c])) == 1}
    rooms = [c for c in hot if c not in rises]
    if not rises or [(units[c], *roles_of(source.labels[c])[:1]) for c in rooms] != [("degC", Role.AMBIENT)]:
        return source
    if {units[c] for c in rises} - {"K", "degC"} or {Role.AMBIENT, Role.COOLANT} & {*rises.values()}:
        return source
    room = rooms[0]
    names = {c: f"{c} + {room}" if c in rises else c for c in source.cells}
    cells = {n: source.numbers(c) + source.numbers(room) if c in rises else source.cells[c] for c, n in names.items()}
    labels = {n: without_rise(source.labels[c]) if c in rises else source.labels[c] for c, n in names.items()}
    texts = {n: "degC" if c in rises else source.units[c] for c, n in names.items()}
    note = f"{source.file.name}: '{next(iter(rises))}' and the like are rises: '{room}' is added to them"
    return replace(source, cells=cells, labels=labels, units=texts, notes=(*source.notes, note), values={})


def with_ends(source: Source) -> Source:
    """With what came in and went out as the ends of the coolant, and a note: where its flow was recorded, or, of air,
    where the room was too."""
    words = {c: {w for w in tokens(label) if not w.isdigit()} for c, label in source.labels.items()}
    air = {c for c in words if words[c] & ROLE_WORDS[Role.AMBIENT]}
    hot = [c for c in words if words[c] & QUANTITY["temperature"] or unit_of(source.units[c]) == "degC"]
    ends = {c: words[c] - QUANTITY["temperature"] - ROLE_WORDS[Role.AMBIENT] for c in hot}
    ends = {c: end for c, end in ends.items() if end in ({"in"}, {"out"})}
    roles = [roles_of(label) for c, label in source.labels.items() if c not in ends]
    flows = any("water_flow" in quantities_of(label) for label in source.labels.values())
    beside = [Role.AMBIENT] in (of[:1] for of in roles) if ends.keys() <= air else flows and not ends.keys() & air
    if len(ends) != 2 or not beside or any(Role.COOLANT in of for of in roles) or not set.isdisjoint(*ends.values()):
        return source
    what = "the air that cools, beside a room" if ends.keys() <= air else "the flow beside them"
    note = f"{source.file.name}: {' and '.join(map(repr, ends))} are taken as those of {what}"
    labels = {**source.labels} | {c: f"coolant {''.join(end)}" for c, end in ends.items()}
    return replace(source, labels=labels, notes=(*source.notes, note))


def _of_sheets(file: Path) -> list[Source]:
    sheets = guarded(file, BOOK, "openpyxl", lambda: worksheets(file))
    for name, rows in sheets.items():
        sheets[name] = [*map(list, zip(*map(trimmed, rows), strict=False))] if transposed(rows) else rows
    largest = max(sheets, key=lambda name: len(sheets[name]) * len(sheets[name][0]), default="")
    plans = {largest: layout(sheets.get(largest, []), str(file))}
    for name in sheets.keys() - plans.keys():
        try:
            plans[name] = layout(sheets[name], str(file))
        except InputError:  # a page of words, which may say what columns are
            names = called([*plans[largest].names], sheets[name])
            plans[largest] = replace(plans[largest], names=tuple(names))
    signals = {name: _signals(name, plans[name], rows) for name, rows in sheets.items() if name in plans}
    signals = {name: labels for name, labels in signals.items() if labels}
    every = [label for labels in signals.values() for label in labels[1:]]
    joint = len(signals) > 1 and largest in signals and len({*every}) == len(every)
    alike = [*signals] if joint else [n for n in sheets if n in plans and plans[n].names == plans[largest].names]
    what = "the signals of the worksheets {} are one test" if joint else "a test from each of the worksheets {}"
    notes = [f"{file.name}: {what.format(', '.join(alike))}"] * (len(alike) > 1)
    notes += [f"{file.name}: worksheet '{name}' is left out" for name in sheets if name in plans.keys() - {*alike}]
    notes += _formulas(file)
    tables = {name: _cells(plans[name], sheets[name]) for name in alike}
    if not joint:
        return [source_of_table(file, plans[name], columns, notes) for name, columns in tables.items()]
    beside = [*zip(*itertools.zip_longest(*itertools.chain(*tables.values())), strict=True)]
    names = _once(_plain([label for labels in signals.values() for label in labels]))
    return [replace(_source(file, names, beside, {}, notes), clock_of_each=True)]


def _signals(sheet: str, plan: Layout, rows: Sequence[Sequence[Any]]) -> list[str]:
    """Names of the columns of a worksheet, none where no clock is the first or it is a run by its name; a single signal
    is called after its sheet, unless its header alone says what it is."""
    names, (at, *row) = [split_unit(name) for name in plan.names], rows[plan.first]
    numeric = any(number(cell) == number(cell) for cell in row)
    if RUNS & {*tokens(sheet)} or not numeric or not (is_time(names[0][0]) or is_date(at)):
        return []
    if len(names) == 2 and not roles_of(name := names[1][0]):
        by_sheet = roles_of(sheet) or quantities_of(sheet) or not (unit_of(name) or quantities_of(name))
        names[1] = (sheet if by_sheet else name, names[1][1] or unit_of(name))
    units = [text or unit for text, (_, unit) in zip(plan.units, names, strict=True)]
    return [f"{name} [{unit}]" if unit else name for (name, _), unit in zip(names, units, strict=True)]


def _cells(plan: Layout, rows: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """Columns of a worksheet."""
    body = [row for row in rows[plan.first :] if any(c is not None and str(c).strip() for c in row)]
    while body and not any(number(c) == number(c) or is_clock(c) for c in body[-1]):
        body.pop()  # remarks and signatures
    return [[row[j] if j < len(row) else None for row in body] for j in range(plan.width)]


def source_of_recording(file: Path, table: DataTable) -> Source:
    """Of a binary file, whose signals have names."""
    names = _once(_plain(table.columns))
    if any(column.dtype.kind in "OUT" for column in table.cells.values()):
        columns = [c.astype("M8[us]").tolist() if c.dtype.kind == "M" else c.tolist() for c in table.cells.values()]
        if (beside := side_by_side(names, columns, str(file)))[0]:
            return _source(file, [*beside[0]], [*beside[0].values()], {}, (*beside[1], *table.notes), table.start)
    units = {name: table.units.get(column, "") for name, column in zip(names, table.columns, strict=True)}
    source = _source(file, names, [*table.cells.values()], units, table.notes, table.start)
    remarks = {n: r for n, c in zip(names, table.columns, strict=True) if roles_of(r := table.remarks.get(c, ""))}
    labels = {n: remarks.get(n, label) if not roles_of(label) else label for n, label in source.labels.items()}
    return replace(source, labels=labels)


def _formulas(file: Path) -> list[str]:
    """A doubt where formulas have no value, as programs leave them that do not calculate."""
    with zipfile.ZipFile(file) as book:
        sheets = [
            inside for inside in book.namelist() if inside.startswith("xl/worksheets/") and inside.endswith(".xml")
        ]
        heads = [book.open(sheet).read(CHUNK) for sheet in sheets]  # of a huge sheet its beginning tells enough
    count = sum(len(UNCALCULATED.findall(head)) for head in heads)
    return [f"{file.name}: {count} formulas have no value; open and save it in a spreadsheet program"] * bool(count)


def source_of_table(
    file: Path, plan: Layout, columns: Sequence[Any], notes: Sequence[str], period_s: float | None = None
) -> Source:
    """Named columns of a table that was found in the file."""
    unnamed = not any(plan.names)
    names = _once(_plain(plan.names))
    beside, doubts = side_by_side(names, columns, str(file))
    if beside:
        unnamed &= not any(roles_of(name) or quantities_of(name) for name in beside)
        return replace(_source(file, [*beside], [*beside.values()], {}, [*doubts, *notes]), unnamed=unnamed)
    doubts = [f"{file.name}: no header; columns are called after their number"] * unnamed
    doubts += [f"{file.name}: {plan.preamble} lines before the header are left out"] * bool(plan.preamble)
    source = _source(file, names, columns, dict(zip(names, plan.units, strict=True)), [*doubts, *notes])
    return replace(source, unnamed=unnamed, period_s=period_s)


def _plain(names: Sequence[str]) -> list[str]:
    """Names of columns as a sheet may have them."""
    return [plain_header(name) or f"column {j + 1}" for j, name in enumerate(names)]


def _source(
    file: Path,
    names: Sequence[str],
    columns: Sequence[Any],
    units: Mapping[str, str],
    notes: Sequence[str],
    start: float | None = None,
) -> Source:
    every = [pair for one in zip(names, columns, strict=True) for pair in _with_several(*one).items()]
    pairs = [(name, _with_colons(cells)) for name, cells in every]
    cells: dict[str, Any] = {n: c for n, c in pairs if _any(c) or not UNNAMED.fullmatch(n)}
    if sum(map(_any, cells.values())) < 2:
        raise InputError("the file has one column only", str(file), "a time or an input, and at least one temperature")
    split = {n: split_unit(n) for n in cells}
    for n in cells:
        before, inside = m.groups() if (m := BRACKETED.fullmatch(n)) else (n, "")
        if (scaled := SCALED.fullmatch(units.get(n, "") or inside)) and is_unit(scaled[3]):
            factor = float(scaled[2].replace(",", ".")) ** (-1 if scaled[1] else 1)
            cells[n], split[n], units = as_numbers(cells[n]) * factor, (before, scaled[3]), {**units, n: ""}
            notes = [*notes, f"{file.name}: '{n}' is read in units of {factor:g} {scaled[3]}"]
    stems = Counter(label for label, unit in split.values() if unit)
    split = {n: (n, "") if _phase(n, *split[n], stems) else split[n] for n in cells}
    others = {n: {n.replace("[1]", f"[{i}]") for i in (0, 2)} - {n} for n in cells}
    split |= {n: (n, "") for n in cells if others[n] & cells.keys()}  # an index, no unit
    for n in cells:
        if (tenfold := TENFOLD.fullmatch(n)) and not units.get(n) and not (as_numbers(cells[n]) % 1 > 0).any():
            cells[n], split[n] = as_numbers(cells[n]) / float(tenfold[2]), split_unit(tenfold[1])
            notes = [*notes, f"{file.name}: '{n}' is read in units of {1 / float(tenfold[2]):g}"]
    texts = {n: _in_cells(cells[n]) for n in cells}
    for n in (n for n in cells if len(texts[n]) > 1):  # 999 W and 1.2 kW
        if quantity := next((q for q, one in QUANTITIES.items() if texts[n].keys() <= one.units.keys()), ""):
            scale = {c: converted(np.array(number(c)), quantity, unit) for unit, of in texts[n].items() for c in of}
            cells[n], texts[n] = [scale.get(c, c) for c in cells[n]], {MEMORY_UNIT[quantity]: []}
            notes = [*notes, f"{file.name}: units change within '{n}': it is read in {MEMORY_UNIT[quantity]}"]
    split = {n: (n, "") if texts[n] and unit_of(split[n][1]) not in texts[n] else split[n] for n in cells}
    unit_texts = {n: units.get(n, "") or split[n][1] or next(iter(texts[n]), "") for n in cells}
    for before, header in itertools.pairwise(cells):  # a column of units beside that of readings
        is_unit_column = header.lower().startswith(UNIT_NAMES) or header.lower().endswith(UNIT_NAMES)
        beside = {str(c).strip() for c in cells[header] if c is not None} if is_unit_column else set()
        words = [word for text in beside for word in (text, text.rpartition(" ")[2]) if is_unit(word)]  # "TEMP C"
        if len(beside) == 1 and words and not unit_texts[before]:
            unit_texts[before] = words[0]
    labels = {n: n if units.get(n, "") else split[n][0] or n for n in cells}
    labels = _without_groups(labels)
    labels = {n: name if re.search(r"[^\W\d]", name := TAG.sub("", label)) else label for n, label in labels.items()}
    return Source(cells, unit_texts, start, tuple(notes), file=file, labels=labels)


def _without_groups(labels: Mapping[str, str]) -> dict[str, str]:
    """Names of paths without the groups that all of them begin with, and the end that most of them share."""
    paths = {n: re.split("/+", label) for n, label in labels.items() if "/" in label}
    if len(paths) < LEAST_PATHS:
        return dict(labels)
    same = sum(1 for _ in itertools.takewhile(lambda level: len({*level}) == 1, zip(*paths.values(), strict=False)))
    last, count = Counter(path[-1] for path in paths.values()).most_common(1)[0]
    paths = {n: path[min(same, len(path) - 1) :] for n, path in paths.items()}
    others = [p[:-1] for p in paths.values() if p[-1] != last and len(p) > 1]
    channel = last[-1:].isdigit() and any([*group, last] in paths.values() for group in others)  # ai0, beside an ai1
    ending = last if count > len(paths) / 3 and not channel else ""
    return {**labels, **{n: "/".join(p[:-1] if p[-1] == ending and len(p) > 1 else p) for n, p in paths.items()}}


def _with_colons(cells: Sequence[Any]) -> Sequence[Any]:
    """Times of day that are written as 10h05, 오후 1:05, 1:05 ÖS, or as dates are, 09.14.05: a year that changes from
    row to row is a second. Years of two digits behind an apostrophe are whole."""
    if isinstance(cells, np.ndarray) or not all(isinstance(c, str) for c in cells):
        return cells
    if all(HALVES.search(c) or YEAR.search(c) for c in cells[:9]):
        return [
            YEAR.sub("20", HALVES.sub(lambda m: f"{m[2] or ''} {'AM' if m[1] or m[3] else 'PM'}", c.strip()))
            for c in cells
        ]
    if all(HOURS.fullmatch(c.strip()) for c in cells):
        return [re.sub(r"\s*[hH]\s*", ":", c.strip()) for c in cells]
    if not all(POINTED.fullmatch(c.strip()) for c in cells[:9]):
        return cells
    parts = [str(c).strip().split(".") for c in cells]
    of_day = len({second for *_, second in parts}) > 2 or any(middle > "31" for _, middle, _ in parts)
    return [":".join(one) for one in parts] if of_day else cells


def _with_several(name: str, cells: Sequence[Any]) -> dict[str, Sequence[Any]]:
    """A column for each of the readings that stand with their units in one cell: 23.5 C (74.3 F), 12.1 V / 3 A."""
    texts = (c for c in cells if isinstance(c, str) and not _empty(c)) if not isinstance(cells, np.ndarray) else ()
    first = next(iter(texts), "")
    if len(first) > CELL_LETTERS or not SEVERAL.fullmatch(first) or is_clock(first):
        return {name: cells}
    units = [unit for _, unit in VALUED.findall(first)]
    if not all(map(is_unit, units)):
        return {name: cells}
    rows = [VALUED.findall(c) if isinstance(c, str) and len(c) <= CELL_LETTERS else [] for c in cells]
    good = [[value for value, _ in row] if [unit for _, unit in row] == units else [None] * len(units) for row in rows]
    names = _once([f"{name} [{unit}]" for unit in units])
    return dict(zip(names, map(list, zip(*good, strict=True)), strict=True))


def _phase(header: str, label: str, letter: str, stems: Mapping[str, int]) -> bool:
    """Is the last letter of a name that of a phase or a sensor: one of several, or of a unit that does not fit?"""
    last = header[-1:]
    if (
        not letter
        or is_time(label)
        or header[len(label) : len(label) + 1] == ":"
        or last.lower() != letter[-1].lower()
        or header[-2:-1].isalpha()
        or header[-2:-1] in ("°", "º")
    ):
        return False
    quantities = quantities_of(label) or (["temperature"] if roles_of(label) else [])
    fits = any(unit_of(letter) in QUANTITIES[q].units for q in quantities)
    return (stems[label] > 1 and last in "ABCUVW") or (bool(quantities) and not fits) or bool(ONE_OF.search(label))


def _in_cells(cells: Sequence[Any]) -> dict[str, list[str]]:
    """The units behind the numbers of a column of cells such as "23.5 C", each with its cells."""
    if isinstance(cells, np.ndarray):
        return {}
    words = dict.fromkeys(c for c in cells if isinstance(c, str))
    valued = ((c, m[2]) for c in words if (m := WITH_UNIT.fullmatch(c.strip())))
    out: dict[str, list[str]] = {}
    for cell, unit in itertools.takewhile(lambda one: is_unit(one[1]), valued):
        out.setdefault(unit_of(unit) or unit, []).append(cell)
    return out


def _any(cells: Sequence[Any]) -> bool:
    if isinstance(cells, np.ndarray) and cells.dtype.kind == "f":
        return bool(np.isfinite(cells).any())
    return any(not _empty(c) for c in cells)


def _once(names: Sequence[str]) -> list[str]:
    """Names, numbered where one comes twice."""
    count: Counter[str] = Counter()
    out = []
    for name in names:
        count[name] += 1
        out.append(name if count[name] == 1 else f"{name} {count[name]}")
    return out


def signature(source: Source) -> frozenset[str]:
    """What tells the files of one recorder from those of another: the names of its columns."""
    return frozenset(" ".join(tokens(label)) for name, label in source.labels.items() if name != TIME)
