"""docs/reference/limits.md: what a file may ask for, and how to raise it.

python -m scripts.limits_page    writes the page
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from geom.limits import LIMITS

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "limits.md"
HEAD = """# Limits

What a file asks for is counted before anything of that size is kept in memory. Beyond a limit the command stops with
exit code 2, names the limit, and leaves nothing behind. To raise one, set its environment variable to a whole number:

```sh
THERMOSCOPE_MOST_ROWS=20000000 thermoscope test compare CASE
```

| limit | usual | variable | what it bounds, and why this number |
|---|---|---|---|
"""
OTHERS = {  # that no variable raises: what -> where, unit
    "a name": ("geom.description.names:LETTERS", "letters"),
    "a name of a file": ("geom.description.names:LONGEST", "bytes"),
    "a worksheet": ("geom.recording_bounds:SHEET_ROWS", "rows"),
    "a test": ("measured.recordings.grid:LONGEST_S", "s"),
    "tabs of a workbench": ("extras.workbench.tabs:MOST", "tabs"),
    "a heat capacity, at least": ("lumped.schemas.bounds:LEAST_J_K", "J/K"),
}


def limits_table() -> str:
    """The limits as rows of a Markdown table."""
    rows = (f"| `{x.name}` | {x.usual:,} | `{x.variable}` | {x.unit} {x.why} |" for x in LIMITS)
    return "\n".join(rows)


def page() -> str:
    """The page as Markdown."""
    names = {what: (*where.split(":"), unit) for what, (where, unit) in OTHERS.items()}
    rows = [f"| {w} | {getattr(import_module(m), n):,.9g} | {unit} | `{m}:{n}` |" for w, (m, n, unit) in names.items()]
    others = "\n".join(["Nothing raises these:", "", "| what | at most | unit | where |", "|---|---|---|---|", *rows])
    return f"{HEAD}{limits_table()}\n\n{others}\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
