"""Names of a package that load their module when they are used: `import viz` loads no VTK."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any


@cache
def typed_homes(file: str | Path) -> dict[str, tuple[str, str]]:
    """Name -> its module and what it is called there, from the imports that a type checker reads in a file."""
    tree = ast.parse(Path(file).read_text(encoding="utf-8"))
    blocks = [tree.body, *(node.body for node in tree.body if isinstance(node, ast.If))]
    imports = [node for body in blocks for node in body if isinstance(node, ast.ImportFrom)]
    return {a.asname or a.name: (str(node.module), a.name) for node in imports for a in node.names}


def loaded_when_used(
    package: str, home: Mapping[str, str], within: str = ""
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """A package's `__getattr__` and `__dir__`.  home : name -> its module;  within : before each of these modules"""

    def attribute(name: str) -> Any:
        if name not in home:
            raise AttributeError(f"module '{package}' has no attribute '{name}'; known: {', '.join(sorted(home))}")
        return getattr(import_module(within + home[name]), name)

    return attribute, lambda: sorted(home)
