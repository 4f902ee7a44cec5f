"""Names of a package that load their module when they are used: `import viz` loads no VTK."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def loaded_when_used(
    package: str, home: Mapping[str, str], within: str = ""
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """A package's `__getattr__` and `__dir__`.  home : name -> its module;  within : before each of these modules"""

    def attribute(name: str) -> Any:
        if name not in home:
            raise AttributeError(f"module '{package}' has no attribute '{name}'; known: {', '.join(sorted(home))}")
        return getattr(import_module(within + home[name]), name)

    return attribute, lambda: sorted(home)
