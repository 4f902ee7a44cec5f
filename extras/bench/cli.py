"""What the command line takes from this extra; nothing heavy is loaded until a command runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from thermoscope.plugin import CaseArgument as Case
from thermoscope.plugin import JsonOption as Json
from thermoscope.plugin import OutOption as Out

commands = typer.Typer(name="bench", help="The published test procedure, from resistances to screened models.")


@commands.command()
def protocol(
    record: Annotated[Path | None, typer.Argument(metavar="RECORD.toml", help="A test's record so far.")] = None,
    json: Json = None,
) -> None:
    """The thermal test: what to measure when, what is wrong with a record, and the temperatures it gives."""
    from extras.bench.commands.protocol import protocol as run

    raise typer.Exit(run(record, json))


@commands.command()
def curves(
    case: Case,
    resolution: Annotated[float, typer.Option(min=1e-3, max=100.0, help="K, of the thermocouples.")] = 0.5,
    json: Json = None,
) -> None:
    """Warming curves: equilibrium, tau_95, the 3 to 4 % rule, equal tests pooled; exit code 1 if these two fail."""
    from extras.bench.commands.curves import curves as run

    raise typer.Exit(run(case, resolution, json))


@commands.command()
def bases(case: Case, json: Json = None) -> None:
    """Which base a machine stood on in each test. Exit code 1 if the readings exclude the one that a sheet says."""
    from extras.bench.commands.bases import bases as run

    raise typer.Exit(run(case, json))


@commands.command()
def screen(
    machine: Annotated[str, typer.Argument(metavar="MACHINE", help="A machine file, or a name that comes along.")],
    design: Annotated[str, typer.Option(help="full (128 runs), half (64), gap (256), morris or sobol.")] = "full",
    out: Out = None,
    json: Json = None,
) -> None:
    """Which factors move the temperatures of a PM machine: effects with Lenth's limits, Morris or Sobol."""
    from extras.bench.commands.screen import screen as run

    raise typer.Exit(run(machine, design, json, out))


@commands.command("two-paths")
def two_paths(
    case: Case,
    winding: Annotated[str, typer.Option(help="Place of the winding's mean.")] = "winding.copper",
    machine: Annotated[str, typer.Option(help="Place of the machine's inside.")] = "magnets",
    json: Json = None,
) -> None:
    """The network of a case as two resistances: machine to ambient, winding to machine."""
    from extras.bench.commands.screen import two_paths as run

    raise typer.Exit(run(case, winding, machine, json))


@commands.command()
def carry(
    source: Case,
    targets: Annotated[list[str], typer.Argument(metavar="CASE...", help="Cases of other machines.")],
    json: Json = None,
) -> None:
    """The calibrated model of one case on other machines. Exit code 1 if one disagrees beyond its uncertainty."""
    from extras.bench.commands.screen import carry as run

    raise typer.Exit(run(source, targets, json))
