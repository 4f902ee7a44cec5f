"""docs/notebooks.md: the notebooks of examples/notebooks with what their cells show: python -m scripts.notebook_page

A figure becomes a picture under docs/images, anything else the text that it prints.
"""

import ast
import io
import json
import re
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "notebooks.md"
NAMES = ("network", "measurements", "effects")  # in the order a reader meets them
HEAD = """# Three notebooks

They lie in `examples/notebooks` and run in the tests. Each takes seconds; below is what they show.
"""


def cells_of(name: str) -> list[tuple[str, str]]:
    """(kind, text) of every cell of a notebook."""
    document = json.loads((ROOT / "examples/notebooks" / f"{name}.ipynb").read_text(encoding="utf-8"))
    return [(cell["cell_type"], "".join(cell["source"])) for cell in document["cells"]]


def shown(code: str, left: dict[str, Any]) -> tuple[str, Any]:
    """What a cell prints, and the value of its last line, None where that is a statement.  left : names so far"""
    body = ast.parse(code).body
    last = ast.Expression(body.pop().value) if isinstance(body[-1], ast.Expr) else None  # type: ignore[attr-defined]
    printed = io.StringIO()
    with redirect_stdout(printed):
        exec(compile(ast.Module(body, []), "notebook", "exec"), left)
        value = eval(compile(last, "notebook", "eval"), left) if last else None
    return printed.getvalue().rstrip(), value


def page(pictures: Path) -> str:
    """The page as Markdown; its pictures go into the folder."""
    mpl.use("Agg")
    parts = [HEAD]
    for name in NAMES:
        left: dict[str, Any] = {}
        for number, (kind, text) in enumerate(cells_of(name)):
            if kind == "markdown":
                parts.append(f"#{text}\n" if text.startswith("# ") else f"{text}\n")
                before = re.split(r"[.:?] ", f"{' '.join(text.splitlines())} ")[0].lstrip("# ")
                continue
            parts.append(f"```python\n{text}\n```\n")
            printed, value = shown(text, left)
            if isinstance(value, Figure):
                picture = pictures / f"notebook-{name}-{number}.png"
                value.savefig(picture, dpi=110, bbox_inches="tight", metadata={"Software": None})
                parts.append(f"![{before}](images/{picture.name})\n")
            elif value is not None or printed:
                words = "\n".join(filter(None, [printed, "" if value is None else str(value)]))
                parts.append(f"```text\n{words}\n```\n")
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.parent / "images"), encoding="utf-8")
