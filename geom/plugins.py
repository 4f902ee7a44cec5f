"""What other installed packages add to the tool: objects named by entry points of the group "thermoscope.GROUP"."""

from __future__ import annotations

import sys
from functools import cache
from importlib.metadata import entry_points
from typing import Any


def plugins(group: str) -> dict[str, Any]:
    """Name -> object.  group : effects, families, formats, quantities, still_air, moving_air or pictures

    Every installed package is read for it (tens of milliseconds), so once for each search path.
    """
    return dict(_plugins(group, tuple(sys.path)))


@cache
def _plugins(group: str, path: tuple[str, ...]) -> dict[str, Any]:
    return {entry.name: entry.load() for entry in entry_points(group=f"thermoscope.{group}")}
