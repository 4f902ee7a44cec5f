"""Results as people take them away: a workbook (.xlsx) with input, results and errors, or the same tables as .csv."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geom.description.names import file_stem
from geom.escapes import csv_lines
from geom.storage import write_whole
from geom.text import visible
from measured.recordings.data_table import rows_of

if TYPE_CHECKING:
    from measured.case import Test
    from thermoscope.case_folder.folder import Folder

Worksheet = Mapping[str, Sequence[Any] | NDArray[Any]]  # column -> its cells
UNREADABLE = str.maketrans("[]:*?/\\'", "________")  # what Excel forbids in the name of a worksheet, or at its ends


def tables(folder: Folder) -> dict[str, Worksheet]:
    """Worksheet -> table: parameters, errors, and for each test its inputs and its results side by side."""
    errors = [{"test": t.name, "role": t.role, **c.document()} for t in folder.compared.tests for c in t.channels]
    model = folder.case.model
    parameters = [
        {
            "parameter": p.name,
            "value": model.values.get(p.name, p.value),
            "unit": p.unit,
            "prior sd": p.prior_sd,
            "source": p.source,
        }
        for p in model.network.parameters
    ]
    out: dict[str, Worksheet] = {"parameters": _columns(parameters), "errors": _columns(errors)}
    for test in folder.case.tests:
        out[f"{test.name} input"] = _inputs(test)
        out[f"{test.name} results"] = _results(folder, test)
    return out


def _columns(records: Sequence[Mapping[str, Any]]) -> Worksheet:
    """Records as columns, None where one lacks a key."""
    keys = dict.fromkeys(key for record in records for key in record)
    return {key: [record.get(key) for record in records] for key in keys}


def _inputs(test: Test) -> Worksheet:
    boundaries = {f"{name} (degC)": np.broadcast_to(v, test.time.shape) for name, v in test.boundaries.items()}
    inputs = {name: np.broadcast_to(v, test.time.shape) for name, v in test.inputs.items()}
    return {"time_s": test.time, **inputs, **boundaries}


def _results(folder: Folder, test: Test) -> Worksheet:
    from thermoscope.case_folder.runs import readings

    calculated = readings(folder.case, test)
    columns = {"time_s": test.time}
    for channel in test.channels:
        columns[f"{channel.name} measured (degC)"] = channel.y
        columns[f"{channel.name} calculated (degC)"] = calculated[channel.name]
    return columns


def write_xlsx(path: Path, content: Mapping[str, Worksheet]) -> Path:
    """One worksheet per table; its header stays in sight."""
    from openpyxl import Workbook

    book, memory = Workbook(write_only=True), io.BytesIO()
    for name, table in content.items():
        sheet = book.create_sheet(visible(name).translate(UNREADABLE)[:31])
        sheet.freeze_panes = "A2"
        for row in rows_of(table):
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


def write_csvs(folder: Path, content: Mapping[str, Worksheet]) -> list[Path]:
    """One file per table, named after it."""
    return [
        write_whole(folder / f"{file_stem(name.replace(' ', '-'))}.csv", csv_lines(rows_of(table)))
        for name, table in content.items()
    ]
