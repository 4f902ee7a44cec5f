"""Results as people take them away: a workbook (.xlsx) with input, results and errors, or the same tables as .csv."""

import io
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geom.description.names import file_stem
from geom.escapes import csv_lines
from geom.storage import write_whole
from geom.table import Table
from geom.text import visible
from measured.recordings.data_table import rows_of

if TYPE_CHECKING:
    from measured.case import Test
    from thermoscope.case_folder.folder import Folder

UNREADABLE = str.maketrans("[]:*?/\\'", "________")  # what Excel forbids in the name of a worksheet, or at its ends


def tables(folder: "Folder") -> list[Table]:
    """A worksheet each: parameters, errors, and for each test its inputs and its results side by side."""
    from thermoscope.case_folder.runs import readings

    errors = [{"test": t.name, "role": t.role, **c.document()} for t in folder.compared.tests for c in t.channels]
    keys = dict.fromkeys(key for record in errors for key in record)
    columns = "parameter=name | value | unit | prior sd=prior_sd | source"
    parameters, values = folder.case.model.network.parameters, folder.case.model.values
    out = [
        Table.of("parameters", parameters, columns, value=lambda p: values.get(p.name, p.value)),
        Table("errors", list(keys), [[record.get(key) for key in keys] for record in errors]),
    ]
    for test in folder.case.tests:
        boundaries = {f"{name} (degC)": v for name, v in test.boundaries.items()}
        out.append(_over_time(f"{test.name} input", test, {**test.inputs, **boundaries}))
        calculated, both = readings(folder.case, test), dict[str, Any]()
        for c in test.channels:
            both |= {f"{c.name} measured (degC)": c.y, f"{c.name} calculated (degC)": calculated[c.name]}
        out.append(_over_time(f"{test.name} results", test, both))
    return out


def _over_time(title: str, test: "Test", columns: Mapping[str, Any]) -> Table:
    """Columns of a test beside its time (s)."""
    wide = {name: np.broadcast_to(v, test.time.shape) for name, v in columns.items()}
    names, *rows = rows_of({"time_s": test.time, **wide})
    return Table(title, names, rows)


def write_xlsx(path: Path, content: Iterable[Table]) -> Path:
    """One worksheet per table; its header stays in sight."""
    from openpyxl import Workbook

    book, memory = Workbook(write_only=True), io.BytesIO()
    for table in content:
        sheet = book.create_sheet(visible(table.title).translate(UNREADABLE)[:28])  # of 31, with room for a number
        sheet.freeze_panes = "A2"
        for row in (table.columns, *table.rows):
            sheet.append([_typed(sheet, value) for value in row])
    book.save(memory)
    return write_whole(path, memory.getvalue())


def _typed(sheet: Any, value: Any) -> Any:
    """What a cell of a worksheet holds: of a text always the text, also of one that looks like a formula."""
    from openpyxl.cell import WriteOnlyCell

    if isinstance(value, float) and np.isinf(value):
        return str(value)
    if not isinstance(value, str):
        return value
    cell = WriteOnlyCell(sheet, visible(value))
    cell.data_type = "s"
    return cell


def write_csvs(folder: Path, content: Iterable[Table]) -> list[Path]:
    """One file per table, named after it."""
    return [
        write_whole(folder / f"{file_stem(table.title.replace(' ', '-'))}.csv", csv_lines([table.columns, *table.rows]))
        for table in content
    ]
