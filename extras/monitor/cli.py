"""What the command line takes from this extra; nothing heavy is loaded until a command runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from thermoscope.plugin import CaseArgument as Case
from thermoscope.plugin import JsonOption as Json
from thermoscope.plugin import OutOption as Out

use_commands = typer.Typer(name="use")


@use_commands.command()
def watch(
    case: Case,
    follow: Annotated[str, typer.Option("--follow", metavar="FILE|-", help="A recording, or - for rows from a pipe.")],
    sensor: Annotated[list[str] | None, typer.Option(metavar="NAME", help="Use these sensors alone.")] = None,
    like: Annotated[str | None, typer.Option(metavar="TEST", help="Columns as in this test; else the first.")] = None,
    out: Out = None,
    json: Json = None,
) -> None:
    """Beside a running machine: all temperatures and missing heat from its sensors, and where the model fails."""
    from extras.monitor.commands.watch import watch as run

    raise typer.Exit(run(case, follow, tuple(sensor or ()), like, out, json))


@use_commands.command()
def fleet(
    case: Case,
    recordings: Annotated[list[Path], typer.Argument(metavar="RECORDINGS...", help="UNIT@2026-03.csv, or folders.")],
    like: Annotated[str | None, typer.Option(metavar="TEST", help="Columns as in this test; else the first.")] = None,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler.")] = None,
    json: Json = None,
) -> None:
    """Motors that should be equal: what differs between them, what drifts over the months, which one stands out."""
    from extras.monitor.commands.fleet import fleet as run

    raise typer.Exit(run(case, recordings, like, cluster, json))
