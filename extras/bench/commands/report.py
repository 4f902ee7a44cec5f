"""thermoscope bench report RECORD.toml"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from extras.bench.heat_run.judgement import judged
from extras.bench.heat_run.page import tables, write_report
from extras.bench.heat_run.record import read_heat_run
from thermoscope import plugin as th


def report(
    record: Annotated[Path, typer.Argument(metavar="RECORD.toml|CASE", help="A heat run, or a case with one.")],
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """The heat run by IEC 60034-1 on a page to sign: rise against its class's limit. Exit code 1 unless it passes."""
    with th.progress() as tell:
        tell("reading the record")
        run = read_heat_run(record, tell)
        document = judged(run)
        tell("printing")
        paths = write_report(document, out or Path("out"), "-".join(th.file_stem(run.title).split()))
    th.give(document, json, lambda: report_summary(document, paths))
    return 0 if document["verdict"] == "passes" else 1


def report_summary(document: Mapping[str, Any], paths: Sequence[Path]) -> th.Summary:
    """The verdict; then the rises, the duty and the limits."""
    every = tables(document)
    files = f"written: {', '.join(map(str, paths))}"
    missing = [] if paths[-1].suffix == ".pdf" else [th.NO_PDF]
    parts: list[th.Table | str] = [every["rises"], every["duty"], *missing, every["limits"]]
    return th.Summary(
        f"{document['title']}, {document['sentence']}.", parts, files, [every["steps"], every["signature"]]
    )
