"""Text exports: any encoding, delimiter and decimal sign, with or without a preamble, into named columns."""

from __future__ import annotations

import csv
import io
import itertools
import json
import re
from codecs import getincrementaldecoder
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, cast

from geom.errors import InputError
from measured.headers.cells import in_thousands, is_date, is_reading, number
from measured.headers.rows import NO_RECORD, SAMPLE, Layout, layout, transposed
from measured.headers.words import CLOCKS, IDEOGRAPHS, QUANTITY, ROLES
from measured.recordings.csv_file import BLOCK, Body, chunks, shared
from measured.recordings.data_table import PIECE

DELIMITERS = ("\t", ";", ",", "|")
BLANKS = {" ": r"\s+", "  ": r"\s{2,}|\t"}  # between columns; names may have single blanks in them
SAMPLE_LINES = 400  # lines from the middle that tell the delimiter
ODD = 10_000  # bytes of cells with letters beyond ASCII: enough to tell a code page
BOMS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"\xef\xbb\xbf": "utf-8-sig"}
# Code pages of loggers; which one it is, is told by the letters that it gives: those that headers have.
PAGES = ("cp1252", "cp850", "mac_roman", "cp932", "gb18030", "cp1250", "cp1251", "cp949", "cp1254")
RUSSIAN = re.compile("[А-яё]{4,}")
_TERMS = [word for terms in (*QUANTITY.values(), *ROLES.values()) for word in terms]
_LONG = {w for w in (*_TERMS, *CLOCKS) if not w.isascii() and len(w) > (1 if w[0] >= IDEOGRAPHS else 3)}
WORDS = re.compile("|".join(sorted(_LONG, key=len, reverse=True)), re.IGNORECASE)  # of headers, in letters of a page
LETTERS = re.compile(
    r"[°ºµΩ²³äöüÄÖÜßéèêàçùìòáíóúñőűřěłšžğış℃\u3040-\u30ff]|[温度时间电流转速绕组環境時年月日分秒番号刻電圧巻線室外气測定間隔型式计数序采样压功率机壳]"
)
INTERVAL = re.compile(
    r"(?im)^\W*(?:delta_x|hresolution|sampl\w*[ _]?(?:interval|period|time)|interval|abtast\w*|messintervall"
    r"|scan interval|messtakt|(?:\w+ )?rate(?=[^\d\n]*[\d.,]+[\s\",;]*(?:ms|sec|s|min|h)\b))"
    r"(?:\s*[\[(](ms|sec|s|min|h)[\])])?[^\d\n]*?(\d+(?:[.,]\d+)?)[\s\",;]*(ms|sec|s|min|h)?\b"
)
TIMES = {"ms": 1e-3, "min": 60.0, "h": 3600.0}
FEW_SHORT = 0.1  # of the rows: more that are short have empty ends
DEGREE = 5  # letters: every second header has one, and no page but the right one makes it
PAIR = r"[^\W\d]\w*=[^\s=]+(?: [^\s=\d][^\s=]*(?!\S))?"  # of a line that a program logged
LOGGED = re.compile(rf"^\[?((?:\d\S*[ T])?\d+:\d\d:[^\s\]]+)(?=[\s\]])[^=\n]*?((?:\s{PAIR})+)\s*$", re.MULTILINE)
POINT = re.compile(r"^([^\s=,]+(?:,\S+=\S+)?) ([^\s=,]+=\S+?)[iu]? (\d{10,19})(?=\r?$)", re.MULTILINE)  # a,b=c d=5i 17
HEATERS = {"T": "nozzle", "B": "bed", "C": "chamber"}
HEATED = r"(T\d?|B|C):\s*([-+.\d]+)\s*/\s*([-+.\d]+)"  # of a 3D printer, and what is wanted
PRINTER = re.compile(rf"^(?:(\d\S*[ T]\d+:\d\d:\S+)\s)?.*?\b(?={HEATED})", re.MULTILINE)
TITLE = re.compile(r"(?:.*\.)?_*(?:name|label|channel|signal|title|target)_*")  # of a signal in JSON: metric.__name__
UNITS = ("unit", "units")
# A serial monitor's time before each line, one in brackets, or one with a date and a blank before cells with signs.
ARROW = re.compile(
    r"^(?:(\d{1,2}:\d{2}:\d{2}[.,]\d+) -> |\[\s*(\d[\d:.,]*)\]:?\s+"
    r"|(\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4} \d{1,2}:\d\d(?::\d\d)?)\s+(?=[-+]?\d\S*(?:[;|\t]|,\s)))",
    re.MULTILINE,
)
# A date and a time with another sign than a blank between, after a program's level and name, or before " - " or "--".
_DAY, _TIME, _DASH = r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}", r"\d{1,2}:\d\d:[\d.]+", "(?: - |--)"
STAMP = re.compile(
    rf"^(?:[A-Z]+:\w*:|(?={_DAY}[-@])|(?={_DAY} {_TIME}{_DASH}))({_DAY})[-@ ](\d{{1,2}}:\d\d:)(\d+)([.\d]*)({_DASH})?",
    re.MULTILINE,
)
FRAME = re.compile(r"(?m)(?<![ \t])(?:[ \t]+[\dA-Fa-f]{2}){4,8}[ \t\r]*$")  # of CAN: its bytes, from a first blank on
HEXADECIMAL = re.compile(r"\b(?:0[\dA-Fa-f]|\d?[A-Fa-f][\dA-Fa-f]?)\b")
REMARK = re.compile(r"^#[^,;\t\n]*[^,;\s]", re.MULTILINE)  # that may come again between the rows
FORTRAN = re.compile(r"(?<=[.\d]\d)[Dd](?=[-+]\d\d\b)")  # 2.4D+01
KEYED = re.compile(r"\s*([^\W\d][^:=,;\t]*?)\s*[:=]\s*(\S.*)")
BOTH_SIGNS = re.compile(r"(?<![\d.:/-])\d+\.\d+(?![\d.:/-])")  # a number with a point, which is not a date

