"""What extras and packages of others build on, beside `import thermoscope as ts`: names of the rooms, loaded when used.

plugin.pyi lists them with their modules. What is missing there is added there; nothing else of the rooms is promised.
"""

from __future__ import annotations

import ast
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any


@cache
def _homes() -> dict[str, tuple[str, str]]:
    """Name -> its module, and what it is called there."""
    tree = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    return {a.asname or a.name: (str(node.module), a.name) for node in imports for a in node.names}


def __getattr__(name: str) -> Any:
    if name not in _homes():
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'; plugin.pyi lists what it has")
    module, original = _homes()[name]
    home = import_module(module)
    return getattr(home, original) if hasattr(home, original) else import_module(f"{module}.{original}")


def __dir__() -> list[str]:
    return sorted(_homes())
