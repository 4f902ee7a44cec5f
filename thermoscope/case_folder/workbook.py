"""Results as people take them away: a workbook (.xlsx) with input, results and errors, or the same tables as .csv."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from thermoscope.case_folder.files import write_whole

if TYPE_CHECKING:
    import pandas as pd

    from thermoscope.case_folder.folder import Folder
    from validation.case import Test

UNREADABLE = str.maketrans("[]:*?/\\", "_______")  # what Excel forbids in the name of a worksheet


def tables(folder: Folder) -> dict[str, pd.DataFrame]:
    """Worksheet -> table: parameters, errors, and for each test its inputs and its results side by side."""
    import pandas as pd

    result = folder.compared
    errors = [{"test": t.name, "role": t.role, **c.document()} for t in result.tests for c in t.channels]
    model = folder.case.model
    parameters = [
        {"parameter": p.name, "value": model.values.get(p.name, p.value), "unit": p.unit, "prior sd": p.prior_sd,
         "source": p.source}
        for p in model.network.parameters
    ]  # fmt: skip
    out = {"parameters": pd.DataFrame(parameters), "errors": pd.DataFrame(errors)}
    for test in folder.case.tests:
        out[f"{test.name} input"] = _inputs(test)
        out[f"{test.name} results"] = _results(folder, test)
    return out


def _inputs(test: Test) -> pd.DataFrame:
    import pandas as pd

    boundaries = {f"{name} (degC)": np.broadcast_to(v, test.time.shape) for name, v in test.boundaries.items()}
    inputs = {name: np.broadcast_to(v, test.time.shape) for name, v in test.inputs.items()}
    return pd.DataFrame({"time_s": test.time, **inputs, **boundaries})


def _results(folder: Folder, test: Test) -> pd.DataFrame:
    import pandas as pd

    from thermoscope.case_folder.runs import readings

    calculated = readings(folder.case, test)
    columns: dict[str, Any] = {"time_s": test.time}
    for channel in test.channels:
        columns[f"{channel.name} measured (degC)"] = channel.y
        columns[f"{channel.name} calculated (degC)"] = calculated[channel.name]
    return pd.DataFrame(columns)


def write_xlsx(path: Path, content: Mapping[str, pd.DataFrame]) -> Path:
    """One worksheet per table."""
    import pandas as pd

    memory = io.BytesIO()
    with pd.ExcelWriter(memory, engine="openpyxl") as book:
        for name, table in content.items():
            table.to_excel(book, sheet_name=name.translate(UNREADABLE)[:31], index=False)
    return write_whole(path, memory.getvalue())


def write_csvs(folder: Path, content: Mapping[str, pd.DataFrame]) -> list[Path]:
    """One file per table, named after it."""
    return [
        write_whole(folder / f"{name.replace(' ', '-')}.csv", table.to_csv(index=False))
        for name, table in content.items()
    ]
