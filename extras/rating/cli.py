"""What the command line takes from this extra; nothing heavy is loaded until a command runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from thermoscope.plugin import BandsOption as Sure
from thermoscope.plugin import HotLimitOption as HotLimit
from thermoscope.plugin import JsonOption as Json
from thermoscope.plugin import OutOption as Out

use_commands = typer.Typer(name="use")


@use_commands.command()
def rate(
    name: Annotated[str, typer.Argument(metavar="CASE|MACHINE", help="A case, or a machine with nothing measured.")],
    limit: HotLimit = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="Input or boundary.")] = None,
    losses: Annotated[Path | None, typer.Option(metavar="CSV", help="Loss map over torque and speed.")] = None,
    voltage: Annotated[float | None, typer.Option(min=0.0, max=1e7, help="Of the map's slices.")] = None,
    overload: Annotated[float, typer.Option(min=100.1, max=1e4, help="Percent of the continuous rating.")] = 150.0,
    top: Annotated[float | None, typer.Option(min=0.0, max=1e6, metavar="RPM", help="Of the envelope.")] = None,
    load: Annotated[list[str] | None, typer.Option(metavar="INPUT", help="What the load multiplies.")] = None,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A drive cycle to repeat.")] = None,
    mapped: Annotated[bool, typer.Option("--map", help="How long at every speed and load.")] = False,
    start: Annotated[str, typer.Option(metavar="cold|LOAD", help="S2 begins cold, or at rest under a load.")] = "cold",
    bands: Sure = None,
    json: Json = None,
) -> None:
    """What a machine may carry: S1, S2, S3, S6, 10 s, 60 s, derating, overload; with bands, beside the last model."""
    from extras.rating.commands.rate import rate as run

    options = tuple(limit or ()), tuple(at or ())
    loads = tuple(load or ())
    raise typer.Exit(run(name, *options, losses, voltage, overload, top, loads, cycle, mapped, start, bands, json))


@use_commands.command()
def optimise(
    name: Annotated[str, typer.Argument(metavar="CASE|MACHINE", help="A case, or a machine with nothing measured.")],
    limit: HotLimit = None,
    torque: Annotated[float | None, typer.Option(min=0.0, metavar="NM", help="Required, for ever.")] = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="Input or boundary.")] = None,
    vary: Annotated[
        list[str] | None, typer.Option(metavar="NAME[=LOW:HIGH]", help="Else flows, jacket and fins.")
    ] = None,
    method: Annotated[str, typer.Option(help="nsga2 or unsga3.")] = "nsga2",
    population: Annotated[int, typer.Option(min=8, help="Designs per generation.")] = 48,
    generations: Annotated[int, typer.Option(min=1)] = 30,
    seed: Annotated[int, typer.Option(min=0)] = 1,
    cluster: Annotated[str | None, typer.Option(metavar="ADDRESS", help="Of a Dask scheduler.")] = None,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A vehicle's, with its gains.")] = None,
    robust: Annotated[bool, typer.Option("--robust", help="Temperatures at the upper end of their bands.")] = False,
    out: Out = None,
    json: Json = None,
) -> None:
    """Designs that trade peak temperature, settling time, copper loss and auxiliary power; each a machine file."""
    from extras.rating.commands.optimise import optimise as run
    from extras.rating.optimisation.search import Effort

    options = tuple(limit or ()), torque, tuple(at or ()), tuple(vary or ()), method
    raise typer.Exit(run(name, *options, Effort(population, generations, seed), cluster, cycle, robust, out, json))


@use_commands.command("compare-designs")
def compare_designs(
    names: Annotated[list[str], typer.Argument(metavar="MACHINE...", help="Two to six machine files, names or cases.")],
    limit: HotLimit = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="For all of them.")] = None,
    bands: Sure = None,
    json: Json = None,
) -> None:
    """Designs side by side: dimensions that differ, hottest points, continuous ratings, masses, pump and fan power."""
    from extras.rating.commands.compare_designs import compare_designs as run

    raise typer.Exit(run(names, tuple(limit or ()), tuple(at or ()), bands, json))