Columns = list[Any]


@dataclass(frozen=True)
class Lines:
    """The lines of a text file with their ends, read anew whenever they are gone through: a large file never stands in
    memory as text.  edit : what stands for a line; "" where nothing does"""

    file: Path
    encoding: str
    edit: Callable[[str], str] = str

    def __iter__(self) -> Iterator[str]:
        decode, rest = getincrementaldecoder(self.encoding)("replace").decode, list[str]()
        for part in itertools.chain(chunks(self.file, BLOCK), [b""]):
            rest.append(decode(part, not part))
            if part and "\n" not in rest[-1]:
                continue
            lines = "".join(rest).splitlines(keepends=True)
            rest = [lines.pop()] if part else []  # it may go on, if only by the second sign of its end
            yield from filter(None, map(self.edit, lines))

    def edited(self, edit: Callable[[str], str]) -> Lines:
        before = self.edit
        return replace(self, edit=lambda line: edit(before(line)))


def text_table(file: Path) -> tuple[Layout, Columns, list[str], float | None]:
    """Where the table stands in a text file, its columns (numbers, or cells where there are words), and doubts.

    The last is the time between rows (s) where the lines before the header say it.
    """
    lines, notes = Lines(file, encoding_of(lambda: chunks(file, BLOCK), file)), list[str]()
    start = "".join(itertools.islice(lines, SAMPLE_LINES))[:10_000]
    if again := {r for r, n in Counter(REMARK.findall(start)).items() if n > 2 and re.search(r"[,;\t]", start)}:
        lines = lines.edited(lambda line: "" if line.strip() in again else line)
        start = "".join(itertools.islice(lines, SAMPLE_LINES))[:10_000]
    frames = [m[0] for m in FRAME.finditer(start) if HEXADECIMAL.search(m[0])]
    if 2 * len(frames) > start.count("\n"):
        right = "the signals in them by name, as the program that recorded the bus writes them: CSV or .mf4"
        raise InputError(f"its rows are frames of a bus, which have no names: {NO_RECORD}", str(file), right)
    if 3 * sum(not line.strip() for line in start.splitlines()) > start.count("\n"):  # between every two rows
        lines = lines.edited(lambda line: line if line.strip() else "")
    if len({point[1] for point in POINT.finditer(start)}) == 1:
        lines = lines.edited(lambda line: re.sub(r"[iu]?,", "\t", POINT.sub(r"\3,\2", line)))
    for pattern, least, edit in EDITS:
        lines = lines.edited(edit) if len(pattern.findall(start)) >= least else lines
    first = next((line for line in lines if line.strip()), "")
    if first.lstrip()[:1] in ("{", "[") and (table := _objects("".join(lines))):
        return *table, notes, None
    count, odd = 0, list[int]()
    for count, line in enumerate(lines, 1):
        if line.count('"') % 2:
            odd.append(count)
    if len(odd) % 2:
        notes.append(f"{file.name}: a quotation mark in line {odd[0]} has no partner; such marks are left out")
        lines = lines.edited(lambda line: line.replace('"', ""))
    middle = max(0, count // 2 - SAMPLE_LINES // 2)
    sign = delimiter([*itertools.islice(lines, middle, middle + SAMPLE_LINES)])
    head = [*itertools.islice(lines, 2 * SAMPLE)]
    cells, rows = split_cells(head, sign), cast("Iterable[str]", lines)
    if transposed(cells):
        cells = [*map(list, zip(*(row for row in cells if len(row) > 1), strict=False))]
        rows, sign = ["\t".join(row) + "\n" for row in cells], "\t"
    if keys := _keys(cells):
        every = [dict(map(_pair, reversed(row))) for row in split_cells([*rows], sign) if any(row)]
        readings = [[row.get(key) for key in keys] for row in every if 2 * len(row.keys() & {*keys}) > len(keys)]
        unlike = f"{file.name}: {len(every) - len(readings)} lines without the names of the others are left out"
        notes += [unlike] * (len(readings) < len(every))
        return Layout(tuple(keys), ("",) * len(keys), 0, len(keys)), _raw(readings, len(keys)), notes, None
    if cells[1:] and len(cells[0]) == 1:  # one word, whose sign is not that of the readings
        cells[0] = next((o for s in DELIMITERS if len(o := split_cells(head[:1], s)[0]) == len(cells[1])), cells[0])
    plan = layout(cells, str(file))
    if not any(plan.names):  # names parted by another sign than the readings, or by one blank where those have several
        lines_over = [bare for line in head[: plan.first] if (bare := line.strip("#%/ \n"))]
        others = (split_cells([line], s)[0] for line in lines_over for s in (*DELIMITERS, " "))
        names = next((tuple(o) for o in others if len(o) == plan.width and all(o)), plan.names)
        plan = replace(plan, names=names, units=plan.units if names != plan.units else ("",) * plan.width)
    interval_s = _interval("".join(itertools.islice(rows, plan.first)))
    least, short = _whole(cells[plan.first :] if rows is lines and sign in DELIMITERS else [], any(plan.names))
    notes += [f"{file.name}: {short}"] * bool(short)
    columns = _plain(file, rows, sign, plan, least)
    if columns is None:
        columns, long = _with_words(rows, sign, plan, least)
        notes += [f"{file.name}: {long} rows have more cells than the others; those cells are left out"] * bool(long)
        whole = in_thousands(columns)
        notes += [
            f"{file.name}: the sign in the numbers of '{plan.names[j] or f'column {j + 1}'}' stands between thousands"
            for j in whole
        ]
        columns = [whole.get(j, cells) for j, cells in enumerate(columns)]
    return plan, columns, notes, interval_s


def _parted(line: str) -> str:
    """A line with its sign between cells behind the time before it too."""
    sign = next((s for s in DELIMITERS if s in line), "\t")
    return ARROW.sub(lambda match: f"{match[match.lastindex or 0]}{sign}", line)


def _logged(line: str) -> str:
    """The cells of a line that a program logged."""
    return "".join("\t".join([time, *re.findall(PAIR, pairs)]) + "\n" for time, pairs in LOGGED.findall(line))


def _answered(line: str) -> str:
    """The cells of a line with which a printer says how warm it is; "" for any other."""
    match = PRINTER.search(line)
    parts = [(f"{HEATERS[n[0]]} {n[1:]}".strip(), read, target) for n, read, target in re.findall(HEATED, line)]
    pairs = [f"{name} temperature:{read}\t{name} set:{target}" for name, read, target in parts]
    return "\t".join([*filter(None, [match[1]]), *pairs]) + "\n" if match else ""


EDITS: tuple[tuple[re.Pattern[str], int, Callable[[str], str]], ...] = (  # how often it is in the first lines
    (FORTRAN, 1, lambda line: FORTRAN.sub("E", line)),
    (STAMP, 1, lambda line: STAMP.sub(lambda m: f"{m[1]} {m[2]}{m[3].zfill(2)}{m[4]}" + "\t" * bool(m[5]), line)),
    (ARROW, 1, _parted),
    (LOGGED, 10, _logged),
    (PRINTER, 3, _answered),
)


def _objects(text: str) -> tuple[Layout, Columns] | None:
    """Of JSON: an object on every line, a list of them, or one of columns; what stands inside another is called
    outer.inner."""
    try:
        every = json.loads(text)
    except (ValueError, RecursionError):
        try:
            every = [json.loads(t) for t in text.splitlines() if t.strip()]
        except (ValueError, RecursionError):
            return None
    outer = dict[str, Any]()  # also what fields with numbers are called
    if isinstance(every, dict):
        outer = {path: one for path, one in _flat(every).items() if isinstance(one, str)}
        every = _frame(every)
    if isinstance(every, dict):
        inside = {name: one for name, one in _flat(every).items() if isinstance(one, list)}
        most, _ = Counter(map(len, inside.values())).most_common(1)[0] if inside else (0, 0)
        columns = {name: one for name, one in inside.items() if len(one) == most}
        table = zip(*columns.values(), strict=True)
        every = columns.pop(*columns) if len(columns) == 1 else [dict(zip(columns, row, strict=True)) for row in table]
    rows = _signals([_flat(one) for one in every])
    names = tuple(dict.fromkeys(name for row in rows for name in row))
    titles = {path.rpartition(".")[2]: title for path, title in outer.items() if path[-1:].isdigit() and title}
    return Layout(tuple(str(titles.get(name, name)) for name in names), ("",) * len(names), 0, len(names)), [
        [row.get(name) for row in rows] for name in names
    ]


def _signals(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Of objects that hold a name and a list each a row for every reading, where it stands beside its instant, else one
    for all of them; any others as they are.  Of one name the words beside it tell them apart: a place."""
    lists = [[value for value in row.values() if isinstance(value, list)] for row in rows]
    titles = [next((v for path, v in row.items() if TITLE.fullmatch(path) and isinstance(v, str)), "") for row in rows]
    if any(len(one) != 1 for one in lists) or not all(titles):
        return rows
    units = [next((f" [{row[key]}]" for key in UNITS if isinstance(row.get(key), str)), "") for row in rows]
    for i, (row, title) in enumerate(zip(rows, [*titles], strict=True)):
        same = [other for other in rows if title in other.values()]
        places = [v for path, v in row.items() if isinstance(v, str) and any(other.get(path) != v for other in same)]
        titles[i] = " ".join([title, *places]) + units[i]
    signals = [(title, one) for title, (one,) in zip(titles, lists, strict=True)]
    if not all(isinstance(pair, list) and len(pair) == 2 for _, one in signals for pair in one):
        return [dict(zip(titles, row, strict=True)) for row in zip(*(one for _, one in signals))] if rows[1:] else rows
    # Instants since 1970 are the larger numbers.
    at = [bool(one) and number(one[0][1]) > number(one[0][0]) for _, one in signals]
    return [
        {"time": p[last], "signal": title, "value": p[not last]} for (title, one), last in zip(signals, at) for p in one
    ]


def _frame(one: dict[str, Any]) -> Any:
    """A data frame as pandas writes it: rows beside their names and index, or an object for each column or row, with
    the index or the names as its keys. Any other object as it is."""
    data, names = one.get("data"), one.get("columns")
    if isinstance(data, list) and isinstance(names, list):
        if all(isinstance(row, list) and len(row) == len(names) for row in data):
            return {"time": one.get("index"), **dict(zip(map(str, names), map(list, zip(*data))))}
        return one
    keys = {tuple(inner) if isinstance(inner, dict) else () for inner in one.values()}
    if len(keys) != 1 or not (index := keys.pop()):
        return one
    if len(index) < len(one):
        return [{"time": time, **row} for time, row in one.items()]
    return {"time": [*index], **{name: [*column.values()] for name, column in one.items()}}


def _flat(one: Any, name: str = "") -> dict[str, Any]:
    """Values of an object and of those inside it, by the names that lead to them."""
    if isinstance(one, dict):
        return {n: v for key, value in one.items() for n, v in _flat(value, f"{name}.{key}".strip(".")).items()}
    return {name: one}


def _interval(preamble: str) -> float | None:
    """Time between rows (s) as lines before a header give it: "Delta_X 0,5", "Sampling interval, 5 s"."""
    match = INTERVAL.search(preamble)
    step = number(match[2]) * TIMES.get((match[1] or match[3] or "s").lower(), 1.0) if match else 0.0
    return step if step > 0 else None


def _whole(rows: Sequence[Sequence[str]], has_names: bool) -> tuple[int, str]:
    """The least cells of a row that is read, and a doubt: where few rows have fewer than the rest, a reading is
    missing and those behind it stand under other names; where many have, without names nobody knows which."""
    widths = Counter(len(row) for row in rows if any(row))
    usual = max(widths, key=lambda n: (widths[n], n), default=0)
    short = sum(count for n, count in widths.items() if n < usual)
    if short > FEW_SHORT * widths.total():
        unequal = f"rows have {min(widths)} to {max(widths)} cells, so that a column may hold several signals"
        return 0, unequal * (not has_names)
    return usual * bool(short), f"{short} rows have fewer cells than the others: left out" * bool(short)


def _plain(file: Path, lines: Iterable[str], sign: str, plan: Layout, least: int) -> Columns | None:
    """By the reader of plain CSV, which a table is once signs are replaced; None where it is not that simple."""
    if sign in BLANKS:
        return None
    try:
        return Body(file, plan.width).columns(text.encode() for text in _with_commas(lines, sign, plan, least))
    except csv.Error:
        return None


def _with_commas(lines: Iterable[str], sign: str, plan: Layout, least: int) -> Iterator[str]:
    """Rows of readings with commas between them and points in them, many at once.

    csv.Error where there are quotation marks, or commas in some numbers and points in others.
    """
    again, commas, points = sign.join(plan.names), False, False  # a header and remarks may come again
    body = (line for line in itertools.islice(lines, plan.first, None) if line[0] != "#" and line.strip() != again)
    rows = (line for line in body if line.count(sign) + 1 >= least)
    while text := "".join(itertools.islice(rows, PIECE)):
        if sign != ",":
            commas, points = commas or "," in text, points or bool(BOTH_SIGNS.search(text))
        if '"' in text or (commas and points):
            raise csv.Error("no plain numbers")
        yield text if sign == "," else text.replace(",", ".").replace(sign, ",")


def _with_words(lines: Iterable[str], sign: str, plan: Layout, least: int) -> tuple[Columns, int]:
    """Columns of cells, and how many rows have more than the header."""
    columns, long, first = [list[Any]() for _ in range(plan.width)], 0, plan.first
    for some in _whole_rows(lines):
        rows, first = split_cells(some, sign)[first:], 0
        body = [r for r in rows if any(r) and r[: plan.width] != [*plan.names] and not "".join(r[:1]).startswith("#")]
        body = [row for row in body if len(row) >= least]
        long += sum(any(c.strip() for c in row[plan.width :]) for row in body)
        for column, cells in zip(columns, _raw(body, plan.width), strict=True):
            column += shared(cells)
    return columns, long


def _whole_rows(lines: Iterable[str]) -> Iterator[list[str]]:
    """Lines, so many at once as end outside quotation marks: the words of all take ten times their memory."""
    some, marks = list[str](), 0
    for line in lines:
        some.append(line)
        marks += line.count('"')
        if len(some) >= PIECE and marks % 2 == 0:
            yield some
            some = []
    yield some


def _raw(rows: Sequence[Sequence[str | None]], width: int) -> Columns:
    return [[row[j] if j < len(row) else None for row in rows] for j in range(width)]


def _pair(cell: str) -> tuple[str, str]:
    """Name and reading, as in "T1: 23.5"; "Mo. 03.06.2024 23:40" is not a reading of 40."""
    match = None if is_date(cell) else KEYED.fullmatch(cell)
    return (match[1], match[2]) if match else ("", cell)


def _keys(rows: list[list[str]]) -> list[str]:
    """The names in such rows, where most have the same."""
    patterns = [tuple(_pair(cell)[0] for cell in row) for row in rows if any(row)]
    same = max(set(patterns), key=patterns.count, default=())
    return (
        list(same)
        if sum(map(bool, same)) >= max(1, len(same) - 1) and patterns.count(same) > 0.5 * len(patterns)
        else []
    )


def decoded(raw: bytes, file: Path) -> str:
    return raw.decode(encoding_of(lambda: [raw], file), "replace")


def encoding_of(parts: Callable[[], Iterable[bytes]], file: Path) -> str:
    """UTF-8, UTF-16 with its mark or without, or the code page whose letters are those of headers.

    parts : gives the bytes of the text, piece by piece, whenever it is asked
    """
    decode, utf8 = getincrementaldecoder("utf-8")().decode, True
    for i, part in enumerate(itertools.chain(parts(), [b""])):
        if i == 0 and (encoding := _wide(part)):
            return encoding
        if b"\0" in part:
            what = "is packed, as a spreadsheet .ods is" if part[:2] == b"PK" else "holds zero bytes"
            right = "CSV or other text, .xlsx, .tdms, .mf4, .parquet or .mat"
            raise InputError(f"{what}, so it is not text: {NO_RECORD}", str(file), right)
        try:
            decode(part, not part) if utf8 else None
        except UnicodeDecodeError:
            utf8 = False
    if utf8:
        return "utf-8"
    lines = (line for part in parts() for line in part.splitlines() if not line.isascii())
    cells = (re.sub(rb"\d", b"", cell) for line in lines for cell in re.split(rb"[,;\t]", line) if not cell.isascii())
    odd = dict[bytes, None]()  # each cell counts once, however often a column has it and whatever its numbers
    while len(b"\n".join(odd)) < ODD and (some := [*itertools.islice(cells, ODD)]):
        odd |= dict.fromkeys(some)
    return _page(b"\n".join(odd)[:ODD])


def _wide(start: bytes) -> str:
    """The encoding that the first bytes of a text show by a mark or by their zeros, else nothing."""
    for bom, encoding in BOMS.items():
        if start.startswith(bom):
            return encoding
    for encoding, zeros in (("utf-16-le", start[1:200:2]), ("utf-16-be", start[:200:2])):
        if len(zeros) > 4 and zeros.count(0) > 0.9 * len(zeros):
            return encoding
    return ""


def _page(odd: bytes) -> str:
    """The code page that makes the most of cells with letters beyond ASCII."""
    letters = {page: odd.decode(page, "ignore") for page in PAGES}  # of headers, and degrees above all
    worth = {p: len(LETTERS.findall(t)) + DEGREE * len(re.findall("[°º][CFK]|℃", t)) for p, t in letters.items()}
    worth["cp1251"] += sum(map(len, RUSSIAN.findall(letters["cp1251"])))
    for page, words in letters.items():
        worth[page] += DEGREE * sum(map(len, WORDS.findall(words)))
    return max(PAGES, key=lambda page: worth[page])


def delimiter(lines: list[str]) -> str:
    """The sign between columns, one or two blanks: the one that leaves the most cells that are readings.

    Blanks stand within instants too, so they are it only where no other sign leaves readings nearly everywhere.
    """
    scores, shares = {}, {}
    for sign in (*DELIMITERS, *reversed(BLANKS)):
        rows = (row for row in split_cells(lines, sign) if len(row) > 1)
        # without names, which have signs and blanks of their own
        cells = [cell for row in rows if re.search(r"\d", "".join(row)) for cell in row]
        good = sum(is_reading(cell) or bool((m := KEYED.fullmatch(cell)) and is_reading(m[2])) for cell in cells)
        scores[sign], shares[sign] = (good * good / len(cells), good / len(cells)) if cells else (0.0, 0.0)
    sure = [sign for sign in DELIMITERS if shares[sign] >= 0.9] or [*scores]
    return max(sure, key=lambda sign: scores[sign])


def split_cells(lines: list[str], sign: str) -> list[list[str]]:
    """Cells of lines."""
    if sign in BLANKS:
        return [re.split(BLANKS[sign], line.strip()) if line.strip() else [] for line in lines]
    text = io.StringIO("".join(lines), newline="")
    try:
        return [[cell.strip() for cell in row] for row in csv.reader(text, delimiter=sign, skipinitialspace=True)]
    except csv.Error:
        return [[cell.strip() for cell in line.split(sign)] for line in lines]
