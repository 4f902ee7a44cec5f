"""thermoscope use compare-designs MACHINE MACHINE ...: in a script it is `thermoscope.compare_designs`."""

from pathlib import Path
from typing import Annotated

import typer

from extras.rating.commands.compare_designs import compared_designs, designs_summary
from extras.rating.commands.rate import once, read_at
from thermoscope import plugin as th


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
    with once() as messages:
        document = compared_designs(names, th.read_limits(limit or ()), read_at(at or ()), bands, picture)
    th.notes(messages)
    th.give(document, json, lambda: designs_summary(document))
    return 0
