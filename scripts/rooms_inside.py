"""The wheel holds one package: `geom.errors` of the checkout is `thermoscope.geom.errors` in it. Run by hatchling.

pyproject.toml says which folder goes where; here the modules' imports follow, and whatever else names a module.
"""

import ast
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

PACKAGE = "thermoscope"


class RoomsInside(BuildHookInterface):
    """Rewritten modules take the place of those in the checkout; an editable install needs none."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "editable":
            return
        self.folder = TemporaryDirectory()
        moved = self.build_config.target_config["sources"]
        rooms = [name for name in moved if Path(self.root, name, "__init__.py").is_file()]
        for file in list(self.build_config.builder.recurse_selected_project_files()):
            if file.path.endswith((".py", ".pyi")):
                new = Path(self.folder.name, file.distribution_path)
                new.parent.mkdir(parents=True, exist_ok=True)
                new.write_text(inside(Path(file.path).read_text(encoding="utf-8"), rooms), encoding="utf-8")
                build_data["force_include"][str(new)] = file.distribution_path

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        if version != "editable":
            self.folder.cleanup()


def inside(source: str, rooms: Sequence[str]) -> str:
    """The text of a module whose imports find the rooms inside the package, and whose names of modules do too.

    rooms : packages that move.  Raises ValueError for `import room`, which would bind another name.
    """
    lines = source.splitlines(keepends=True)
    module = re.compile(rf"(?:{'|'.join(rooms)})(?:\.\w+)*\.?")
    for line, at in sorted(_named(ast.parse(source), module), reverse=True):
        raw = lines[line - 1].encode()
        lines[line - 1] = (raw[:at] + f"{PACKAGE}.".encode() + raw[at:]).decode()
    return "".join(lines)


def _named(tree: ast.Module, module: re.Pattern[str]) -> Iterator[tuple[int, int]]:
    """Where the name of a module begins: line from 1, byte from 0. In texts only a name with a dot is one."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and not node.level and module.fullmatch(node.module or ""):
            yield node.lineno, node.col_offset + len("from ")
        elif isinstance(node, ast.Import) and any(module.fullmatch(name.name) for name in node.names):
            (name,) = node.names
            if not name.asname:
                raise ValueError(
                    f"line {node.lineno}: `import {name.name}` binds another name inside a package; `from`?"
                )
            yield node.lineno, node.col_offset + len("import ")
        elif isinstance(node, ast.Constant) and "." in str(node.value) and module.fullmatch(str(node.value)):
            yield node.lineno, node.col_offset + 1
