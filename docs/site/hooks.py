"""The page that comes from the code: the gallery from examples/."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs" / "images" / "gallery"


def on_files(files: Any, config: Any) -> Any:
    """Add gallery.md."""
    files.append(File.generated(config, "gallery.md", content=gallery(sorted((ROOT / "examples").glob("*.py")))))
    return files


def gallery(examples: list[Path]) -> str:
    """One section per example: its first sentence, its pictures, its code."""
    parts = ["# Gallery", "Each of these runs as it stands: `python examples/NAME.py`. The tests run them too.", ""]
    return "\n\n".join(parts + [section(path) for path in examples]) + "\n"


def section(path: Path) -> str:
    code = path.read_text(encoding="utf-8")
    said = ast.get_docstring(ast.parse(code)) or path.stem
    title, _, rest = said.partition("\n")
    pictures = [f"![{path.stem}](images/gallery/{p.name})" for p in sorted(PICTURES.glob(f"{path.stem}*"))]
    hidden = "\n".join(f"    {line}" for line in f"```python\n{code}```".splitlines())
    return "\n\n".join(
        [f"## {title.rstrip('.')}", rest.strip("\n"), *pictures, f'??? example "{path.name}"\n\n{hidden}']
    )
