"""What extras and packages of others build on, beside `import thermoscope as ts`: names of the rooms, loaded when used.

    from thermoscope import plugin as th

plugin.pyi lists them with their modules. What is missing there is added there; nothing else of the rooms is promised.
"""

from __future__ import annotations

from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from geom.lazy import typed_homes


@cache
def _homes() -> dict[str, tuple[str, str]]:
    return typed_homes(Path(__file__).with_suffix(".pyi"))


def __getattr__(name: str) -> Any:
    if name not in _homes():
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'; plugin.pyi lists what it has")
    module, original = _homes()[name]
    home = import_module(module)
    found = getattr(home, original) if hasattr(home, original) else import_module(f"{module}.{original}")
    globals()[name] = found  # the next look at it costs what any other name does
    return found


def __dir__() -> list[str]:
    return sorted(_homes())
