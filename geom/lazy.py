"""Names of a package that load their module when they are used: `import viz` loads no VTK."""

import ast
import sys
from collections.abc import Callable, Mapping
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

LISTED = 50  # names that a message lists


@cache
def typed_homes(file: Path) -> dict[str, tuple[str, str]]:
    """Name -> its module and what it is called there: what a stub imports, or a module for a type checker alone."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    blocks = [tree.body] if file.suffix == ".pyi" else [node.body for node in tree.body if isinstance(node, ast.If)]
    imports = [node for body in blocks for node in body if isinstance(node, ast.ImportFrom)]
    return {a.asname or a.name: (str(node.module), a.name) for node in imports for a in node.names}


def loaded_when_used(
    package: str, file: Path | str, offered: Callable[[], Mapping[str, Any]] = dict
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """A package's `__getattr__` and `__dir__`. Its names are those of `file`; the first look at one finds it.

    offered : what others add, asked for where the file has no such name
    """

    def names() -> list[str]:
        return sorted(typed_homes(Path(file)))

    def attribute(name: str) -> Any:
        if name == "__all__":
            return names()
        if name not in typed_homes(Path(file)):
            inside = "__path__" in vars(sys.modules[package]) and find_spec(f"{package}.{name}")
            if inside:  # `from package import module` looks here before it imports that
                return import_module(f"{package}.{name}")
            if name in offered():
                return offered()[name]
            every = [*names(), *offered()]
            right = f"known: {', '.join(every)}" if len(every) < LISTED else f"{Path(file).name} lists what it has"
            raise AttributeError(f"module '{package}' has no attribute '{name}'; {right}")
        module, original = typed_homes(Path(file))[name]
        home = import_module(module)
        value = getattr(home, original) if hasattr(home, original) else import_module(f"{module}.{original}")
        setattr(sys.modules[package], name, value)  # the next look costs what any other name does
        return value

    return attribute, names
