"""thermoscope bench protocol [RECORD.toml], thermoscope bench report RECORD.toml"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from extras.bench.heat_run.judgement import judged
from extras.bench.heat_run.page import tables, write_report
from extras.bench.heat_run.record import read_heat_run
from extras.bench.measuring.protocol import Protocol, Record, protocol as check_record
from extras.bench.measuring.record_file import read_record
from thermoscope import InputError, plugin as th


def protocol(
    record: Annotated[Path | None, typer.Argument(metavar="RECORD.toml", help="A test's record so far.")] = None,
    json: th.JsonOption = None,
) -> int:
    """The thermal test: what to measure when, what is wrong with a record, and the temperatures it gives."""
    with th.progress() as tell:
        tell("checking the record")
        result = check_record(Record(1.0) if record is None else read_record(record))
    th.give(result.document(), json, lambda: protocol_summary(result))
    if result.refused:
        first = result.refused[0]
        more = f" (and {len(result.refused) - 1} more)" if len(result.refused) > 1 else ""
        raise InputError(first.words.split(";")[0], f"{record} [{first.name}]", first.words.partition("; ")[2] + more)
    return 0 if record is None or result.complete else 1


def protocol_summary(result: Protocol) -> th.Summary:
    """What to do next; the temperatures with their three uncertainties; then all steps."""
    spreads = [(n, s) for n, s in (("winding", result.winding), ("magnets", result.magnets)) if s is not None]
    headers = ["rise", "K", "worst case", "GUM 95 %", "Monte Carlo 95 %", "largest share"]
    rises = th.Table(
        "Rises over the cold temperature", headers, [_row(n, s) for n, s in spreads], keep=["K", "GUM 95 %"]
    )
    ways = "way=method | at (s)=at_s | degC=value | 1 sigma (K)=sd | how=words"
    off = th.Table.of("Winding when switched off", result.ways, ways)
    steps = th.Table.of("Thermal test", result.steps, "step=name | *state | *when | *what | found=words", ["refused"])
    words = ", ".join(f"{n} {s.value:.1f} K" for n, s in spreads)
    sentence = f"Rises: {words}." if words else f"A thermal test has {len(result.steps)} steps."
    if result.refused:
        sentence = f"{len(result.refused)} steps are refused: no temperature is given."
    return th.Summary(sentence, [rises, off, steps], "--json FILE; docs/how-to/thermal-test.md")


def _row(name: str, s: th.PropagatedUncertainty) -> list[Any]:
    largest = max(s.budget, key=lambda n: s.budget[n])
    pairs = (s.worst, s.first_order, s.interval)
    return [name, s.value, *(f"{a:.1f} ... {b:.1f}" for a, b in pairs), f"{largest} ({s.budget[largest]:.1f} K)"]


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
