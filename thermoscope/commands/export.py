"""thermoscope export CASE"""

from __future__ import annotations

from pathlib import Path

from thermoscope.commands.opened import opened
from thermoscope.terminal import give, progress, say
from thermoscope.workbook import tables, write_csvs, write_xlsx


def export(case: str, out: Path | None, csv: bool, target: str | None) -> int:
    """Inputs, results, errors and parameters to OUT/CASE.xlsx, or as CSV files."""
    with progress() as tell:
        folder = opened(case, tell)
        tell("running the model")
        content = tables(folder)
    where = out or folder.settings.out
    name = folder.settings.path.resolve().name
    written = write_csvs(where, content) if csv else [write_xlsx(where / f"{name}.xlsx", content)]
    document = {"case": folder.case.name, "files": [str(p) for p in written], "worksheets": list(content)}
    give(document, target, lambda: say("\n".join(str(p) for p in written)))
    return 0
