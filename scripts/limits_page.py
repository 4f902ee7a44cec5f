"""docs/reference/limits.md: what a file may ask for, and how to raise it.

python -m scripts.limits_page    writes the page
"""

from importlib import import_module
from pathlib import Path

from geom.limits import LIMITS
from scripts.published import table

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "limits.md"
HEAD = """# Limits

What a file asks for is counted before anything of that size is kept in memory. Beyond a limit the command stops with
exit code 2, names the limit, and leaves nothing behind. To raise one, set its environment variable to a whole number:

```sh
THERMOSCOPE_MOST_ROWS=20000000 thermoscope test compare CASE
```

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
    """The limits as a Markdown table."""
    rows = ((f"`{x.name}`", f"{x.usual:,}", f"`{x.variable}`", f"{x.unit} {x.why}") for x in LIMITS)
    return table(["limit", "usual", "variable", "what it bounds, and why this number"], rows)


def page() -> str:
    """The page as Markdown."""
    names = {what: (*where.split(":"), unit) for what, (where, unit) in OTHERS.items()}
    most = {w: f"{getattr(import_module(module), name):,.9g}" for w, (module, name, _) in names.items()}
    rows = ((w, most[w], unit, f"`{module}:{name}`") for w, (module, name, unit) in names.items())
    others = table(["what", "at most", "unit", "where"], rows)
    return f"{HEAD}{limits_table()}\n\nNothing raises these:\n\n{others}\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
