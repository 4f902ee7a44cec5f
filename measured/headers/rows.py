"""Where the table begins in rows of cells: preamble, header, units, numbers."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import accumulate, chain

import numpy as np

from geom.errors import InputError
from measured.headers.cells import TIMES, WITH_UNIT, is_date, is_reading, is_unit, number, split_unit, unit_of
from measured.headers.layout import Layout, Row
from measured.headers.words import READ, SETPOINT, STATISTICS, is_time, quantities_of, roles_of, tokens

NO_RECORD = "it is not a record"
SAMPLE = 2000  # rows that are enough to find the table
FIRM = 3  # rows of numbers in a row that are a table
LEAST = 0.34  # share of a row's cells that are readings: cyclers write words beside them
SHORT = 0.1  # of all rows of readings: settings of channels are few
TALLEST = 16  # rows of names, tags, kinds, units and settings over the readings
UNIT_NAMES = ("unit", "units", "einheit", "unité", "unità", "単位", "单位")  # of a column of units
MOST, LONG = 100, 20  # signals and readings of a table that lies on its side
NUMBERED = re.compile(r"\W*(?:(?i:col|column|spalte|colonne|columna|field|channel|ch)\W*)?(\d+)\s*[:=.)-]\s*(\w.*)")
EXPLAINED = re.compile(r"[\W_]*(\w.*?)\s*[=:]\s+(\S.*)")  # a line that says what a channel is
SETTING = re.compile(r"[^\W\d][^:=]*[:=]\s*(.*)")  # "Unit:C", or "Start:" where nothing was set


def layout(rows: Sequence[Row], where: str) -> Layout:
    """InputError where no table of at least two columns stands in the rows, or its header is too short for it."""
    head = rows[:SAMPLE]
    widths = Counter(len(trimmed(row)) for row in head if _readings(row))
    if not widths:
        raise InputError(f"no rows of readings in it: {NO_RECORD}", where, "columns of numbers, with or without names")
    most = widths[max(widths, key=lambda n: n * widths[n])]
    width = max(n for n, count in widths.items() if count >= 0.5 * most)
    if width < 2:
        raise InputError("the file has one column only", where, "a time or an input, and at least one temperature")
    first = _first(head, width, where)
    block = _block(rows, first, width)
    unit_rows = [i for i in block if _all_units(rows[i])]  # "Date", "Time" and "sec" alone are units too
    units = max(unit_rows, key=lambda i: (len([c for c in rows[i] if c]), i), default=None)
    candidates = [i for i in block if i != units]
    if not candidates:
        unit_row = () if units is None else rows[units]
        return Layout(_legend(rows[:first], width), tuple(_padded(unit_row, width)), first, width)
    candidates = [i for i in candidates if len(trimmed(rows[i])) >= width - 1] or candidates
    gapless = [i for i in candidates if sum(bool(str(c or "").strip()) for c in rows[i]) >= width - 1]
    if any(is_time(str(c)) or quantities_of(str(c)) for i in gapless for c in rows[i]):
        candidates = gapless  # not names of groups, which stand over the first column of each
    header = max(candidates, key=lambda i: (_informative(rows[i]), i))
    names, marked = [str(c or "").strip() for c in trimmed(rows[header])], False
    if names and names[0].strip("#%/ ") != names[0]:
        names[0] = names[0].strip("#%/ ")
        widest = max(len(row) for row in head[first:])  # cells that are empty in most rows have names too
        if marked := not names[0] and len(names) > max(width, widest):
            names = names[1:]
    if len(names) == width - 1:
        ends = [[row[j] for row in head[first:] if len(row) == width] for j in (0, -1)]
        counts = [number(cell) for cell in ends[0][:FIRM]]  # as statistics programs number their rows
        if all(names) and len(counts) > 1 and bool((np.diff(counts) == 1).all()):
            names = ["", *names]
        elif not any(number(cell) == number(cell) for cell in ends[1]):  # remarks behind the readings
            names = [*names, ""]
    names += [""] * (min(len(rows[header]), width) - len(names))  # a sign behind the last name, and cells under it
    if len(names) < width:
        right = "as many as names: decimal commas become points, or columns stand between ';'"
        raise InputError(f"{width} values under {len(names)} names", where, right)
    width = len(names) if len(names) > width else width
    names = called(names, rows[:header])
    alone = [str(rows[i][0]) for i in range(header + 1, first) if len(trimmed(rows[i])) == 1 and rows[i][0]]
    names[0] = alone[-1] if alone and is_time(split_unit(alone[-1])[0]) and not is_time(names[0]) else names[0]
    over = [row for row in rows[:header] if len(trimmed(row)) > 1 and not _readings(row) and not _settings(row)]
    above = [_padded(row, width) for row in over]
    groups = [""] * width
    one = bool(above) and len({*filter(None, above[-1][1:])}) == 1 < sum(map(bool, above[-1][1:]))  # says nothing
    if above and any(above[-1][width // 2 :]) and not one:  # names of groups over those of columns
        # Merged cells are of the group of the first of them.
        merged: Iterator[str] = accumulate(above[-1], lambda group, cell: cell or group)
        groups = list(merged)
        clear = [len(n) > 1 and _informative([n]) and not {*tokens(split_unit(n)[0])} <= SETPOINT | READ for n in names]
        whole = [t or not _informative([g]) for g, t in zip(groups, clear)]
        once = [names.count(n) == 1 and t and bool(split_unit(n)[0]) for n, t in zip(names, whole)]  # not a unit alone
        names = [n if once[j] or not n else f"{split_unit(groups[j])[0]} {n}".strip() for j, n in enumerate(names)]
    under = [_padded(rows[i], width) for i in block if i > header and i != units]
    if measured := next((r for r in under if all(split_unit(c)[1] for c in r)), ()):  # "Temperature (°C)" of each
        names = [c if is_time(split_unit(c)[0]) else f"{n} {c}" for n, c in zip(names, measured)]
    others = [*above, *under]
    statistics = next((r for r in others if {*map(str.lower, filter(None, r))} <= STATISTICS), ())
    if statistics and len({*names}) < len(names):  # of one signal the mean and the largest
        names = [f"{cell} {name}".strip() for cell, name in zip(statistics, names, strict=True)]
    if not any(map(roles_of, names)) and (
        remarks := next((r for r in others if sum(map(bool, r)) >= 0.5 * width and any(map(roles_of, r[1:]))), None)
    ):
        labels = [split_unit(name)[0] for name in names]  # remarks may stand under a row of channels, beside its clock
        late = next((labels.index(c) - j for row in others for j, c in enumerate(row) if c and c in labels), 0)
        remarks = _padded(["", *[""] * late, *remarks[1:]], width)
        names = [f"{name} {remark}".strip() for name, remark in zip(names, remarks, strict=True)]
    labelled: Row = next((row for row in rows[:header] if row and row[0] == "Y_Unit_Label"), ())  # of LabVIEW
    unit_row = rows[units] if units is not None else labelled
    unit_cells = _padded(
        unit_row[1:] if marked and unit_row and not str(unit_row[0]).strip("#%/ ") else unit_row, width
    )
    unit_cells = [
        "" if name[-1:] in ")]" and split_unit(name)[1] not in ("", "1") else u for name, u in zip(names, unit_cells)
    ]
    if not is_unit(unit_cells[0]):
        unit_cells[0] = split_unit(unit_cells[0])[1]  # the row's own label, such as "Unit [s]"
    has_unit = [u or split_unit(name)[1] or is_time(name) for name, u in zip(names, unit_cells)]
    unit_cells = [u if has else split_unit(group)[1] for u, has, group in zip(unit_cells, has_unit, groups)]
    return Layout(tuple(names), tuple(unit_cells), first, width, block[0], header)


def first_row_layout(rows: Sequence[Row], where: str) -> Layout:
    """The layout of a table that may be all words or a row or two: the first row is its header where it names every
    column, or where no readings are found. No row under the header and its units is left out."""
    try:
        plan = layout(rows, where)
    except InputError:
        plan = Layout((), (), 1, 0)
    under = plan.header + 1
    units = plan.units if under < plan.first and _all_units(rows[under]) else ()
    if plan.header > 0 and sum(bool(str(c or "").strip()) for c in rows[0]) < plan.width:
        return replace(plan, units=units or ("",) * plan.width, first=under + bool(units))
    names = [str(c or "") for c in rows[0]]
    units = units if plan.header == 0 else ()
    return Layout(tuple(names), tuple(_padded(units, len(names))), 1 + bool(units), len(names), header=0)


def _block(rows: Sequence[Row], first: int, width: int) -> list[int]:
    """The rows over the readings that may be names, units, or groups of names: those that fill half of the table.

    A row with its label alone ("Comment:", "trace_values"), with dates or times, with one number for every column or
    with the clock's name alone may stand between them, and is neither.
    """
    block: list[int] = []
    for i in reversed(range(max(0, first - TALLEST), first)):
        cells = [str(c).strip() for c in rows[i] if c is not None and str(c).strip()]
        alone = len(cells) == 1 < 0.5 * width <= (len(rows[i]) if block else width) and not cells[0].startswith("***")
        if alone or any(map(is_date, cells)) or (1 < len(cells) < 0.5 * width and all(map(is_time, cells))):
            continue
        if len(cells) > 2 and ((len(set(cells[1:])) == 1 and is_reading(cells[1])) or _valued(cells)):
            continue
        if block and _settings(cells):
            continue
        if cells and re.fullmatch("#[A-Z]+", cells[0]) and len(cells) < 3:  # a mark of what follows: #TYPES, #ROWS
            continue
        if cells and ((len(cells) < 0.5 * width and not _all_units(rows[i])) or all(map(is_reading, cells))):
            break
        if cells:
            block.insert(0, i)
    return block


def called(names: list[str], before: Sequence[Row]) -> list[str]:
    """Names of channels with what a table beside the readings calls them: there a row for each says what it is, or a
    line as "T1 = winding"; the largest and the mean of one have its words."""
    labels = [_bare(split_unit(name)[0]) for name in names]
    lines = ([*m.groups()] if row and (m := EXPLAINED.match(str(row[0]))) else row for row in map(trimmed, before))
    table = {label: row for row in lines if len(row) > 1 and (label := _bare(str(row[0]))) in labels}
    if len(table) < 2 or any(roles_of(name) for name, label in zip(names, labels, strict=True) if label in table):
        return names
    cells = [{str(row[j]) for row in table.values() if j < len(row)} for j in range(max(map(len, table.values())))]
    scores = [(sum(bool(roles_of(c)) for c in of), sum(bool(quantities_of(c)) for c in of)) for of in cells]
    column = max(range(1, len(scores)), key=lambda j: scores[j])
    words = {
        label: str(row[column]).strip() for label, row in table.items() if column < len(row) and any(scores[column])
    }
    heads = [str(cell).strip() for row in before if len(row) == len(scores) for cell in row]
    by_name = (i % len(scores) for i, head in enumerate(heads) if {*tokens(head)} & {*UNIT_NAMES})
    at = next(by_name, next((j for j, of in enumerate(cells) if j and all(map(is_unit, of))), len(scores)))
    units = {label: f" [{str(row[at]).strip(' []()')}]" for label, row in table.items() if at < len(row)}
    parts = zip(names, labels, strict=True)
    return [f"{name} {words.get(label, '')}{units.get(label, '')}".strip() for name, label in parts]


def _bare(name: str) -> tuple[str, ...]:
    """The words of a name but those for the largest, the mean and the like."""
    return tuple(word for word in tokens(name) if word not in STATISTICS)


def _legend(before: Sequence[Row], width: int) -> tuple[str, ...]:
    """What lines before the readings say of every column by its number, "" where they do not."""
    lines = (NUMBERED.fullmatch(" ".join(str(c) for c in row if c is not None).strip()) for row in before)
    labels = {int(m[1]): m[2].strip() for m in lines if m}
    return tuple(labels.values()) if [*labels] in ([*range(width)], [*range(1, width + 1)]) else ("",) * width


def transposed(rows: Sequence[Row]) -> bool:
    """Does every row hold one signal, behind its name?"""
    full = [t for t in map(trimmed, rows[: MOST + 1]) if len(t) > 1]
    width = min(map(len, full), default=0)
    wide = len(rows) <= MOST and width > max(LONG, 2 * len(full)) and len(full) > 1
    return wide and all(not is_reading(r[0]) and sum(map(is_reading, r[1:])) > 0.9 * (len(r) - 1) for r in full)


def _informative(row: Row) -> int:
    """How many of its cells say what a column is, or at least differ from each other."""
    cells = {str(c).strip() for c in row if c is not None and str(c).strip()}
    return sum(2 if quantities_of(c) or roles_of(c) or is_time(c) or split_unit(c)[1] else 0 for c in cells) + (
        len(cells) > 1
    )


def trimmed(row: Row) -> Row:
    """Without empty cells at the end: many exports close each line with a delimiter."""
    end = len(row)
    while end and (row[end - 1] is None or not str(row[end - 1]).strip()):
        end -= 1
    return row[:end]


def _readings(row: Row) -> bool:
    cells = [c for c in row if c is not None and str(c).strip()]
    good = sum(is_reading(c) for c in cells)
    numbers = [value for c in cells if (value := number(c)) == value]
    if FIRM <= len(numbers) == good < len(cells) and bool((np.diff(numbers) == 1).all()):
        return False  # names of channels that count on, and others: 1, 2, 3, "Oven", "Time"
    return good > 0 and good >= LEAST * len(cells) and any(np.isfinite(numbers))


def _first(rows: Sequence[Row], width: int, where: str) -> int:
    """The first of several rows of readings, as wide as the table or less where cells are empty.

    A few rows before a header of their own are settings of channels, whose ranges look like readings.
    """
    fits = [width / 2 < len(row) and len(trimmed(row)) <= width and _readings(row) for row in rows]
    labels = [fit and not is_reading("" if row[0] is None else row[0]) for fit, row in zip(fits, rows, strict=True)]
    for i in range(len(rows)):
        if all(fits[i : i + FIRM]) and len(fits[i : i + FIRM]) == FIRM:
            after = next((j for j in range(i, len(rows)) if not fits[j]), len(rows))
            heads = [{*map(str, trimmed(row))} for row in rows[after : after + TALLEST] if not _readings(row)]
            narrow = max(map(len, map(trimmed, rows[i:after]))) < width and len({*chain(*heads)}) >= width
            settings = narrow or any(len(head.difference(*rows[:after])) >= width for head in heads)  # none names them
            rates = _valued(rows[i]) and not _valued(rows[i + 1])
            if rates or (settings and after - i < SHORT * sum(fits)) or (labels[i] and sum(labels) < SHORT * sum(fits)):
                continue  # also rows of rates or factors behind their labels: "Interval:", 0.5, 0.5
            while i and len(rows[i - 1]) >= width and _kinds(rows[i - 1], width) == _kinds(rows[i], width):
                if _valued(rows[i - 1]):
                    break
                i -= 1  # a remark behind the readings of a first row
            return i
    raise InputError(f"fewer than three rows of readings: {NO_RECORD}", where, "at least 3 rows of numbers")


def _valued(row: Row) -> bool:
    """Are all of its cells numbers with one unit, as rates of channels are over readings without one?"""
    units = {match[2] if (match := WITH_UNIT.fullmatch(str(c).strip())) else "" for c in trimmed(row)}
    return len(units) == 1 and "" not in units


def _settings(row: Row) -> bool:
    """Is every cell "name:" or "name: value", as settings over the names are, with a reading behind one of them?"""
    cells = trimmed(row)
    values = [match[1] for c in cells if (match := SETTING.fullmatch(str(c).strip()))]
    return len(values) == len(cells) and any(map(is_reading, values))


def _kinds(row: Row, width: int) -> list[bool]:
    return [is_reading("" if c is None else c) for c in row[:width]]


def _all_units(row: Row) -> bool:
    """A label may stand before them; units of times alone are those of the steps between rows."""
    cells = [str(c).strip() for c in row if c is not None and str(c).strip()]
    cells = [c for c in cells if c.lower() not in UNIT_NAMES] or cells  # once, or before the unit of every signal
    steps = len(cells) > 2 and {unit_of(c) for c in cells[1:]} <= {*TIMES}
    units = [c for c in cells if is_unit(c)]
    ratios = all(is_reading(c) for c in units)  # 1 is a unit, but not the only one
    return bool(cells) and not steps and not ratios and len(units) >= 0.6 * len(cells)


def _padded(row: Row, width: int) -> list[str]:
    cells = ["" if c is None else str(c).strip() for c in row]
    return [*cells, *[""] * width][:width]
