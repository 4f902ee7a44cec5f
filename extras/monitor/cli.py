"""The commands of this extra; nothing heavy is loaded until one runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from thermoscope import plugin as th

use_commands = typer.Typer(name="use")


@use_commands.command()
def watch(
    case: th.CaseArgument,
    follow: Annotated[str, typer.Option("--follow", metavar="FILE|-", help="A recording, or - for rows from a pipe.")],
    sensor: Annotated[list[str] | None, typer.Option(metavar="NAME", help="Use these sensors alone.")] = None,
    like: Annotated[str | None, typer.Option(metavar="TEST", help="As in this test; else the first that fits.")] = None,
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Beside a running machine: all temperatures and missing heat from its sensors, and where the model fails."""
    from contextlib import suppress

    from extras.monitor.commands.watch import Session, watch_summary, watched_file
    from extras.monitor.rows.live_rows import TOGETHER, table_of
    from extras.monitor.rows.observing import chosen, designed
    from thermoscope import InputError

    with th.progress() as tell:
        folder = th.open_case(case, tell)
        sheets = {e.name: th.load_sheet(e.sheet) for e in folder.settings.tests}
        name, table, parts = table_of(follow, TOGETHER, sheets, folder.case.model.network, like)
        channels = {c.name: c for t in folder.case.tests if t.name == name for c in t.channels}
        here = [c for n, c in channels.items() if n in table.sensors()]
        sensors = chosen(here, sensor or (), follow)
        withheld = [c for c in here if c not in sensors]
        session = Session(folder, designed(folder, tell), sensors, withheld, json != th.STDOUT)
    with suppress(KeyboardInterrupt):
        for part in parts:
            session.take(table.rows(part))
    if session.one is None:
        raise InputError("holds no row", follow, "rows of numbers under the header")
    file = th.write_whole(watched_file(folder, follow, out), session.csv())
    document = {
        "case": folder.case.name,
        "revision": folder.case.model.revision,
        "source": follow,
        "like": name,
        **session.document(),
        "file": str(file),
    }
    th.give(document, json, lambda: watch_summary(document))
    return 0


@use_commands.command()
def fleet(
    case: th.CaseArgument,
    recordings: Annotated[list[Path], typer.Argument(metavar="RECORDINGS...", help="UNIT@2026-03.csv, or folders.")],
    like: Annotated[str | None, typer.Option(metavar="TEST", help="As in this test; else the first that fits.")] = None,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler.")] = None,
    json: th.JsonOption = None,
) -> int:
    """Motors that should be equal: what differs between them, what drifts over the months, which one stands out."""
    from extras.monitor.commands.fleet import fleet_document, fleet_summary

    with th.progress() as tell:
        document = fleet_document(case, recordings, like, cluster, tell)
    th.give(document, json, lambda: fleet_summary(document))
    return 0
