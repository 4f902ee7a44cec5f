"""What other installed packages add to the tool: objects named by entry points of the group "thermoscope.GROUP"."""

from __future__ import annotations

from importlib.metadata import entry_points
from typing import Any


def plugins(group: str) -> dict[str, Any]:
    """Name -> object.  group : effects, families, formats, quantities, still_air, moving_air or pictures"""
    return {entry.name: entry.load() for entry in entry_points(group=f"thermoscope.{group}")}
