"""thermoscope bench report RECORD.toml"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from extras.bench.heat_run.judgement import judged
from extras.bench.heat_run.page import tables, write_report
from extras.bench.heat_run.record import read_heat_run
from thermoscope import plugin as th


def report_files(record: Path, folder: Path, tell: th.Progress) -> tuple[dict[str, Any], list[Path]]:
    """The document of a heat run, and the files in `folder`, which are written when all of it is known."""
    tell("reading the record")
    run = read_heat_run(record, tell)
    document = judged(run)
    tell("printing")
    return document, write_report(document, folder, "-".join(th.file_stem(run.title).split()))


def report_summary(document: Mapping[str, Any], paths: Sequence[Path]) -> th.Summary:
    """The verdict; then the rises, the duty and the limits."""
    every = tables(document)
    files = f"written: {', '.join(map(str, paths))}"
    missing = [] if paths[-1].suffix == ".pdf" else [th.NO_PDF]
    parts: list[th.Table | str] = [every["rises"], every["duty"], *missing, every["limits"]]
    return th.Summary(
        f"{document['title']}, {document['sentence']}.", parts, files, [every["steps"], every["signature"]]
    )
