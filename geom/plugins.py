"""What other installed packages add to the tool: objects named by entry points of the group "thermoscope.GROUP"."""

import sys
from functools import cache
from importlib.metadata import EntryPoint, distributions
from pathlib import Path
from typing import Any


def plugins(group: str) -> dict[str, Any]:
    """Name -> object.  group : effects, families, formats, quantities, still_air, moving_air, pictures or names

    Every installed package is read for it (tens of milliseconds), so once for each search path. The folder in which
    a command runs is left out of the search: cases lie there, and a case is data.
    """
    here = Path.cwd()
    return dict(_plugins(group, tuple(place for place in sys.path if Path(place).resolve() != here)))


@cache
def _plugins(group: str, path: tuple[str, ...]) -> dict[str, Any]:
    return {entry.name: entry.load() for entry in reversed(_entries(path)) if entry.group == f"thermoscope.{group}"}


@cache
def _entries(path: tuple[str, ...]) -> list[EntryPoint]:
    every = (entry for one in distributions(path=list(path)) for entry in one.entry_points)
    return [entry for entry in every if entry.group.startswith("thermoscope.")]
