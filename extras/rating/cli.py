"""The commands of this extra; nothing heavy is loaded until one runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from thermoscope import plugin as th

use_commands = typer.Typer(name="use")


@use_commands.command()
def rate(
    name: Annotated[str, typer.Argument(metavar="CASE|MACHINE", help="A case, or a machine with nothing measured.")],
    limit: th.HotLimitOption = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="Input or boundary.")] = None,
    losses: Annotated[Path | None, typer.Option(metavar="CSV", help="Loss map over torque and speed.")] = None,
    voltage: Annotated[float | None, typer.Option(min=0.0, max=1e7, help="Of the map's slices.")] = None,
    overload: Annotated[float, typer.Option(min=100.1, max=1e4, help="Percent of the continuous rating.")] = 150.0,
    top: Annotated[float | None, typer.Option(min=0.0, max=1e6, metavar="RPM", help="Of the envelope.")] = None,
    load: Annotated[list[str] | None, typer.Option(metavar="INPUT", help="What the load multiplies.")] = None,
    cycle: Annotated[str | None, typer.Option(metavar="FILE|NAME", help="A drive cycle to repeat.")] = None,
    mapped: Annotated[bool, typer.Option("--map", help="How long at every speed and load.")] = False,
    start: Annotated[str, typer.Option(metavar="cold|LOAD", help="S2 begins cold, or at rest under a load.")] = "cold",
    bands: th.BandsOption = None,
    json: th.JsonOption = None,
) -> int:
    """What a machine may carry: S1, S2, S3, S6, 10 s, 60 s, derating, overload; with bands, beside the last model."""
    from extras.rating.commands import rate as ratings
    from extras.rating.request import RatingRequest
    from thermoscope import InputError

    options = th.read_limits(limit or ()), ratings.read_at(at or ()), tuple(load or ())
    request = RatingRequest(*options, losses, voltage, overload / 100.0, top, cycle, mapped, ratings.read_start(start))
    if voltage is not None and losses is None:
        right = "--losses FILE.csv with a column voltage_V"
        raise InputError("is of a loss map, and none is given", "--voltage", right)
    if not request.limits:
        raise InputError("no limit is given", "--limit", "PLACE=DEGC, for example winding=155")
    with th.progress() as tell, ratings.once() as messages:
        document = ratings.rating_document(ratings.case_or_machine(name, tell), request, bands, tell)
    th.notes(messages)
    th.give(document, json, lambda: ratings.rating_summary(document))
    return 0


@use_commands.command()
def optimise(
    name: Annotated[str, typer.Argument(metavar="CASE|MACHINE", help="A case, or a machine with nothing measured.")],
    limit: th.HotLimitOption = None,
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
    out: th.OutOption = None,
    json: th.JsonOption = None,
) -> int:
    """Designs that trade peak temperature, settling time, copper loss and auxiliary power; each a machine file."""
    from extras.rating.commands.optimise import optimisation_summary, optimised, read_bounds
    from extras.rating.commands.rate import once, read_at
    from extras.rating.design.design_problem import DesignRequest
    from extras.rating.optimisation.search import METHODS, Effort
    from thermoscope import InputError

    if method not in METHODS:
        raise InputError(f"'{method}' is not a method", "--method", ", ".join(METHODS))
    request = DesignRequest(
        th.read_limits(limit or ()), torque, read_at(at or ()), read_bounds(vary or ()), robust, cycle
    )
    if not request.limits:
        raise InputError("no limit is given", "--limit", "PLACE=DEGC, for example winding=155")
    effort = Effort(population, generations, seed)
    with once() as messages:
        document, where, stopped = optimised(name, request, method, effort, cluster, out)
    th.notes(messages)
    th.give(document, json, lambda: optimisation_summary(document, where))
    return 130 if stopped else 0  # as shells have it


@use_commands.command("compare-designs")
def compare_designs(
    names: Annotated[list[str], typer.Argument(metavar="MACHINE...", help="Two to six machine files, names or cases.")],
    limit: th.HotLimitOption = None,
    at: Annotated[list[str] | None, typer.Option("--at", metavar="NAME=VALUE", help="For all of them.")] = None,
    bands: th.BandsOption = None,
    picture: Annotated[
        Path | None, typer.Option("--picture", metavar="FILE", help="A PNG of all at rest, on one scale.")
    ] = None,
    json: th.JsonOption = None,
) -> int:
    """Designs side by side: dimensions that differ, hottest points, continuous ratings, masses, pump and fan power."""
    from extras.rating.commands.compare_designs import compared_designs, designs_summary
    from extras.rating.commands.rate import once, read_at

    with once() as messages:
        document = compared_designs(names, th.read_limits(limit or ()), read_at(at or ()), bands, picture)
    th.notes(messages)
    th.give(document, json, lambda: designs_summary(document))
    return 0
