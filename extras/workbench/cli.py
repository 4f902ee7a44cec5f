"""What the command line takes from this extra; nothing heavy is loaded until a command runs."""

from __future__ import annotations

from typing import Annotated

import typer

from thermoscope.plugin import CaseArgument as Case

show_commands = typer.Typer(name="show")


@show_commands.command()
def serve(
    case: Case,
    host: Annotated[str, typer.Option(help="Where to listen; all browsers need the token.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="0 takes a free one.")] = 8710,
) -> None:
    """The workbench in the browser: the machine, its sensors, what is missing, add it and see the error fall."""
    from extras.workbench.commands.serve import serve as run

    raise typer.Exit(run(case, host, port))
