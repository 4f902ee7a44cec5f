"""Shared by the rules of the house: the code of all rooms, parsed once for all rules of a file."""

import ast
import gc
from pathlib import Path

import pytest

ROOMS = ("geom", "fem", "lumped", "measured", "validation", "viz", "thermoscope", "extras")


@pytest.fixture(scope="module")
def trees(root) -> dict[Path, ast.Module]:
    """Every file of the rooms and its syntax tree.

    Without the collector, which would look at the half million nodes again and again: a third of the time.
    """
    files = [f for room in ROOMS for f in sorted((root / room).rglob("*.py"))]
    gc.disable()
    try:
        return {f: ast.parse(f.read_text(encoding="utf-8")) for f in files}
    finally:
        gc.enable()
